#include <new>

#include <kerf/schema/recording.h>
#include <kerf/schema/sweep_tables.h>

#include "hdf5/files.h"
#include "in_process.h"
#include "layout/sweep_layout.h"

namespace kerf::schema {
namespace {

SweepTableFacts facts_of_table(hid_t file, const std::string& name) {
  SweepTableFacts facts{.name = name, .rows = 0, .columns = {}};
  const auto group = h5::open(file, "/" + name);
  for (const std::string& column : h5::children(group.id())) {
    const auto dataset = h5::open(group.id(), column);
    const h5::Description about = h5::describe(dataset.id());
    facts.rows = about.extent.front();
    facts.columns.push_back({.name = column,
                             .unit = h5::read_texts(dataset.id(), "units").front(),
                             .type = *sweep_layout::column_type(about.type)});
  }
  return facts;
}

SweepTablesFacts facts_of(hid_t file) {
  SweepTablesFacts facts;
  const auto root = h5::open(file, "/");
  for (const auto& [name, text] : sweep_layout::root_texts)
    facts.*text = h5::read_texts(root.id(), name).front();
  for (const std::string& table : sweep_layout::tables_of(file))
    facts.tables.push_back(facts_of_table(file, table));
  for (const std::string& input : h5::children(h5::open(file, sweep_layout::values).id())) {
    const auto texts = h5::open(file, sweep_layout::texts_of(input));
    facts.values.push_back({.input = input, .count = h5::describe(texts.id()).extent.front()});
  }
  return facts;
}

}  // namespace

SweepTablesFacts in_process::read_sweep_tables_facts(const std::filesystem::path& file) {
  require_hdf5(file, "the tables of a sweep");
  try {
    TreeCheck tree(file);
    sweep_layout::check(tree);
    if (const Finding* const fatal = tree.first_fatal()) {
      const Violation& violation = fatal->violation;
      throw FormatError(one_line(file.string() + ": " + violation.where + ": found " + violation.found +
                                 ", expected " + violation.expected + " (tables of a sweep, schema '" +
                                 std::string(sweep_tables_name) + "')"));
    }
    return facts_of(tree.file());
  } catch (const h5::Error& error) {
    throw DamageError(file, error);
  } catch (const std::bad_alloc&) {
    throw FormatError(file.string() + ": more than fits into the memory; expected the tables of a sweep");
  }
}

}  // namespace kerf::schema
