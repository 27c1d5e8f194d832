#include "open_sweep_tables.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include "hdf5/files.h"
#include "validate/inspect.h"

namespace kerf::schema::in_process {
namespace {

constexpr const char* group_of_texts = "values";

[[noreturn]] void refuse_sweep(const std::filesystem::path& file, const std::string& what) {
  throw FormatError(one_line(file.string() + ": " + what + "; 'kerf sweep merge' writes such files"));
}

std::string text_attribute(hid_t object, const std::string& name) {
  if (!h5::has_attribute(object, name)) return {};
  if (h5::describe_attribute(object, name).type != "text") return {};
  const auto all = h5::read_texts(object, name);
  return all.empty() ? std::string() : all.front();
}

std::optional<SweepColumn::Type> type_called(const std::string& name) {
  if (name == "float64") return SweepColumn::Type::number;
  if (name == "uint64") return SweepColumn::Type::whole;
  if (name == "uint32") return SweepColumn::Type::code;
  return std::nullopt;
}

void require_sweep_schema(const std::filesystem::path& file, hid_t root) {
  const std::string schema = text_attribute(root, "schema");
  if (schema != sweep_tables_name)
    refuse_sweep(file, "found " + (schema.empty() ? "no schema" : "the schema " + quoted(schema)) +
                           ", expected a sweep that was merged (" + quoted(std::string(sweep_tables_name)) +
                           ")");
  std::uint32_t version = 0;
  if (h5::has_attribute(root, "schema_version")) {
    const h5::Description found = h5::describe_attribute(root, "schema_version");
    if (found.type == "uint32" && found.extent.empty())
      h5::read_attribute(root, "schema_version", h5::native<std::uint32_t>(), &version);
  }
  if (version != sweep_tables_version)
    refuse_sweep(file, "found version " + std::to_string(version) + " of " + schema + ", expected " +
                           std::to_string(sweep_tables_version));
}

}  // namespace

OpenSweepTables::OpenSweepTables(const std::filesystem::path& file) : file_(file) {
  require_hdf5(file, "a sweep that was merged");
  try {
    opened_ = h5::open_file(file);
    require_sound_texts(file, opened_);
    const auto root = h5::open(opened_.id(), "/");
    require_sweep_schema(file, root.id());
    for (const std::string& name : h5::attributes(root.id())) {
      if (h5::describe_attribute(root.id(), name).type == "text")
        facts_.notes.push_back({.name = name, .text = text_attribute(root.id(), name)});
    }
    read_texts();
    read_tables();
  } catch (const h5::Error& error) {
    throw DamageError(file, error);
  }
}

void OpenSweepTables::read_texts() {
  if (!h5::is_group(opened_.id(), group_of_texts)) return;
  const auto group = h5::open(opened_.id(), group_of_texts);
  for (const std::string& name : h5::children(group.id())) {
    const std::string where = std::string("/values/") + name;
    if (!h5::is_dataset(group.id(), name)) refuse_sweep(file_, where + ": found no dataset");
    const auto dataset = h5::open(group.id(), name);
    const h5::Description found = h5::describe(dataset.id());
    if (found.type != "{text text}" || found.extent.size() != 1)
      refuse_sweep(file_, where + ": found " + found.type + ", expected {text text} of N");
    if (!h5::is_plausible(dataset.id(), std::filesystem::file_size(file_)))
      refuse_sweep(file_, where + ": found more values than the file can hold");
    const std::size_t room = h5::field_sizes(dataset.id()).at(0);
    const std::vector<h5::Field> fields{{.name = "text", .type = "text", .size = room, .offset = 0}};
    const h5::Handle type = h5::record_type(fields, room);
    std::string all(room * found.extent[0], '\0');
    if (!all.empty()) h5::read(dataset.id(), type.id(), found.extent[0], all.data());
    SweepTexts& input = facts_.texts.emplace_back(SweepTexts{.input = name, .texts = {}});
    for (std::size_t at = 0; at < all.size(); at += room) {
      std::string text = all.substr(at, room);
      input.texts.push_back(text.substr(0, text.find('\0')));
    }
  }
}

void OpenSweepTables::read_tables() {
  const auto root = h5::open(opened_.id(), "/");
  for (const std::string& name : h5::children(root.id())) {
    if (name == group_of_texts || !h5::is_group(root.id(), name)) continue;
    const auto group = h5::open(root.id(), name);
    SweepTable& table = facts_.tables.emplace_back(SweepTable{.name = name, .rows = 0, .columns = {}});
    std::vector<h5::Handle>& datasets = datasets_.emplace_back();
    for (const std::string& column : h5::children(group.id())) {
      const std::string where = "/" + name + "/" + column;
      if (!h5::is_dataset(group.id(), column)) refuse_sweep(file_, where + ": found no dataset");
      h5::Handle dataset = h5::open(group.id(), column);
      const h5::Description found = h5::describe(dataset.id());
      const auto type = type_called(found.type);
      if (!type || found.extent.size() != 1)
        refuse_sweep(file_, where + ": found " + found.type + ", expected numbers of N");
      if (!h5::is_plausible(dataset.id(), std::filesystem::file_size(file_)))
        refuse_sweep(file_, where + ": found more values than the file can hold");
      if (table.columns.empty()) table.rows = found.extent[0];
      if (found.extent[0] != table.rows)
        refuse_sweep(file_, where + ": found " + std::to_string(found.extent[0]) + " values, expected " +
                                std::to_string(table.rows) + " as in its first column");
      table.columns.push_back({.name = column, .unit = text_attribute(dataset.id(), "units"), .type = *type});
      datasets.push_back(std::move(dataset));
    }
  }
}

void OpenSweepTables::read(std::size_t table, std::size_t column, std::uint64_t first,
                           std::span<double> values) const {
  const hid_t dataset = datasets_.at(table).at(column).id();
  if (first > facts_.tables[table].rows || values.size() > facts_.tables[table].rows - first)
    throw std::out_of_range(file_.string() + " has no such rows");
  if (values.empty()) return;
  try {
    h5::read(dataset, h5::native<double>(), values.size(), values.data(), first);
  } catch (const h5::Error& error) {
    throw DamageError(file_, error);
  }
}

}  // namespace kerf::schema::in_process
