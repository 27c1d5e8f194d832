#include <atomic>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "choose/choose_on_device.h"
#include "fits/asked_fit.h"
#include "recordings/axes.h"
#include "recordings/whole_recording.h"
#include "verbs/parameter_columns.h"
#include "verbs/simulated_device.h"
#include "verbs/sweep_verb.h"
#include "verbs/swept_recording.h"

namespace kerf::bench {
namespace {

std::vector<SweepInput> inputs_of_choices() {
  using enum SweepInput::Kind;
  const ChooseOptions usual;
  std::vector<SweepInput> inputs = recording_inputs("to choose a law for");
  inputs.insert(inputs.end(),
                {{.name = "device",
                  .kind = text,
                  .what = "Simulated device that laws have to be stable on; none: held-out data alone",
                  .standard = ""},
                 {.name = "device_seed",
                  .kind = whole,
                  .what = "Seed of what the device draws; as its URI says where it is not given",
                  .lower = 0},
                 {.name = "grip",
                  .kind = text,
                  .what = "Hand that presses and holds there",
                  .among = {"light", "firm", "arm"},
                  .standard = "firm"},
                 {.name = "rate",
                  .what = "Rate of the loop",
                  .unit = "Hz",
                  .lower = AskedFit::rates_hz.lower,
                  .upper = AskedFit::rates_hz.upper,
                  .standard = usual.loop_rate_hz},
                 {.name = "most_segments",
                  .kind = whole,
                  .what = "Largest number of segments of the piecewise law",
                  .lower = 1,
                  .upper = 16,
                  .standard = static_cast<double>(usual.candidates.max_segments)},
                 {.name = "folds",
                  .kind = whole,
                  .what = "Folds, by cycle or by blocks of time",
                  .lower = AskedFit::most_folds.lower,
                  .upper = AskedFit::most_folds.upper,
                  .standard = static_cast<double>(usual.fit.folds)},
                 {.name = "weber",
                  .what = "Weber fraction of the JND; that of the axis where it is not given",
                  .lower = AskedFit::weber_fractions.lower,
                  .upper = AskedFit::weber_fractions.upper},
                 {.name = "threshold",
                  .what = "Smallest JND, in units of the force; that of the axis where it is not given",
                  .lower = 0}});
  for (SweepInput& input : noise_inputs()) inputs.push_back(std::move(input));
  return inputs;
}

double as_number(Stable stable) {
  if (stable == Stable::not_judged) return std::numeric_limits<double>::quiet_NaN();
  return stable == Stable::yes ? 1.0 : 0.0;
}

/// 1: it matters, 0: it does not; half: a richer law does without it; NaN: it is not known.
double as_number(Matter matter) {
  switch (matter) {
    case Matter::matters:
      return 1.0;
    case Matter::replaceable:
      return 0.5;
    case Matter::does_not:
      return 0.0;
    case Matter::not_known:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

CellNumbers numbers_of(const LawChoice& choice) {
  const std::string& unit = choice.force_unit;
  if (!choice.taken) throw std::invalid_argument(choice.why);
  const Candidate& taken = choice.candidates.at(*choice.taken);
  std::size_t within = 0;
  for (const Candidate& one : choice.candidates) within += one.within_jnd ? 1 : 0;
  CellNumbers numbers{.table = taken.law.name, .columns = {}, .values = {}};
  numbers.add("serves", "1", choice.serves ? 1.0 : 0.0);
  numbers.add("converged", "1", taken.converged ? 1.0 : 0.0);
  numbers.add("parameters", "1", static_cast<double>(taken.law.parameters));
  numbers.add("held_out", unit, taken.error_n);
  numbers.add("held_out_fitted", unit, taken.fitted_n);
  numbers.add("held_out_jnd", "1", taken.error_jnd);
  numbers.add("jnd", unit, choice.jnd_n);
  numbers.add("force_rms", unit, choice.force_rms_n);
  numbers.add("candidates", "1", static_cast<double>(choice.candidates.size()));
  numbers.add("within_jnd", "1", static_cast<double>(within));
  numbers.add("stable", "1", as_number(taken.stability.stable));
  numbers.add("simpler_with_controller", "1", choice.advice ? 1.0 : 0.0);
  for (const EffectVerdict& effect : choice.effects)
    numbers.add(fmt::format("matters_{}", name_of(effect.effect)), "1", as_number(effect.matter));
  if (taken.fit) add_parameters(numbers, *taken.fit);
  return numbers;
}

class ChooseCells final : public CellWork {
 public:
  explicit ChooseCells(const std::filesystem::path& folder)
      : folder_(folder), recording_(folder, read_whole_recording) {}

  CellNumbers compute(const SweepCell& cell) override {
    const schema::Recording& recording = recording_.of(cell);
    DeviceChoiceOptions options{.tried_by = TriedBy::data, .begins = {}};
    ChooseOptions& how = options.choose;
    how.axis = find_cut_axis(recording, cell.text("axis"));
    how.rows = {.rows = cell.text("rows") == "all" ? Counted::all : Counted::contact,
                .cycles = parse_cycle_choice(cell.text("cycles"))};
    how.loop_rate_hz = cell.number("rate");
    how.candidates.max_segments = static_cast<std::size_t>(cell.number("most_segments"));
    how.fit.folds = static_cast<std::size_t>(cell.number("folds"));
    how.time_ticks = false;
    AskedJnd jnd;
    if (cell.has("weber")) jnd.weber_fraction = cell.number("weber");
    if (cell.has("threshold")) jnd.threshold = cell.number("threshold");
    jnd.put_into(how.fit, recording.axes[how.axis]);
    if (!cell.text("device").empty()) {
      options.tried_by = TriedBy::virtual_time;
      options.loop.device_uri = simulated_device(cell);
      options.loop.rate_hz = how.loop_rate_hz;
      options.loop.grip = cell.text("grip");
    }
    const std::atomic<bool> never{false};
    return numbers_of(
        choose_on_device(recording, folder_ / cell.text("recording"), std::move(options), never).choice);
  }

 private:
  std::filesystem::path folder_;
  SweptRecording recording_;
};

}  // namespace

const SweepVerb sweep_of_choices{
    .name = "choose",
    .what = "chooses the simplest law that serves, as 'kerf choose' does without a clock",
    .inputs = inputs_of_choices,
    .begin = [](const SweepPlan& plan) -> std::unique_ptr<CellWork> {
      return std::make_unique<ChooseCells>(plan.folder);
    }};

}  // namespace kerf::bench
