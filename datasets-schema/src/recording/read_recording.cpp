#include <type_traits>
#include <variant>

#include <kerf/schema/recording.h>

#include "layout/layout.h"
#include "recording/recording_parts.h"
#include "validate/inspect.h"

namespace kerf::schema {
namespace {

template <typename T>
std::vector<T> read_values(hid_t file, const std::string& path, hsize_t rows) {
  const auto dataset = h5::open(file, path);
  const auto extent = h5::describe(dataset.id()).extent;
  std::vector<T> values(rows * (extent.size() > 1 ? extent[1] : 1));
  if (!values.empty()) h5::read(dataset.id(), h5::native<T>(), rows, values.data());
  return values;
}

void read_rows(hid_t file, const layout::Dataset& rule, hsize_t rows, Recording& recording) {
  const std::string path(rule.path);
  if (!rule.shape.starts_with('N') || !h5::is_dataset(file, path)) return;
  std::visit(
      [&](auto member) {
        if constexpr (std::is_invocable_v<decltype(member), Recording&>) {
          auto& values = recording.*member;
          values = read_values<typename std::decay_t<decltype(values)>::value_type>(file, path, rows);
        }
      },
      rule.member);
}

}  // namespace

Recording read_inspected(const Inspection& inspection) {
  const hid_t file = inspection.file.id();
  Recording recording = read_all_but_rows(inspection);
  const hsize_t rows = rows_in_every_dataset(inspection);
  for (const auto& rule : layout::datasets()) read_rows(file, rule, rows, recording);
  for (auto& channel : recording.channels) {
    channel.values = read_values<double>(file, channel_path(channel.name), rows);
  }
  return recording;
}

}  // namespace kerf::schema
