#include "formats/mat_table.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>
#include <matio.h>
#include <sys/mman.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

constexpr std::size_t version_at = 124;
constexpr std::size_t header_size = 128;

/// A file in memory that has a path: matio reads files only, and what comes may be a pipe or packed.
class NamedMemory {
 public:
  explicit NamedMemory(std::string_view bytes) : file_(memfd_create("kerf-mat", MFD_CLOEXEC)) {
    if (file_ < 0) throw std::system_error(errno, std::generic_category(), "no file in memory");
    while (!bytes.empty()) {
      const ssize_t written = ::write(file_, bytes.data(), bytes.size());
      if (written <= 0) {
        const int why = errno;
        ::close(file_);
        throw std::system_error(why, std::generic_category(), "no room for a file in memory");
      }
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  NamedMemory(const NamedMemory&) = delete;
  NamedMemory& operator=(const NamedMemory&) = delete;
  ~NamedMemory() { ::close(file_); }
  [[nodiscard]] std::string path() const { return fmt::format("/proc/self/fd/{}", file_); }

 private:
  int file_;
};

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
    if (variable.class_type == MAT_C_STRUCT && variable.nbytes > 0 && depth < most_depth)
      return add_fields(name, variable, depth);
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

 private:
  static constexpr std::size_t most_columns = 1000;
  static constexpr std::size_t most_depth = 16;

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

Columns columns_of(std::string_view bytes, const UnpackedLimits& limits) {
  const NamedMemory file(bytes);
  const std::unique_ptr<mat_t, CloseMat> mat(Mat_Open(file.path().c_str(), MAT_ACC_RDONLY));
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
    if (about->class_type == MAT_C_OPAQUE) {
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

}  // namespace

bool is_mat(std::string_view bytes) noexcept {
  if (bytes.size() < header_size) return false;
  const std::string_view order = bytes.substr(version_at + 2, 2);
  return bytes.starts_with("MATLAB") && (order == "IM" || order == "MI");
}

MatTable mat_table(std::string_view bytes, const UnpackedLimits& limits) {
  if (bytes.substr(0, version_at).find("MATLAB 7.3") != std::string_view::npos)
    throw std::invalid_argument(
        fmt::format("{}: a MAT-file of version 7.3; save it anew with save(..., '-v7')", limits.name));
  const Columns columns = columns_of(bytes, limits);
  const std::size_t length = usual_length(columns.all);
  const std::string objects =
      columns.objects.empty()
          ? ""
          : fmt::format(
                "{} is an object (a table, timetable, string or datetime), which only MATLAB reads: save "
                "table2struct(T, 'ToScalar', true), or its columns, in its place",
                columns.objects.front());
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
    throw std::invalid_argument(fmt::format("{}: no two numeric vectors of one length{}{}", limits.name,
                                            objects.empty() ? "" : "; ", objects));
  if (!objects.empty()) table.notes.push_back(objects);
  for (const std::string& name : columns.passed_over)
    table.notes.push_back(fmt::format("{} is no vector or matrix of real numbers and is left out", name));
  for (std::size_t i = 0; i < taken.size(); ++i) table.text += (i > 0 ? "\t" : "") + taken[i]->name;
  table.text += '\n';
  for (std::size_t row = 0; row < length; ++row) {
    for (std::size_t i = 0; i < taken.size(); ++i)
      fmt::format_to(std::back_inserter(table.text), "{}{}", i > 0 ? "\t" : "", taken[i]->values[row]);
    table.text += '\n';
  }
  return table;
}

}  // namespace kerf::bench
