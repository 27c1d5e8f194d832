#include "merge/merge_sweep.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <kerf/schema/sweep_tables.h>

#include "merge/csv_file.h"
#include "verbs/sweep_verb.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t rows_at_once = 4096;

/// The texts that an input has anywhere in a plan, in order.
std::vector<std::string> texts_of_input(const SweepPlan& plan, std::size_t input) {
  std::set<std::string> texts;
  const auto add = [&](const SweepValue& value) { texts.insert(std::get<std::string>(value)); };
  for (const SweepBlock& block : plan.blocks) {
    for (const SweepValue& value : block.inputs[input].listed()) add(value);
    if (block.inputs[input].size() == 0 && plan.inputs[input].standard) add(*plan.inputs[input].standard);
  }
  return {texts.begin(), texts.end()};
}

/// "N_per_m": HDF5 would make a group of what is before a '/'.
std::string unit_in_name(std::string unit) {
  for (auto at = unit.find('/'); at != std::string::npos; at = unit.find('/')) unit.replace(at, 1, "_per_");
  return unit;
}

/// A table in both of its forms while rows come in.
class GrowingTable {
 public:
  GrowingTable(const MergedTable& table, const SweepPlan& plan,
               const std::vector<std::vector<std::string>>& texts, const fs::path& folder,
               schema::SweepTablesWriter& hdf5)
      : plan_(&plan), texts_(&texts), csv_(folder / (table.name + ".csv")), hdf5_(&hdf5) {
    std::vector<schema::SweepColumn> columns{{.name = "cell", .type = schema::SweepColumn::Type::whole}};
    csv_.field("cell");
    csv_.field("name");
    for (const SweepInput& input : plan.inputs) {
      columns.push_back(
          {.name = input.name,
           .unit = input.unit,
           .type = input.is_text() ? schema::SweepColumn::Type::code : schema::SweepColumn::Type::number});
      csv_.field(input.name);
    }
    for (const CellColumn& column : table.columns) {
      columns.push_back({.name = column.name, .unit = column.unit});
      csv_.field(column.name);
    }
    csv_.end_line();
    number_ = hdf5.add_table(table.name, table.rows, columns);
    waiting_.resize(columns.size());
    row_.resize(table.columns.size());
  }

  void add(const SweepCell& cell, const std::vector<std::size_t>& places, const std::vector<double>& values) {
    csv_.field(cell.number());
    csv_.field(plan_->name_of(cell));
    std::size_t column = 0;
    waiting_[column++].push_back(static_cast<double>(cell.number()));
    for (std::size_t i = 0; i < plan_->inputs.size(); ++i) waiting_[column++].push_back(add_input(cell, i));
    std::ranges::fill(row_, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < places.size(); ++i) row_[places[i]] = values[i];
    for (const double value : row_) {
      csv_.field(value);
      waiting_[column++].push_back(value);
    }
    csv_.end_line();
    if (waiting_.front().size() >= rows_at_once) hand_over();
  }
  void close() {
    hand_over();
    csv_.close();
  }

 private:
  double add_input(const SweepCell& cell, std::size_t input) {
    const auto& value = cell.values()[input];
    if (!value) {
      csv_.field("");
      return std::numeric_limits<double>::quiet_NaN();
    }
    if (const auto* const number = std::get_if<double>(&*value)) {
      csv_.field(*number);
      return *number;
    }
    const auto& text = std::get<std::string>(*value);
    csv_.field(text);
    const auto& all = (*texts_)[input];
    return static_cast<double>(std::ranges::lower_bound(all, text) - all.begin());
  }
  void hand_over() {
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      hdf5_->append(number_, i, waiting_[i]);
      waiting_[i].clear();
    }
  }

  const SweepPlan* plan_;
  const std::vector<std::vector<std::string>>* texts_;
  CsvFile csv_;
  schema::SweepTablesWriter* hdf5_;
  std::size_t number_ = 0;
  std::vector<std::vector<double>> waiting_;
  std::vector<double> row_;
};

/// The cells that have no numbers, and how long each took.
class SideTables {
 public:
  SideTables(const SweepPlan& plan, const fs::path& folder)
      : plan_(&plan),
        failed_(folder / "failed.csv"),
        missing_(folder / "missing.csv"),
        times_(folder / "times.csv") {
    for (const char* name : {"cell", "name"}) failed_.field(name);
    for (const SweepInput& input : plan.inputs) failed_.field(input.name);
    for (const char* name : {"failure", "why"}) failed_.field(name);
    failed_.end_line();
    for (const char* name : {"first_cell", "last_cell"}) missing_.field(name);
    missing_.end_line();
    for (const char* name : {"cell", "processor_time_s"}) times_.field(name);
    times_.end_line();
  }

  void add_failed(const SweepCell& cell, const FailedCell& failed) {
    failed_.field(cell.number());
    failed_.field(plan_->name_of(cell));
    for (const auto& value : cell.values()) failed_.field(value ? value_text(*value) : "");
    failed_.field(in_words(failed.failure));
    failed_.field(failed.why);
    failed_.end_line();
  }
  void add_time(std::uint64_t cell, double seconds) {
    times_.field(cell);
    times_.field(seconds);
    times_.end_line();
  }
  void add_missing(std::uint64_t cell) {
    if (first_missing_ && last_missing_ + 1 != cell) end_missing();
    if (!first_missing_) first_missing_ = cell;
    last_missing_ = cell;
  }
  void close() {
    end_missing();
    for (CsvFile* const file : {&failed_, &missing_, &times_}) file->close();
  }

 private:
  void end_missing() {
    if (!first_missing_) return;
    missing_.field(*first_missing_);
    missing_.field(last_missing_);
    missing_.end_line();
    first_missing_.reset();
  }

  const SweepPlan* plan_;
  CsvFile failed_;
  CsvFile missing_;
  CsvFile times_;
  std::optional<std::uint64_t> first_missing_;
  std::uint64_t last_missing_ = 0;
};

void write_dictionary(const SweepPlan& plan, const MergedTables& tables, const fs::path& folder) {
  CsvFile file(folder / "columns.csv");
  const auto line = [&](std::string_view table, std::string_view name, std::string_view unit,
                        std::string_view what) {
    for (const std::string_view text : {table, name, unit, what}) file.field(text);
    file.end_line();
  };
  line("table", "column", "unit", "what");
  for (const MergedTable& table : tables.all()) {
    line(table.name, "cell", "1", "number of the cell in the plan");
    line(table.name, "name", "1", "what the cell is, the same in every sweep");
    for (const SweepInput& input : plan.inputs) line(table.name, input.name, input.unit, input.what);
    for (const CellColumn& column : table.columns) line(table.name, column.name, column.unit, "result");
  }
  file.close();
}

void describe_sweep(schema::SweepTablesWriter& hdf5, const PlanFile& plan, const GatheredCells& cells) {
  hdf5.describe("plan_sha256", plan.sha256);
  hdf5.describe("plan", plan.plan.as_json().dump());
  std::string programs;
  for (const std::string& one : cells.software()) programs += (programs.empty() ? "" : ", ") + one;
  hdf5.describe("software", programs);
  hdf5.describe("cells", fmt::format("{} computed, {} failed, {} missing", cells.computed(), cells.failed(),
                                     cells.missing()));
}

}  // namespace

MergedTables::MergedTables(const GatheredCells& cells) {
  std::map<std::string, std::vector<std::pair<std::uint64_t, const CellLayout*>>> layouts;
  for (const auto& [number, layout] : cells.layouts()) layouts[layout.table].emplace_back(number, &layout);
  for (auto& [name, all] : layouts) {
    std::ranges::sort(all, [](const auto& one, const auto& other) {
      const std::size_t of_one = one.second->columns.size();
      const std::size_t of_other = other.second->columns.size();
      return of_one != of_other ? of_one > of_other : one.second->as_text() < other.second->as_text();
    });
    MergedTable table{.name = name};
    for (const auto& [number, layout] : all) {
      Place place{.table = tables_.size(), .columns = {}};
      for (const CellColumn& column : layout->columns) {
        const auto found = std::ranges::find(table.columns, column);
        place.columns.push_back(static_cast<std::size_t>(found - table.columns.begin()));
        if (found == table.columns.end()) table.columns.push_back(column);
      }
      places_.emplace(number, std::move(place));
    }
    std::map<std::string, int> units;
    for (const CellColumn& column : table.columns) ++units[column.name];
    for (CellColumn& column : table.columns)
      if (units[column.name] > 1) column.name += "_" + unit_in_name(column.unit);
    tables_.push_back(std::move(table));
  }
  for (std::uint64_t cell = 0; cell < cells.cells(); ++cell) {
    if (!cells.has(cell)) continue;
    const CellRecord record = cells.record(cell);
    if (const auto* const computed = std::get_if<ComputedCell>(&record))
      ++tables_[places_.at(computed->layout).table].rows;
  }
}

void write_merged(const PlanFile& plan, const GatheredCells& cells, const fs::path& folder,
                  std::atomic<std::size_t>& done) {
  const MergedTables tables(cells);
  schema::SweepTablesWriter hdf5(folder / "sweep.h5");
  describe_sweep(hdf5, plan, cells);
  std::vector<std::vector<std::string>> texts(plan.plan.inputs.size());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (!plan.plan.inputs[i].is_text()) continue;
    texts[i] = texts_of_input(plan.plan, i);
    hdf5.add_values(plan.plan.inputs[i].name, texts[i]);
  }
  std::deque<GrowingTable> growing;
  for (const MergedTable& table : tables.all()) growing.emplace_back(table, plan.plan, texts, folder, hdf5);
  SideTables side(plan.plan, folder);
  for (std::uint64_t number = 0; number < cells.cells(); ++number, ++done) {
    if (!cells.has(number)) {
      side.add_missing(number);
      continue;
    }
    const SweepCell cell = plan.plan.cell(number);
    const CellRecord record = cells.record(number);
    if (const auto* const computed = std::get_if<ComputedCell>(&record)) {
      const MergedTables::Place& place = tables.of(computed->layout);
      growing[place.table].add(cell, place.columns, computed->values());
      side.add_time(number, computed->seconds);
    } else {
      side.add_failed(cell, std::get<FailedCell>(record));
      side.add_time(number, std::get<FailedCell>(record).seconds);
    }
  }
  for (GrowingTable& table : growing) table.close();
  side.close();
  hdf5.commit(schema::Existing::replace);
  write_dictionary(plan.plan, tables, folder);
}

}  // namespace kerf::bench
