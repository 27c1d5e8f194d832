#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include <fmt/format.h>

#include <kerf/schema/recording.h>

#include "laws/law_file.h"
#include "run/run.h"
#include "verbs/simulated_device.h"
#include "verbs/sweep_verb.h"

namespace kerf::bench {
namespace {

std::vector<SweepInput> inputs_of_checks() {
  using enum SweepInput::Kind;
  std::vector<SweepInput> inputs{{.name = "law", .kind = file, .what = "Law file", .required = true}};
  for (SweepInput& input : simulated_device_inputs()) inputs.push_back(std::move(input));
  inputs.insert(inputs.end(), {{.name = "controller",
                                .kind = text,
                                .what = "Passivity controller",
                                .among = {"off", "on"},
                                .standard = "off"},
                               {.name = "rate",
                                .what = "Rate of the loop",
                                .unit = "Hz",
                                .lower = 100,
                                .upper = 10000,
                                .standard = 1000.0},
                               {.name = "seconds",
                                .what = "Virtual time of the run",
                                .unit = "s",
                                .lower = 0.01,
                                .upper = 3600,
                                .standard = 10.0}});
  return inputs;
}

/// What the rows of a run say, gathered in the tick.
struct PeaksOfARun {
  double force = 0.0;
  double speed = 0.0;

  void see(const schema::Row& row) noexcept {
    for (const double value : row.force_commanded) force = std::max(force, std::abs(value));
    for (const double value : row.velocity) speed = std::max(speed, std::abs(value));
  }
};

CellNumbers numbers_of_run(const RunResult& result, const PeaksOfARun& peaks) {
  const LoopReport& report = result.report;
  CellNumbers numbers{.table = "checks", .columns = {}, .values = {}};
  numbers.add("ticks", "1", static_cast<double>(report.ticks()));
  numbers.add("energy", "J", report.energy_j);
  numbers.add("least_energy", "J", report.least_energy_j);
  numbers.add("largest_force", "N", peaks.force);
  numbers.add("largest_speed", "m/s", peaks.speed);
  for (const schema::FlagInfo& flag : schema::flag_table)
    numbers.add(fmt::format("ticks_with_{}", flag.name), "1",
                static_cast<double>(report.ticks_with(flag.flag)));
  return numbers;
}

class CheckCells final : public CellWork {
 public:
  explicit CheckCells(std::filesystem::path folder) : folder_(std::move(folder)) {}

  CellNumbers compute(const SweepCell& cell) override {
    if (cell.text("law") != name_) {
      law_ = read_law_file((folder_ / cell.text("law")).string());
      name_ = cell.text("law");
    }
    RunOptions options;
    options.device_uri = simulated_device(cell);
    options.seconds = cell.number("seconds");
    options.rate_hz = cell.number("rate");
    options.virtual_time = true;
    options.law = law_;
    options.passivity_control = cell.text("controller") == "on";
    PeaksOfARun peaks;
    options.each_row = [&](const schema::Row& row) { peaks.see(row); };
    const std::atomic<bool> never{false};
    return numbers_of_run(run_on_device(options, never), peaks);
  }

 private:
  std::filesystem::path folder_;
  std::string name_;
  std::optional<LawFile> law_;
};

}  // namespace

const SweepVerb sweep_of_checks{
    .name = "check",
    .what =
        "runs a law in closed loop with a simulated device in virtual time, as 'kerf check --virtual' does",
    .inputs = inputs_of_checks,
    .begin = [](const SweepPlan& plan) -> std::unique_ptr<CellWork> {
      return std::make_unique<CheckCells>(plan.folder);
    }};

}  // namespace kerf::bench
