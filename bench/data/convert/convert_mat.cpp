#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <new>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <matio.h>
#include <zlib.h>

#include <kerf/version.h>

#include "convert/formats.h"
#include "convert/output_file.h"
#include "files/memory_room.h"

namespace kerf::bench {
namespace {

/// Bytes of a variable of level 5, whose length is told in 32 bits of which MATLAB takes 31; less its header.
constexpr std::uint64_t most_variable_bytes = (std::uint64_t{1} << 31U) - 256;
constexpr std::size_t most_name_length = 63;

struct FreeMatVariable {
  void operator()(matvar_t* variable) const noexcept { Mat_VarFree(variable); }
};
using MatVariable = std::unique_ptr<matvar_t, FreeMatVariable>;

/// Of the numbers and letters of a variable and of all in it.
std::uint32_t checksum(const matvar_t& variable, std::uint32_t before) {
  if (variable.data == nullptr) return before;
  if (variable.class_type != MAT_C_CELL && variable.class_type != MAT_C_STRUCT)
    return static_cast<std::uint32_t>(
        ::crc32_z(before, static_cast<const unsigned char*>(variable.data), variable.nbytes));
  const auto* const parts = static_cast<matvar_t* const*>(variable.data);
  for (std::size_t i = 0; i < variable.nbytes / sizeof(matvar_t*); ++i)
    before = parts[i] == nullptr ? before : checksum(*parts[i], before);
  return before;
}

/// A MAT-file that is written. matio does not look whether the disk took what it wrote, so all is read back.
class MatOutput {
 public:
  explicit MatOutput(const std::filesystem::path& name) : file_(name) {
    const std::string header = "MATLAB 5.0 MAT-file, written by " + software();
    mat_ = Mat_CreateVer(file_.path().c_str(), header.c_str(), MAT_FT_MAT5);
    if (mat_ == nullptr) file_.fail(errno);
  }
  MatOutput(const MatOutput&) = delete;
  MatOutput& operator=(const MatOutput&) = delete;
  ~MatOutput() {
    if (mat_ != nullptr) Mat_Close(mat_);
  }

  void write(const MatVariable& variable) {
    if (!variable) throw std::bad_alloc();
    errno = 0;
    if (Mat_VarWrite(mat_, variable.get(), MAT_COMPRESSION_NONE) != 0) file_.fail(errno);
    checksums_.push_back(checksum(*variable, 0));
  }
  void commit(schema::Existing existing) {
    errno = 0;
    if (Mat_Close(std::exchange(mat_, nullptr)) != 0 || !is_as_written()) file_.fail(errno);
    file_.commit(existing);
  }

 private:
  [[nodiscard]] bool is_as_written() {
    mat_ = Mat_Open(file_.path().c_str(), MAT_ACC_RDONLY);
    std::vector<std::uint32_t> found;
    while (mat_ != nullptr && found.size() < checksums_.size()) {
      const MatVariable variable(Mat_VarReadNext(mat_));
      if (!variable) break;
      found.push_back(checksum(*variable, 0));
    }
    return found == checksums_;
  }

  UnfinishedFile file_;
  mat_t* mat_ = nullptr;
  std::vector<std::uint32_t> checksums_;
};

/// Characters as MATLAB counts them: units of UTF-16.
std::size_t utf16_length(std::string_view utf8) {
  std::size_t length = 0;
  for (const char c : utf8) {
    const auto byte = static_cast<unsigned char>(c);
    length += (byte & 0xC0U) == 0x80U ? 0 : byte >= 0xF0U ? 2 : 1;
  }
  return length;
}

MatVariable mat_text(std::string_view text, const char* name = nullptr) {
  std::string copy(text);
  std::array<std::size_t, 2> size{text.empty() ? std::size_t{0} : 1, utf16_length(text)};
  return MatVariable(Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UTF8, 2, size.data(), copy.data(), 0));
}

using TextRow = std::vector<std::string>;

/// A cell array of texts.
MatVariable mat_table_of_texts(const char* name, const std::vector<TextRow>& rows, std::size_t width) {
  std::array<std::size_t, 2> size{rows.size(), width};
  std::vector<matvar_t*> cells;
  for (std::size_t column = 0; column < width; ++column) {
    for (const TextRow& row : rows) cells.push_back(mat_text(row[column]).release());
  }
  return MatVariable(Mat_VarCreate(name, MAT_C_CELL, MAT_T_CELL, 2, size.data(), cells.data(), 0));
}

/// Octave cuts the end off texts with letters beyond ASCII; `kerf import` takes a product written so, too.
std::string ascii_unit(std::string unit) {
  constexpr std::string_view dot = "·";
  for (std::size_t at = 0; (at = unit.find(dot, at)) != std::string::npos;) unit.replace(at, dot.size(), "*");
  return unit.empty() ? "1" : unit;
}

/// Names that MATLAB takes for variables, each once: "position.x 2" becomes position_x_2.
std::vector<std::string> variable_names(const std::vector<RecordingColumn>& columns) {
  std::vector<std::string> names;
  std::set<std::string> taken{"rows", "units", "dictionary", "about", "events"};
  for (const RecordingColumn& column : columns) {
    std::string name;
    for (const char c : column.name()) {
      const auto byte = static_cast<unsigned char>(c);
      if ((byte & 0xC0U) == 0x80U) continue;  // one character of several bytes is one _
      name += byte < 128 && std::isalnum(byte) != 0 ? c : '_';
    }
    name.resize(std::min(name.size(), most_name_length));
    const std::string wanted = name;
    for (int number = 2; !taken.insert(name).second; ++number) {
      const std::string ending = fmt::format("_{}", number);
      name = wanted.substr(0, most_name_length - ending.size()) + ending;
    }
    names.push_back(name);
  }
  return names;
}

MatVariable units_of(const std::vector<RecordingColumn>& columns, const std::vector<std::string>& names) {
  std::vector<const char*> fields;
  for (const std::string& name : names) fields.push_back(name.c_str());
  std::array<std::size_t, 2> one{1, 1};
  MatVariable units(
      Mat_VarCreateStruct("units", 2, one.data(), fields.data(), static_cast<unsigned>(fields.size())));
  for (std::size_t i = 0; units && i < names.size(); ++i)
    Mat_VarSetStructFieldByName(units.get(), fields[i], 0, mat_text(ascii_unit(columns[i].unit)).release());
  return units;
}

template <typename T>
void write_column(MatOutput& output, const RecordingColumns& recording, std::size_t column,
                  const std::string& name, matio_classes kind, matio_types type) {
  std::vector<T> data;
  data.reserve(static_cast<std::size_t>(recording.rows()));
  ColumnValues values;
  const std::uint64_t block = recording.rows_of_a_block();
  for (std::uint64_t first = 0; first < recording.rows(); first += block) {
    recording.read(column, first, std::min<std::uint64_t>(block, recording.rows() - first), values);
    const auto take = [&data](const auto& from) {
      for (const auto value : from) data.push_back(static_cast<T>(value));
    };
    if constexpr (std::is_integral_v<T>) {
      take(values.whole);
    } else {
      take(values.real);
    }
  }
  std::array<std::size_t, 2> size{data.size(), 1};
  T none{};
  output.write(MatVariable(Mat_VarCreate(name.c_str(), kind, type, 2, size.data(),
                                         data.empty() ? &none : data.data(), MAT_F_DONT_COPY_DATA)));
}

void write_any_column(MatOutput& output, const RecordingColumns& recording, std::size_t column,
                      const std::string& name) {
  using Number = RecordingColumn::Number;
  switch (recording.columns()[column].number) {
    case Number::float64:
      return write_column<double>(output, recording, column, name, MAT_C_DOUBLE, MAT_T_DOUBLE);
    case Number::float32:
      return write_column<float>(output, recording, column, name, MAT_C_SINGLE, MAT_T_SINGLE);
    case Number::uint64:
      return write_column<std::uint64_t>(output, recording, column, name, MAT_C_UINT64, MAT_T_UINT64);
    case Number::uint32:
      return write_column<std::uint32_t>(output, recording, column, name, MAT_C_UINT32, MAT_T_UINT32);
  }
}

}  // namespace

void convert_to_mat(const RecordingColumns& recording, const ConversionTarget& target) {
  const std::uint64_t bytes = recording.rows() * sizeof(double);
  if (bytes > most_variable_bytes)
    throw std::invalid_argument(fmt::format(
        "{}: {} rows; expected at most {} for a MAT-file of level 5, whose variables have less than 2 GiB: "
        "convert to .csv or .mcap, or take a part of it by 'kerf prepare --from S --to S'",
        target.file.string(), recording.rows(), most_variable_bytes / sizeof(double)));
  require_memory(target.file, bytes, "a column");
  const std::vector<RecordingColumn>& columns = recording.columns();
  const std::vector<std::string> names = variable_names(columns);

  MatOutput output(target.file);
  output.write(units_of(columns, names));
  std::vector<TextRow> dictionary;
  for (std::size_t i = 0; i < columns.size(); ++i)
    dictionary.push_back({names[i], ascii_unit(columns[i].unit), columns[i].meaning, columns[i].source});
  output.write(mat_table_of_texts("dictionary", dictionary, 4));
  std::vector<TextRow> about;
  for (const auto& [name, value] : facts_of(recording.about())) about.push_back({name, value});
  output.write(mat_table_of_texts("about", about, 2));
  std::vector<TextRow> events;
  for (const schema::Event& event : recording.about().events)
    events.push_back({fmt::format("{}", event.time_s), event.kind, event.text});
  if (!events.empty()) output.write(mat_table_of_texts("events", events, 3));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    write_any_column(output, recording, i, names[i]);
    *target.rows_done = static_cast<std::size_t>(recording.rows() * (i + 1) / columns.size());
  }
  auto rows = static_cast<double>(recording.rows());
  std::array<std::size_t, 2> one{1, 1};
  output.write(MatVariable(Mat_VarCreate("rows", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, one.data(), &rows, 0)));
  output.commit(target.existing);
}

}  // namespace kerf::bench
