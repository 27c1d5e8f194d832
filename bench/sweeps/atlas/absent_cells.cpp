#include "atlas/absent_cells.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "files/named_file.h"

namespace kerf::bench {
namespace {

/// The cell of a line of failed.csv. A reason may have lines of its own: they lack the name of a cell.
std::optional<std::uint64_t> failed_in_line(std::string_view line) {
  constexpr std::size_t name_digits = 32;
  std::uint64_t cell = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), cell);
  if (error != std::errc{}) return std::nullopt;
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  if (line.size() < name_digits + 2 || line.front() != ',' || line[name_digits + 1] != ',')
    return std::nullopt;
  return cell;
}

std::vector<std::uint64_t> failed_cells(const std::filesystem::path& csv) {
  std::vector<std::uint64_t> cells;
  std::error_code error;
  if (!std::filesystem::is_regular_file(csv, error)) return cells;
  const std::string text = read_named_file(csv, LargestInput::table);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (const auto cell = failed_in_line(std::string_view(text).substr(begin, end - begin)))
      cells.push_back(*cell);
    begin = end + 1;
  }
  std::ranges::sort(cells);
  return cells;
}

}  // namespace

AbsentCells absent_cells(const schema::SweepTablesFile& tables, const SweepPlan& plan,
                         const std::filesystem::path& file) {
  std::vector<bool> there(plan.cells());
  for (std::size_t table = 0; table < tables.facts().tables.size(); ++table) {
    const auto& columns = tables.facts().tables[table].columns;
    const auto found = std::ranges::find(columns, "cell", &schema::SweepColumn::name);
    if (found == columns.end())
      throw std::invalid_argument(fmt::format("{}: its table {} does not say which cells it has",
                                              file.string(), tables.facts().tables[table].name));
    for (const double cell : tables.column(table, static_cast<std::size_t>(found - columns.begin()))) {
      if (!(cell >= 0.0 && cell < static_cast<double>(there.size())))
        throw std::invalid_argument(fmt::format("{}: it has a cell that its plan does not", file.string()));
      there[static_cast<std::size_t>(cell)] = true;
    }
  }
  const std::vector<std::uint64_t> failed = failed_cells(file.parent_path() / "failed.csv");
  AbsentCells absent;
  for (std::uint64_t cell = 0; cell < there.size(); ++cell) {
    if (there[cell]) continue;
    (std::ranges::binary_search(failed, cell) ? absent.failed : absent.missing).push_back(cell);
  }
  return absent;
}

std::size_t naming_input(const SweepPlan& plan, const std::string& table) {
  for (std::size_t i = 0; i < plan.inputs.size(); ++i) {
    if (!plan.inputs[i].is_text()) continue;
    for (const SweepBlock& block : plan.blocks) {
      if (std::ranges::count(block.inputs[i].listed(), SweepValue(table)) > 0) return i;
    }
  }
  return no_input;
}

AbsentCells absent_in_table(const AbsentCells& all, const SweepPlan& plan, const std::string& table) {
  const std::size_t input = naming_input(plan, table);
  if (input == no_input) return all;
  const auto is_of_table = [&](std::uint64_t cell) {
    return plan.cell(cell).values()[input] == SweepValue(table);
  };
  AbsentCells here;
  std::ranges::copy_if(all.failed, std::back_inserter(here.failed), is_of_table);
  std::ranges::copy_if(all.missing, std::back_inserter(here.missing), is_of_table);
  return here;
}

}  // namespace kerf::bench
