#include <atomic>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include <kerf/drivers/device.h>

#include "identify/identified_device.h"
#include "verbs/simulated_device.h"
#include "verbs/sweep_verb.h"

namespace kerf::bench {
namespace {

std::vector<SweepInput> inputs_of_identify() {
  using enum SweepInput::Kind;
  const ExperimentOptions usual;
  std::vector<SweepInput> inputs = simulated_device_inputs();
  inputs.insert(
      inputs.end(),
      {{.name = "axis", .kind = text, .what = "Axis; the first where none is named", .standard = ""},
       {.name = "held", .kind = text, .what = "In a hand", .among = {"free", "held"}, .standard = "free"},
       {.name = "force",
        .what = "Largest force; 0: a tenth of the axis' limit",
        .unit = "N",
        .lower = 0,
        .standard = usual.force_n},
       {.name = "travel",
        .what = "Largest way from its place",
        .unit = "m",
        .lower = 1e-6,
        .standard = usual.travel_m},
       {.name = "seconds",
        .what = "How long it is moved",
        .unit = "s",
        .lower = 5,
        .upper = 600,
        .standard = usual.seconds},
       {.name = "period",
        .what = "Period of the excitation",
        .unit = "s",
        .lower = 0.2,
        .upper = 4,
        .standard = usual.period_s},
       {.name = "seed", .kind = whole, .what = "Seed of the excitation", .lower = 0, .standard = 1.0}});
  return inputs;
}

void add_value(CellNumbers& numbers, const std::string& name, const std::string& unit,
               const std::optional<identification::Value>& value) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  numbers.add(name, unit, value ? value->value : unknown);
  numbers.add(name + "_lower", unit, value ? value->lower : unknown);
  numbers.add(name + "_upper", unit, value ? value->upper : unknown);
}

CellNumbers numbers_of_axis(const identification::Identified& found) {
  CellNumbers numbers{.table = "axes", .columns = {}, .values = {}};
  numbers.add("fits", "1",
              found.fits ? static_cast<double>(*found.fits) : std::numeric_limits<double>::quiet_NaN());
  numbers.add("validation_error", "1", found.validation_error);
  add_value(numbers, "mass_found", "kg", found.mass_kg);
  add_value(numbers, "viscous_found", "N·s/m", found.viscous_n_s_per_m);
  add_value(numbers, "coulomb_found", "N", found.coulomb_n);
  add_value(numbers, "delay_found", "s", found.delay_s);
  add_value(numbers, "jitter_found", "s", found.jitter_s);
  numbers.add("encoder_step_found", "m",
              found.encoder_step_m.value_or(std::numeric_limits<double>::quiet_NaN()));
  return numbers;
}

class IdentifyCells final : public CellWork {
 public:
  CellNumbers compute(const SweepCell& cell) override {
    ExperimentOptions options;
    options.device_uri = simulated_device(cell);
    options.held = cell.text("held") == "held";
    options.force_n = cell.number("force");
    options.travel_m = cell.number("travel");
    options.seconds = cell.number("seconds");
    options.period_s = cell.number("period");
    options.seed = static_cast<std::uint64_t>(cell.number("seed"));
    options.virtual_time = true;
    options.warn = [](std::string_view) {};
    const std::atomic<bool> never{false};
    const std::size_t axis = axis_called(options.device_uri, cell.text("axis"));
    const IdentifiedAxis identified = identified_axis(excite_axis(options, axis, {}, never), axis);
    if (!identified.found) throw std::invalid_argument(identified.problem);
    return numbers_of_axis(*identified.found);
  }

 private:
  static std::size_t axis_called(const std::string& uri, const std::string& name) {
    const drivers::DeviceInfo device = drivers::open_device(uri, {})->info();
    for (std::size_t axis = 0; axis < device.axes.size(); ++axis)
      if (name.empty() || device.axes[axis].name == name) return axis;
    throw std::invalid_argument(fmt::format("{} has no axis '{}'", uri, name));
  }
};

}  // namespace

const SweepVerb sweep_of_identify{
    .name = "identify",
    .what = "identifies a simulated device, as 'kerf identify' does",
    .inputs = inputs_of_identify,
    .begin = [](const SweepPlan&) -> std::unique_ptr<CellWork> { return std::make_unique<IdentifyCells>(); }};

}  // namespace kerf::bench
