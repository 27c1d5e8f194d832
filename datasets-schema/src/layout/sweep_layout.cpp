#include "layout/sweep_layout.h"

#include <algorithm>

namespace kerf::schema::sweep_layout {
namespace {

constexpr std::string_view type_of_texts = "{text text}";

void check_values(TreeCheck& tree) {
  if (!tree.has_group(values)) return;
  tree.only_attributes(values, {});
  for (const std::string& input : h5::children(h5::open(tree.file(), values).id()))
    (void)tree.extent_of(texts_of(input), std::string(type_of_texts), 1);
}

void check_column(TreeCheck& tree, const std::string& table, const std::string& name,
                  std::optional<hsize_t>& rows) {
  const std::string path = "/" + table + "/" + name;
  if (!h5::is_dataset(tree.file(), path)) return tree.fail(path, "no dataset", "a column");
  const std::string type = h5::describe(h5::open(tree.file(), path).id()).type;
  const auto known = column_type(type);
  if (!known) return tree.fail(path, type, "float64, uint64 or uint32");
  const auto extent = tree.extent_of(path, type, 1);
  if (!extent) return;
  (void)tree.has_attribute(path, {.name = "units", .type = "text"});
  tree.only_attributes(path, {"units"});
  if (name == column_of_cells && *known != SweepColumn::Type::whole)
    tree.fail(path, type, "uint64, the numbers of cells");
  if (*known == SweepColumn::Type::code && !h5::is_dataset(tree.file(), texts_of(name)))
    tree.fail(path, "places in " + texts_of(name) + ", which is not there", "texts for them");
  if (rows && *rows != extent->front())
    tree.fail(path, std::to_string(extent->front()) + " rows",
              std::to_string(*rows) + ", as the column before");
  rows = extent->front();
}

void check_table(TreeCheck& tree, const std::string& table) {
  tree.only_attributes("/" + table, {});
  const auto columns = h5::children(h5::open(tree.file(), "/" + table).id());
  std::optional<hsize_t> rows;
  for (const std::string& column : columns) check_column(tree, table, column, rows);
  if (std::ranges::find(columns, column_of_cells) == columns.end())
    tree.fail("/" + table, "no column 'cell'", "the number of each row's cell");
}

}  // namespace

std::string texts_of(const std::string& input) { return values + "/" + input; }

std::optional<SweepColumn::Type> column_type(std::string_view type) {
  if (type == "float64") return SweepColumn::Type::number;
  if (type == "uint64") return SweepColumn::Type::whole;
  if (type == "uint32") return SweepColumn::Type::code;
  return std::nullopt;
}

std::vector<std::string> tables_of(hid_t file) {
  std::vector<std::string> tables = h5::children(h5::open(file, "/").id());
  std::erase(tables, values.substr(1));
  return tables;
}

void check(TreeCheck& tree) {
  if (!tree.is(sweep_tables_name, sweep_tables_version)) return;
  std::vector<std::string_view> known{"schema", "schema_version"};
  for (const RootText& text : root_texts) {
    known.emplace_back(text.name);
    (void)tree.has_attribute("/", {.name = text.name, .type = "text"});
  }
  tree.only_attributes("/", known);
  check_values(tree);
  for (const std::string& table : tables_of(tree.file()))
    if (tree.has_group("/" + table)) check_table(tree, table);
}

}  // namespace kerf::schema::sweep_layout
