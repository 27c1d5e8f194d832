#include "formats/mat_table.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <tuple>
#include <type_traits>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <matio.h>
#include <sys/mman.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

constexpr std::size_t version_at = 124;
constexpr std::size_t header_size = 128;

bool is_hdf5(std::string_view bytes) {
  return bytes.substr(0, version_at).find("MATLAB 7.3") != std::string_view::npos;
}

/// A file with a name of its own, in memory where the system has a folder for that.
/// @throws std::system_error if there is no room for one.
std::pair<int, std::string> named_file() {
  for (const std::filesystem::path& folder :
       {std::filesystem::path("/dev/shm"), std::filesystem::temp_directory_path()}) {
    std::string name = (folder / "kerf-mat-XXXXXX").string();
    const int file = mkostemp(name.data(), O_CLOEXEC);
    if (file >= 0) return {file, name};
  }
  throw std::system_error(errno, std::generic_category(), "no file in memory");
}

struct CloseMat {
  void operator()(mat_t* mat) const noexcept { Mat_Close(mat); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const noexcept { Mat_VarFree(variable); }
};

/// A column of numbers.
struct MatColumn {
  std::string name;
  std::vector<double> values;
};

template <typename T>
void append(const matvar_t& variable, std::size_t first, std::size_t count, std::vector<double>& values) {
  const auto* data = static_cast<const T*>(variable.data) + first;
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<double>(data[i]));
}

std::size_t bytes_of(matio_classes kind) {
  switch (kind) {
    case MAT_C_DOUBLE:
    case MAT_C_INT64:
    case MAT_C_UINT64:
      return 8;
    case MAT_C_SINGLE:
    case MAT_C_INT32:
    case MAT_C_UINT32:
      return 4;
    case MAT_C_INT16:
    case MAT_C_UINT16:
      return 2;
    case MAT_C_INT8:
    case MAT_C_UINT8:
      return 1;
    default:
      return 0;
  }
}

bool is_numeric(const matvar_t& variable) {
  return bytes_of(variable.class_type) > 0 && variable.isComplex == 0 && variable.rank == 2 &&
         variable.data != nullptr;
}

/// Whether a double holds every one of these numbers: beyond 2^53 it leaves out odd ones.
template <typename T>
bool are_exact(const matvar_t& variable, std::size_t count) {
  const auto* data = static_cast<const T*>(variable.data);
  constexpr T most = T{1} << 53U;
  return std::all_of(data, data + count, [](T value) {
    return value <= most && (std::is_unsigned_v<T> || value >= T{0} - most);
  });
}

bool fits_doubles(const matvar_t& variable, std::size_t count) {
  if (variable.class_type == MAT_C_INT64) return are_exact<std::int64_t>(variable, count);
  if (variable.class_type == MAT_C_UINT64) return are_exact<std::uint64_t>(variable, count);
  return true;
}

/// A text of one line, as far as it is ASCII, which names of units are; empty if it is none.
std::string text_of(const matvar_t& variable) {
  if (variable.class_type != MAT_C_CHAR || variable.data == nullptr) return {};
  const bool is_wide = variable.data_type == MAT_T_UINT16 || variable.data_type == MAT_T_UTF16;
  std::string text;
  for (std::size_t i = 0; i < variable.nbytes / (is_wide ? 2 : 1); ++i) {
    const unsigned c = is_wide ? static_cast<const std::uint16_t*>(variable.data)[i]
                               : static_cast<const unsigned char*>(variable.data)[i];
    if (c < 32) return {};  // a tab or a line would break the table
    text += c < 128 ? static_cast<char>(c) : '?';
  }
  return text;
}

void append_any(const matvar_t& variable, std::size_t first, std::size_t count, std::vector<double>& values) {
  switch (variable.class_type) {
    case MAT_C_DOUBLE:
      return append<double>(variable, first, count, values);
    case MAT_C_SINGLE:
      return append<float>(variable, first, count, values);
    case MAT_C_INT64:
      return append<std::int64_t>(variable, first, count, values);
    case MAT_C_UINT64:
      return append<std::uint64_t>(variable, first, count, values);
    case MAT_C_INT32:
      return append<std::int32_t>(variable, first, count, values);
    case MAT_C_UINT32:
      return append<std::uint32_t>(variable, first, count, values);
    case MAT_C_INT16:
      return append<std::int16_t>(variable, first, count, values);
    case MAT_C_UINT16:
      return append<std::uint16_t>(variable, first, count, values);
    case MAT_C_INT8:
      return append<std::int8_t>(variable, first, count, values);
    default:
      return append<std::uint8_t>(variable, first, count, values);
  }
}

/// Gathers the columns of all variables.
class Columns {
 public:
  void add(const std::string& name, const matvar_t& variable, std::size_t depth = 0) {
    if (variable.class_type == MAT_C_STRUCT && variable.nbytes > 0 && depth < most_depth) {
      if (depth == 0 && name == "units" && add_units(variable)) return;
      return add_fields(name, variable, depth);
    }
    if (variable.class_type == MAT_C_OPAQUE || variable.class_type == MAT_C_OBJECT ||
        variable.class_type == MAT_C_FUNCTION) {
      objects.push_back(name);
      return;
    }
    if (!is_numeric(variable)) {
      passed_over.push_back(name);
      return;
    }
    const std::size_t rows = variable.dims[0];
    const std::size_t columns = variable.dims[1];
    // What the file says of itself is not to be believed beyond what was read.
    if (columns > 0 && rows > variable.nbytes / bytes_of(variable.class_type) / columns) {
      passed_over.push_back(name);
    } else if (!fits_doubles(variable, rows * columns)) {
      too_large.push_back(name);
    } else if (rows <= 1 || columns <= 1) {
      all.push_back({.name = name, .values = {}});
      append_any(variable, 0, rows * columns, all.back().values);
    } else {
      for (std::size_t column = 0; column < columns && column < most_columns; ++column) {
        all.push_back({.name = fmt::format("{}[{}]", name, column + 1), .values = {}});
        append_any(variable, column * rows, rows, all.back().values);
      }
    }
  }

  std::vector<MatColumn> all;
  std::vector<std::string> objects;
  std::vector<std::string> passed_over;
  std::vector<std::string> too_large;        ///< whole numbers that no double holds
  std::map<std::string, std::string> units;  ///< by the column's name, of a struct `units` of texts

 private:
  static constexpr std::size_t most_columns = 1000;
  static constexpr std::size_t most_depth = 16;

  /// Whether it is what kerf convert writes: a text by the name of each variable.
  bool add_units(const matvar_t& variable) {
    std::map<std::string, std::string> found;
    char* const* fields = Mat_VarGetStructFieldnames(&variable);
    const unsigned count = Mat_VarGetNumberOfFields(const_cast<matvar_t*>(&variable));  // it is read only
    for (unsigned i = 0; fields != nullptr && i < count; ++i) {
      const matvar_t* field = Mat_VarGetStructFieldByIndex(const_cast<matvar_t*>(&variable), i, 0);
      if (field == nullptr || text_of(*field).empty()) return false;
      found[fields[i]] = text_of(*field);
    }
    units.merge(found);
    return true;
  }

  void add_fields(const std::string& name, const matvar_t& variable, std::size_t depth) {
    if (variable.rank != 2 || variable.dims[0] * variable.dims[1] != 1) {
      passed_over.push_back(name);
      return;
    }
    char* const* fields = Mat_VarGetStructFieldnames(&variable);
    const unsigned count = Mat_VarGetNumberOfFields(const_cast<matvar_t*>(&variable));  // it is read only
    for (unsigned i = 0; fields != nullptr && i < count; ++i) {
      const matvar_t* field = Mat_VarGetStructFieldByIndex(const_cast<matvar_t*>(&variable), i, 0);
      if (field != nullptr) add(fmt::format("{}.{}", name, fields[i]), *field, depth + 1);
    }
  }
};

/// The length of which the columns hold most numbers; of two that hold as many the longer.
std::size_t usual_length(const std::vector<MatColumn>& columns) {
  std::map<std::size_t, std::size_t> count;
  for (const MatColumn& column : columns) {
    if (column.values.size() > 1) ++count[column.values.size()];
  }
  std::size_t length = 0;
  std::size_t most = 0;
  for (const auto& [size, times] : count) {
    if (size * times >= most) {
      most = size * times;
      length = size;
    }
  }
  return length;
}

Columns columns_of(std::string_view bytes, const std::string& path, const UnpackedLimits& limits) {
  const std::unique_ptr<mat_t, CloseMat> mat(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
  if (!mat)
    throw std::invalid_argument(
        fmt::format("{}: a MAT-file that cannot be opened: is it whole?", limits.name));
  Columns columns;
  std::size_t bytes_read = 0;
  while (true) {
    const std::unique_ptr<matvar_t, FreeVariable> about(Mat_VarReadNextInfo(mat.get()));
    if (!about) break;
    const std::string name = about->name == nullptr ? "?" : about->name;
    bytes_read += Mat_VarGetSize(about.get());
    if (bytes_read > limits.at_most)
      throw std::invalid_argument(fmt::format("{}: its variables take more than {} bytes (--max-bytes)",
                                              limits.name, limits.at_most));
    // A class that matio does not know is told as none in files of 7.3.
    const bool is_unknown = is_hdf5(bytes) && about->class_type == MAT_C_EMPTY;
    if (about->class_type == MAT_C_OPAQUE || is_unknown) {
      columns.objects.push_back(name);
      continue;
    }
    const std::unique_ptr<matvar_t, FreeVariable> variable(Mat_VarRead(mat.get(), name.c_str()));
    if (!variable)
      throw std::invalid_argument(
          fmt::format("{}: its variable '{}' cannot be read: is it whole?", limits.name, name));
    columns.add(name, *variable);
  }
  return columns;
}

std::string about_object(const std::string& name, bool is_hdf5) {
  return fmt::format(
      "{} is an object (a table, timetable, string or datetime), which only MATLAB reads: save "
      "table2struct(T, "
      "'ToScalar', true), or its columns, in its place{}",
      name,
      is_hdf5 ? "; where Python wrote it, whose names of classes are padded, save it by scipy.io.savemat"
              : "");
}

/// "'run', 'name' and 3 more": cells, texts, arrays of structs.
std::string quoted(const std::vector<std::string>& names) {
  constexpr std::size_t most_named = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most_named); ++i)
    text += fmt::format("{}'{}'", i == 0 ? "" : ", ", names[i]);
  if (names.size() > most_named) text += fmt::format(" and {} more", names.size() - most_named);
  return text;
}

}  // namespace

MatName::MatName(std::string_view bytes) {
  if (!is_mat(bytes) || !is_hdf5(bytes)) return;
  int file = -1;
  std::tie(file, name_) = named_file();
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written <= 0) {
      const int why = errno;
      ::close(file);
      ::unlink(name_.c_str());
      throw std::system_error(why, std::generic_category(), "no room for a file in memory");
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  ::close(file);
}

MatName::~MatName() {
  if (!name_.empty()) ::unlink(name_.c_str());
}

bool is_mat(std::string_view bytes) noexcept {
  if (bytes.size() < header_size) return false;
  const std::string_view order = bytes.substr(version_at + 2, 2);
  return bytes.starts_with("MATLAB") && (order == "IM" || order == "MI");
}

MatTable mat_table(std::string_view bytes, const std::string& path, const UnpackedLimits& limits) {
  const Columns columns = columns_of(bytes, path, limits);
  const std::size_t length = usual_length(columns.all);
  const std::string objects =
      columns.objects.empty() ? "" : about_object(columns.objects.front(), is_hdf5(bytes));
  std::vector<const MatColumn*> taken;
  MatTable table;
  for (const MatColumn& column : columns.all) {
    if (column.values.size() == length && length > 1) {
      taken.push_back(&column);
    } else {
      table.notes.push_back(
          fmt::format("{} has {} elements and is left out", column.name, column.values.size()));
    }
  }
  if (taken.size() < 2)
    throw std::invalid_argument(
        fmt::format("{}: no two numeric vectors of one length{}{}{}", limits.name,
                    columns.passed_over.empty() ? "" : "; left out as none: ", quoted(columns.passed_over),
                    objects.empty() ? "" : "; " + objects));
  if (!objects.empty()) table.notes.push_back(objects);
  for (const std::string& name : columns.too_large)
    table.notes.push_back(fmt::format(
        "{} has whole numbers beyond 2^53, which would lose their last digits, and is left out: save "
        "double({} - {}(1)) in its place",
        name, name, name));
  for (const std::string& name : columns.passed_over)
    table.notes.push_back(fmt::format("{} is no vector or matrix of real numbers and is left out", name));
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const auto unit = columns.units.find(taken[i]->name);
    table.text += (i > 0 ? "\t" : "") + taken[i]->name +
                  (unit == columns.units.end() ? "" : fmt::format(" [{}]", unit->second));
  }
  table.text += '\n';
  for (std::size_t row = 0; row < length; ++row) {
    for (std::size_t i = 0; i < taken.size(); ++i)
      fmt::format_to(std::back_inserter(table.text), "{}{}", i > 0 ? "\t" : "", taken[i]->values[row]);
    table.text += '\n';
  }
  return table;
}

}  // namespace kerf::bench
