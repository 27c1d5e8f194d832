#include <algorithm>
#include <optional>
#include <vector>

#include "layout/sweep_layout.h"
#include "open_sweep_tables.h"
#include "validate/validators.h"

namespace kerf::schema {
namespace {

constexpr hsize_t values_at_once = 65536;

/// Goes through a column of whole numbers, and tells of the first that breaks a rule.
template <typename T, typename Breaks>
void check_values_of(hid_t file, const std::string& path, const std::string& expected,
                     std::vector<Violation>& violations, Breaks breaks) {
  const auto dataset = h5::open(file, path);
  const hsize_t rows = h5::describe(dataset.id()).extent.front();
  std::vector<T> values(std::min(rows, values_at_once));
  for (hsize_t first = 0; first < rows; first += values.size()) {
    const hsize_t count = std::min<hsize_t>(values.size(), rows - first);
    h5::read(dataset.id(), h5::native<T>(), count, values.data(), first);
    for (hsize_t i = 0; i < count; ++i) {
      if (!breaks(values[i])) continue;
      violations.push_back({path + " row " + std::to_string(first + i), std::to_string(values[i]), expected});
      return;
    }
  }
}

void check_rows(hid_t file, const SweepTable& table, const SweepTablesFacts& facts,
                std::vector<Violation>& violations) {
  for (const SweepColumn& column : table.columns) {
    const std::string path = "/" + table.name + "/" + column.name;
    if (column.name == sweep_layout::column_of_cells) {
      std::optional<std::uint64_t> before;
      check_values_of<std::uint64_t>(file, path, "cells in their order, each once", violations,
                                     [&](std::uint64_t cell) {
                                       const bool breaks = before && cell <= *before;
                                       before = cell;
                                       return breaks;
                                     });
    } else if (column.type == SweepColumn::Type::code) {
      const auto texts = std::ranges::find(facts.texts, column.name, &SweepTablesFacts::Texts::input);
      check_values_of<std::uint32_t>(
          file, path, "a place among the " + std::to_string(texts->texts.size()) + " texts", violations,
          [&](std::uint32_t code) { return code >= texts->texts.size(); });
    }
  }
}

}  // namespace

void validate_sweep_tables(const std::filesystem::path& file, std::vector<Violation>& violations) {
  TreeCheck tree(file);
  sweep_layout::check(tree);
  for (const Finding& finding : tree.findings()) violations.push_back(finding.violation);
  if (tree.first_fatal() != nullptr) return;
  const in_process::OpenSweepTables opened(file);
  for (const SweepTable& table : opened.facts().tables)
    check_rows(tree.file(), table, opened.facts(), violations);
}

}  // namespace kerf::schema
