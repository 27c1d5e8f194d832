#include "open_sweep_tables.h"

#include <stdexcept>
#include <string>
#include <utility>

#include <kerf/schema/recording.h>

#include "hdf5/files.h"
#include "layout/sweep_layout.h"

namespace kerf::schema::in_process {

OpenSweepTables::OpenSweepTables(const std::filesystem::path& file) : file_(file) {
  require_hdf5(file, "the tables of a sweep");
  try {
    require_layout();
    opened_ = h5::open_file(file);
    const auto root = h5::open(opened_.id(), "/");
    for (const auto& [name, text] : sweep_layout::root_texts)
      facts_.*text = h5::read_texts(root.id(), name).front();
    for (const std::string& input : h5::children(h5::open(opened_.id(), sweep_layout::values).id()))
      facts_.texts.push_back(texts_of(input));
    for (const std::string& table : sweep_layout::tables_of(opened_.id())) open_table(table);
  } catch (const h5::Error& error) {
    throw DamageError(file, error.what());
  }
}

void OpenSweepTables::require_layout() {
  TreeCheck tree(file_);
  sweep_layout::check(tree);
  if (const Finding* const fatal = tree.first_fatal()) {
    const Violation& violation = fatal->violation;
    throw FormatError(one_line(file_.string() + ": " + violation.where + ": found " + violation.found +
                               ", expected " + violation.expected + " (tables of a sweep, schema '" +
                               std::string(sweep_tables_name) + "')"));
  }
}

SweepTablesFacts::Texts OpenSweepTables::texts_of(const std::string& input) const {
  const auto dataset = h5::open(opened_.id(), sweep_layout::texts_of(input));
  const hsize_t count = h5::describe(dataset.id()).extent.front();
  const std::size_t room = h5::field_sizes(dataset.id()).at(0);
  const std::vector<h5::Field> fields{{.name = "text", .type = "text", .size = room, .offset = 0}};
  std::string all(room * count, '\0');
  if (!all.empty()) h5::read(dataset.id(), h5::record_type(fields, room).id(), count, all.data());
  SweepTablesFacts::Texts texts{.input = input, .texts = {}};
  for (std::size_t at = 0; at < all.size(); at += room) {
    const std::string text = all.substr(at, room);
    texts.texts.push_back(text.substr(0, text.find('\0')));
  }
  return texts;
}

void OpenSweepTables::open_table(const std::string& name) {
  SweepTable& table = facts_.tables.emplace_back(SweepTable{.name = name, .rows = 0, .columns = {}});
  std::vector<h5::Handle>& datasets = datasets_.emplace_back();
  const auto group = h5::open(opened_.id(), "/" + name);
  for (const std::string& column : h5::children(group.id())) {
    h5::Handle dataset = h5::open(group.id(), column);
    const h5::Description about = h5::describe(dataset.id());
    table.rows = about.extent.front();
    table.columns.push_back({.name = column,
                             .unit = h5::read_texts(dataset.id(), "units").front(),
                             .type = *sweep_layout::column_type(about.type)});
    datasets.push_back(std::move(dataset));
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
    throw DamageError(file_, error.what());
  }
}

}  // namespace kerf::schema::in_process
