#include "atlas/sweep_atlas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/validate.h>

#include "plan/plan_file.h"
#include "verbs/sweep_verb.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* not_given = "not given";

SweepPlan plan_in(const schema::SweepTablesFacts& facts, const fs::path& file, SweepVerbs verbs) {
  try {
    SweepPlan plan = plan_from_json(nlohmann::ordered_json::parse(facts.plan), file.parent_path(), verbs);
    if (plan.cells() > SweepAtlas::most_cells)
      throw std::invalid_argument(fmt::format("its plan has {} cells, and at most {} are drawn", plan.cells(),
                                              SweepAtlas::most_cells));
    return plan;
  } catch (const nlohmann::json::exception&) {
    throw std::invalid_argument(fmt::format("{}: its plan is none", file.string()));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", file.string(), error.what()));
  }
}

/// All values that an input has in the blocks of a table; none where there are too many to be listed.
void list_values(const SweepPlan& plan, std::size_t input, const std::string& table, AtlasColumn& column) {
  const std::size_t naming = naming_input(plan, table);
  std::set<double> numbers;
  std::set<std::string> texts;
  bool is_missing = false;
  const auto add = [&](const SweepValue& value) {
    if (const auto* const number = std::get_if<double>(&value)) {
      numbers.insert(*number);
    } else {
      texts.insert(std::get<std::string>(value));
    }
  };
  for (const SweepBlock& block : plan.blocks) {
    if (naming != no_input && std::ranges::count(block.inputs[naming].listed(), SweepValue(table)) == 0)
      continue;
    const InputValues& values = block.inputs[input];
    if (values.size() > SweepAtlas::most_values) return;
    if (input == naming) {
      texts.insert(table);
      continue;
    }
    for (std::uint64_t i = 0; i < values.size(); ++i) add(values.at(i));
    if (values.size() > 0) continue;
    if (plan.inputs[input].standard) {
      add(*plan.inputs[input].standard);
    } else {
      is_missing = true;
    }
  }
  if (numbers.size() + texts.size() > SweepAtlas::most_values) return;
  column.values.assign(numbers.begin(), numbers.end());
  for (const double number : numbers) column.texts.push_back(value_text(number));
  column.texts.insert(column.texts.end(), texts.begin(), texts.end());
  if (!is_missing) return;
  if (!column.values.empty()) column.values.push_back(std::numeric_limits<double>::quiet_NaN());
  column.texts.emplace_back(not_given);
}

std::uint16_t code_of(const AtlasColumn& column, double value) {
  const auto last = static_cast<std::uint16_t>(column.texts.size() - 1);
  if (std::isnan(value)) return last;
  const auto end = column.values.end() - (std::isnan(column.values.back()) ? 1 : 0);
  const auto found = std::lower_bound(column.values.begin(), end, value);
  if (found == end || *found != value)
    throw std::invalid_argument(
        fmt::format("the column {} has the value {}, which its plan does not have", column.name, value));
  return static_cast<std::uint16_t>(found - column.values.begin());
}

std::uint16_t code_of(const AtlasColumn& column, const std::string& text) {
  const auto found = std::ranges::find(column.texts, text);
  if (found == column.texts.end())
    throw std::invalid_argument(
        fmt::format("the column {} has the value '{}', which its plan does not have", column.name, text));
  return static_cast<std::uint16_t>(found - column.texts.begin());
}

}  // namespace

fs::path merged_file(const fs::path& merged) {
  std::error_code error;
  return fs::is_directory(merged, error) ? merged / "sweep.h5" : merged;
}

bool is_merged_sweep(const fs::path& path) {
  return schema::schema_of(merged_file(path)) == schema::sweep_tables_name;
}

std::size_t AtlasTable::column_called(std::string_view column) const {
  const auto found = std::ranges::find(columns, column, &AtlasColumn::name);
  if (found != columns.end()) return static_cast<std::size_t>(found - columns.begin());
  std::string known;
  for (const AtlasColumn& one : columns) known += (known.empty() ? "" : ", ") + one.name;
  throw std::invalid_argument(fmt::format("{} has no column '{}'; it has {}", name, column, known));
}

SweepAtlas::SweepAtlas(const fs::path& merged, SweepVerbs verbs)
    : file_(merged_file(merged)), tables_file_(file_), plan_(plan_in(tables_file_.facts(), file_, verbs)) {
  const AbsentCells absent = absent_cells(tables_file_, plan_, file_);
  for (const schema::SweepTable& table : tables_file_.facts().tables)
    add_table(table, absent_in_table(absent, plan_, table.name));
  if (tables_.empty())
    throw std::invalid_argument(
        fmt::format("{}: no cell was computed, so there is nothing to draw", file_.string()));
}

void SweepAtlas::add_table(const schema::SweepTable& table, AbsentCells absent) {
  AtlasTable& added = tables_.emplace_back();
  added.name = table.name;
  added.computed = table.rows;
  added.failed = std::move(absent.failed);
  added.missing = std::move(absent.missing);
  for (std::size_t i = 0; i < plan_.inputs.size(); ++i) {
    const SweepInput& input = plan_.inputs[i];
    if (std::ranges::find(table.columns, input.name, &schema::SweepColumn::name) == table.columns.end())
      throw std::invalid_argument(
          fmt::format("{}: its table {} has no column '{}'", file_.string(), table.name, input.name));
    AtlasColumn column{.name = input.name, .unit = input.unit, .what = input.what, .is_input = true};
    list_values(plan_, i, table.name, column);
    added.columns.push_back(std::move(column));
  }
  for (const schema::SweepColumn& column : table.columns) {
    const bool known = column.name == "cell" || std::ranges::find(added.columns, column.name,
                                                                  &AtlasColumn::name) != added.columns.end();
    if (!known) added.columns.push_back({.name = column.name, .unit = column.unit, .what = "result"});
  }
}

std::string SweepAtlas::software() const { return tables_file_.facts().software; }

std::size_t SweepAtlas::table_called(std::string_view name) const {
  const auto found = std::ranges::find(tables_, name, &AtlasTable::name);
  if (found != tables_.end()) return static_cast<std::size_t>(found - tables_.begin());
  std::string known;
  for (const AtlasTable& one : tables_) known += (known.empty() ? "" : ", ") + one.name;
  throw std::invalid_argument(fmt::format("{} has no table '{}'; it has {}", file_.string(), name, known));
}

std::size_t SweepAtlas::place_in_file(std::size_t table, const std::string& column) const {
  const auto& columns = tables_file_.facts().tables.at(table).columns;
  return static_cast<std::size_t>(std::ranges::find(columns, column, &schema::SweepColumn::name) -
                                  columns.begin());
}

AtlasValues SweepAtlas::read(std::size_t table, std::size_t column) const {
  const AtlasTable& of = tables_.at(table);
  const AtlasColumn& about = of.columns.at(column);
  AtlasValues values{.codes = {}, .numbers = tables_file_.column(table, place_in_file(table, about.name))};
  if (!about.is_input) return values;
  std::vector<std::optional<SweepValue>> absent;
  for (const auto* const cells : {&of.failed, &of.missing})
    for (const std::uint64_t cell : *cells) absent.push_back(plan_.cell(cell).values()[column]);
  if (!about.is_listed()) {
    for (const auto& value : absent)
      values.numbers.push_back(value && std::holds_alternative<double>(*value)
                                   ? std::get<double>(*value)
                                   : std::numeric_limits<double>::quiet_NaN());
    return values;
  }
  values.codes.reserve(of.cells());
  if (about.is_text()) {
    const auto& texts = tables_file_.facts().texts;
    const auto found = std::ranges::find(texts, about.name, &schema::SweepTablesFacts::Texts::input);
    std::vector<std::uint16_t> codes;
    if (found != texts.end()) {
      for (const std::string& text : found->texts) {
        const auto here = std::ranges::find(about.texts, text);
        codes.push_back(static_cast<std::uint16_t>(here - about.texts.begin()));
      }
    }
    for (const double number : values.numbers) {
      const auto place = number >= 0.0 ? static_cast<std::size_t>(number) : codes.size();
      const std::uint16_t code = place < codes.size() ? codes[place] : code_of(about, not_given);
      if (code >= about.texts.size())
        throw std::invalid_argument(
            fmt::format("{}: its column {} names what its plan does not have", file_.string(), about.name));
      values.codes.push_back(code);
    }
  } else {
    for (const double number : values.numbers) values.codes.push_back(code_of(about, number));
  }
  for (const auto& value : absent)
    values.codes.push_back(!value            ? code_of(about, std::string(not_given))
                           : about.is_text() ? code_of(about, std::get<std::string>(*value))
                                             : code_of(about, std::get<double>(*value)));
  values.numbers = {};
  return values;
}

std::shared_ptr<const AtlasValues> SweepAtlas::values(std::size_t table, std::size_t column) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find_if(
      kept_, [&](const Kept& one) { return one.table == table && one.column == column; });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
    return kept_.front().values;
  }
  auto values = std::make_shared<const AtlasValues>(read(table, column));
  kept_.push_front({.table = table, .column = column, .values = values});
  std::size_t bytes = 0;
  for (auto it = kept_.begin(); it != kept_.end(); ++it) {
    bytes += it->values->bytes();
    if (it == kept_.begin() || bytes <= most_bytes) continue;
    kept_.erase(it, kept_.end());
    break;
  }
  return values;
}

}  // namespace kerf::bench
