#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "plan/planned_file.h"
#include "regress/run.h"
#include "verbs/sweep_verb.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

/// What a suite names, and the forces that are stored beside it.
std::vector<fs::path> files_of_suite(const fs::path& file) {
  std::vector<fs::path> files = files_named_in(file);
  const Suite suite = read_suite(file);
  if (!fs::is_directory(suite.stored)) {
    files.push_back(suite.stored);
    return files;
  }
  std::vector<fs::path> tables;
  for (const auto& entry : fs::directory_iterator(suite.stored))
    if (entry.is_regular_file()) tables.push_back(entry.path());
  std::ranges::sort(tables);
  files.insert(files.end(), tables.begin(), tables.end());
  return files;
}

std::vector<SweepInput> inputs_of_regressions() {
  using enum SweepInput::Kind;
  return {{.name = "suite",
           .kind = SweepInput::Kind::file,
           .what = "Suite of stored forces, SUITE.toml",
           .required = true,
           .counts_with = files_of_suite},
          {.name = "case", .kind = text, .what = "Case of the suite; none: all of them", .standard = ""}};
}

CellNumbers numbers_of_case(const RegressionOutcome& outcome) {
  if (!outcome.error.empty()) throw std::invalid_argument(outcome.error);
  const ForceComparison& comparison = outcome.comparison;
  CellNumbers numbers{.table = "cases", .columns = {}, .values = {}};
  numbers.add("passed", "1", outcome.passed() ? 1.0 : 0.0);
  numbers.add("ticks", "1", static_cast<double>(comparison.got_rows));
  numbers.add("ticks_stored", "1", static_cast<double>(comparison.expected_rows));
  numbers.add("ticks_differing", "1", static_cast<double>(comparison.differing));
  numbers.add("ticks_outside", "1", static_cast<double>(comparison.outside));
  numbers.add("first_outside", "1",
              comparison.first_outside ? static_cast<double>(*comparison.first_outside)
                                       : std::numeric_limits<double>::quiet_NaN());
  numbers.add("faults", "1", static_cast<double>(outcome.got.faults));
  for (const ChannelComparison& channel : comparison.channels) {
    const std::string& name = channel.channel.name;
    numbers.add(name + "_largest_difference", channel.channel.unit, channel.largest_difference);
    numbers.add(name + "_rms_difference", channel.channel.unit, channel.rms_difference);
    numbers.add(name + "_largest_jnds", "1", channel.largest_jnds);
    numbers.add(name + "_largest_force", channel.channel.unit, channel.largest_got);
  }
  return numbers;
}

CellNumbers numbers_of_suite(const SuiteOutcome& outcome) {
  CellNumbers numbers{.table = "suites", .columns = {}, .values = {}};
  numbers.add("passed", "1", outcome.failed() == 0 ? 1.0 : 0.0);
  numbers.add("cases", "1", static_cast<double>(outcome.cases.size()));
  numbers.add("failed", "1", static_cast<double>(outcome.failed()));
  numbers.add("errors", "1", static_cast<double>(outcome.errors()));
  numbers.add("dropped", "1", static_cast<double>(outcome.dropped.size()));
  return numbers;
}

class RegressCells final : public CellWork {
 public:
  explicit RegressCells(fs::path folder) : folder_(std::move(folder)) {}

  CellNumbers compute(const SweepCell& cell) override {
    if (cell.text("suite") != name_) {
      suite_ = read_suite(folder_ / cell.text("suite"));
      name_ = cell.text("suite");
    }
    SuiteOptions options{.tick_costs = false};
    if (!cell.text("case").empty()) options.only = {cell.text("case")};
    require_own_laws(only(*suite_, options.only));
    const SuiteOutcome outcome = run_suite(*suite_, options);
    return options.only.empty() ? numbers_of_suite(outcome) : numbers_of_case(outcome.cases.at(0));
  }

 private:
  /// What a program of others computes, its file alone does not say.
  static void require_own_laws(const Suite& suite) {
    for (const RegressionCase& one : suite.cases)
      if (one.outside && !one.outside->command.empty())
        throw std::invalid_argument(
            fmt::format("case '{}' is rendered by a program, and a sweep runs laws alone", one.name));
  }

  fs::path folder_;
  std::string name_;
  std::optional<Suite> suite_;
};

}  // namespace

const SweepVerb sweep_of_regressions{
    .name = "regress",
    .what = "compares rendered forces with stored ones, as 'kerf regress run --no-cost' does",
    .inputs = inputs_of_regressions,
    .begin = [](const SweepPlan& plan) -> std::unique_ptr<CellWork> {
      return std::make_unique<RegressCells>(plan.folder);
    }};

}  // namespace kerf::bench
