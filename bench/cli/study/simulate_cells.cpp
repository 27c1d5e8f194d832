#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "felt/felt_gains.h"
#include "observers/simulate.h"
#include "observers/simulated_design.h"
#include "plan/planned_file.h"
#include "study/swept_verbs.h"

namespace kerf::bench {
namespace {

/// An input that is a number of the options as it is.
struct PlainInput {
  const char* name;
  const char* what;
  const char* unit;
  double lower;
  double upper;
  double& (*in)(SimulationOptions& options);
};

constexpr double no_limit = std::numeric_limits<double>::infinity();
constexpr double above_zero = std::numeric_limits<double>::min();

constexpr std::array<PlainInput, 15> plain_inputs{
    {{"least_jnd", "Smallest JND of force", "N", above_zero, no_limit,
      [](SimulationOptions& o) -> double& { return o.observer.least_jnd_n; }},
     {"lapse", "Share of answers by chance", "1", 0, 1,
      [](SimulationOptions& o) -> double& { return o.observer.lapse; }},
     {"slips", "Share of the trials that are taken back before the answer", "1", 0, 0.99,
      [](SimulationOptions& o) -> double& { return o.observer.slip; }},
     {"unexplored", "Share of the other trials that are not felt as the protocol asks", "1", 0, 0.99,
      [](SimulationOptions& o) -> double& { return o.observer.unexplored; }},
     {"bias", "Response bias to the first slot, in d'", "1", -no_limit, no_limit,
      [](SimulationOptions& o) -> double& { return o.observer.bias; }},
     {"spread", "Between subjects: standard deviation of ln(JND)", "1", 0, no_limit,
      [](SimulationOptions& o) -> double& { return o.observer.spread; }},
     {"preference_spread", "Between subjects: standard deviation of preference, in d'", "1", 0, no_limit,
      [](SimulationOptions& o) -> double& { return o.observer.preference_spread; }},
     {"exponent", "Of magnitudes: mean exponent of what is felt", "1", -10, 10,
      [](SimulationOptions& o) -> double& { return o.observer.exponent; }},
     {"exponent_spread", "Between subjects: standard deviation of the exponent", "1", 0, no_limit,
      [](SimulationOptions& o) -> double& { return o.observer.exponent_spread; }},
     {"number_noise", "Standard deviation of ln of a magnitude", "1", 0, no_limit,
      [](SimulationOptions& o) -> double& { return o.observer.number_noise; }},
     {"modulus_spread", "Between subjects: standard deviation of ln of the size of magnitudes", "1", 0,
      no_limit, [](SimulationOptions& o) -> double& { return o.observer.modulus_spread; }},
     {"share_feeling", "Share of the subjects who feel any difference", "1", 0, 1,
      [](SimulationOptions& o) -> double& { return o.observer.share_feeling; }},
     {"inattentive", "Share of the subjects who do not attend", "1", 0, 1,
      [](SimulationOptions& o) -> double& { return o.observer.share_inattentive; }},
     {"inattention", "Share of the answers of those that come by chance", "1", 0, 1,
      [](SimulationOptions& o) -> double& { return o.observer.inattention; }},
     {"preference", "How much better the second of a pair is liked, in d'", "1", -no_limit, no_limit,
      [](SimulationOptions& o) -> double& { return o.observer.preference; }}}};

/// What is not asked, or as the protocol has it, where it is not given.
void add_open_inputs(std::vector<SweepInput>& inputs) {
  inputs.insert(
      inputs.end(),
      {{.name = "catch_right",
        .what = "Who has less than this share of the catch trials right is left out",
        .lower = 0,
        .upper = 1},
       {.name = "margin",
        .what = "How often a preference is shown to lie within a half and this",
        .lower = 0.001,
        .upper = 0.5},
       {.name = "equal_below", .what = "How often d' is shown to lie below this", .lower = above_zero},
       {.name = "d_prime", .what = "Distance of all pairs of samples in d', whatever their laws render"},
       {.name = "trials",
        .kind = SweepInput::Kind::whole,
        .what = "Trials, in place of the protocol's",
        .lower = 1},
       {.name = "seconds",
        .what = "Duration of a rendering; 0: as the protocol's motion has it",
        .unit = "s",
        .lower = 0,
        .standard = 0.0}});
}

std::vector<SweepInput> inputs_of_simulations() {
  using enum SweepInput::Kind;
  SimulationOptions usual;
  std::vector<SweepInput> inputs{{.name = "protocol",
                                  .kind = SweepInput::Kind::file,
                                  .what = "Protocol of a session, NAME.protocol.toml, or an experiment",
                                  .required = true,
                                  .counts_with = files_named_in},
                                 {.name = "jnd",
                                  .what = "The observers' JND of force",
                                  .unit = "%",
                                  .lower = above_zero,
                                  .standard = 7.0},
                                 {.name = "jnd_criterion",
                                  .what = "Share of right answers in two intervals one JND apart",
                                  .unit = "%",
                                  .lower = 50,
                                  .upper = 100,
                                  .standard = 75.0}};
  for (const PlainInput& plain : plain_inputs)
    inputs.push_back({.name = plain.name,
                      .what = plain.what,
                      .unit = plain.unit,
                      .lower = plain.lower,
                      .upper = plain.upper,
                      .standard = plain.in(usual)});
  add_open_inputs(inputs);
  inputs.insert(
      inputs.end(),
      {{.name = "by",
        .kind = text,
        .what = "What renderings are told apart by",
        .among = {"asked", "strength", "difference"},
        .standard = "asked"},
       {.name = "strength",
        .kind = text,
        .what = "What of a force is its strength",
        .among = {"rms", "peak"},
        .standard = "rms"},
       {.name = "device",
        .kind = text,
        .what = "Simulated device that laws are felt on; none: the protocol's, or open: along its motion",
        .standard = ""},
       {.name = "renderings",
        .kind = whole,
        .what = "Renderings, each with other strokes of the hand",
        .lower = 1,
        .upper = 1000,
        .standard = static_cast<double>(usual.sensation.felt.renderings)},
       {.name = "subjects",
        .kind = whole,
        .what = "Subjects of each experiment",
        .lower = 1,
        .standard = 1.0},
       {.name = "experiments",
        .kind = whole,
        .what = "Simulated experiments",
        .lower = 2,
        .standard = static_cast<double>(usual.experiments)},
       {.name = "power",
        .what = "Power for which the number of trials is found",
        .lower = 0.001,
        .upper = 0.999,
        .standard = usual.power},
       {.name = "seed",
        .kind = whole,
        .what = "Seed of all that is drawn",
        .lower = 0,
        .standard = static_cast<double>(usual.seed)}});
  return inputs;
}

std::optional<double> where_given(const SweepCell& cell, std::string_view input) {
  return cell.has(input) ? std::optional(cell.number(input)) : std::nullopt;
}

FeltOptions felt_of(const SweepCell& cell) {
  FeltOptions felt;
  const std::string& device = cell.text("device");
  felt.open_loop = device == "open";
  if (!felt.open_loop && !device.empty() && !device.starts_with("sim:"))
    throw std::invalid_argument(
        fmt::format("'{}' is no simulated device, and a sweep moves no other", device));
  if (!felt.open_loop) felt.device_uri = device;
  felt.seconds = cell.number("seconds");
  felt.renderings = static_cast<std::size_t>(cell.number("renderings"));
  return felt;
}

SimulationOptions options_of(const SweepCell& cell) {
  SimulationOptions options;
  for (const PlainInput& plain : plain_inputs) plain.in(options) = cell.number(plain.name);
  options.observer.jnd = 0.01 * cell.number("jnd");
  options.observer.criterion = 0.01 * cell.number("jnd_criterion");
  options.catch_right = where_given(cell, "catch_right");
  options.analysis.margin = where_given(cell, "margin");
  options.analysis.d_prime_bound = where_given(cell, "equal_below");
  options.sensation.d_prime = where_given(cell, "d_prime");
  options.sensation.felt = felt_of(cell);
  if (cell.text("by") == "strength") options.sensation.by = ToldBy::strength;
  if (cell.text("by") == "difference") options.sensation.by = ToldBy::difference;
  if (cell.text("strength") == "peak") options.sensation.strength = Loudest::peak;
  options.subjects = static_cast<std::size_t>(cell.number("subjects"));
  options.experiments = static_cast<std::size_t>(cell.number("experiments"));
  options.power = cell.number("power");
  options.seed = static_cast<std::uint64_t>(cell.number("seed"));
  options.curve_points = 0;  // which a sweep over `trials` gives
  return options;
}

void add_share(CellNumbers& numbers, const std::string& name, const SimulatedShare& share) {
  const bool is_known = share.count.trials > 0;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  numbers.add(name, "1", is_known ? share.value() : unknown);
  numbers.add(name + "_lower", "1", is_known ? share.interval().lower : unknown);
  numbers.add(name + "_upper", "1", is_known ? share.interval().upper : unknown);
}

CellNumbers numbers_of(const Simulation& simulation) {
  const SimulatedFindings& found = simulation.found;
  CellNumbers numbers{.table = "designs", .columns = {}, .values = {}};
  add_share(numbers, "power_found", found.significant);
  numbers.add("power_by_theory", "1", simulation.theory);
  add_share(numbers, "false_alarms", simulation.false_alarms);
  add_share(numbers, "equivalent", found.equivalent);
  numbers.add("answers", "1", found.trials);
  numbers.add("answers_needed", "1",
              simulation.needed_total > 0 ? static_cast<double>(simulation.needed_total)
                                          : std::numeric_limits<double>::quiet_NaN());
  numbers.add("session", "s", simulation.mean_session_s);
  numbers.add("share_true", "1", simulation.truth.share);
  numbers.add("d_prime_true", "1", simulation.truth.d_prime);
  numbers.add("d_prime_median", "1", found.d_prime_median);
  add_share(numbers, "d_prime_covered", found.d_prime_covered);
  numbers.add("jnd_true", "1", simulation.truth.jnd);
  add_share(numbers, "jnd_found", found.jnd_found);
  add_share(numbers, "jnd_bounded", found.jnd_bounded);
  add_share(numbers, "jnd_covered", found.jnd_covered);
  numbers.add("jnd_bias", "1", found.jnd_bias);
  numbers.add("jnd_spread", "1", found.jnd_spread);
  numbers.add("jnd_interval_ratio", "1", found.jnd_ratio);
  numbers.add("exponent_true", "1", simulation.truth.exponent);
  numbers.add("exponent_mean", "1", found.exponent_mean);
  add_share(numbers, "exponent_covered", found.exponent_covered);
  if (simulation.looks) {
    add_share(numbers, "shown_at_looks", simulation.looks->found.shown);
    add_share(numbers, "shown_at_looks_of_nothing", simulation.looks->nothing.shown);
    numbers.add("participants", "1", simulation.looks->found.participants);
  }
  return numbers;
}

class SimulateCells final : public CellWork {
 public:
  explicit SimulateCells(std::filesystem::path folder) : folder_(std::move(folder)) {}

  CellNumbers compute(const SweepCell& cell) override {
    SimulationOptions options = options_of(cell);
    Protocol protocol = protocol_to_simulate(folder_ / cell.text("protocol"), options);
    if (cell.has("trials"))
      protocol = with_trials(std::move(protocol), static_cast<std::size_t>(cell.number("trials")));
    (void)find_gains(protocol, options.sensation.felt.device_uri);
    std::atomic<std::size_t> done{0};
    return numbers_of(simulate(protocol, options, done));
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace

const SweepVerb sweep_of_simulations{
    .name = "session simulate",
    .what = "simulates studies of a protocol, as 'kerf session simulate' does",
    .inputs = inputs_of_simulations,
    .begin = [](const SweepPlan& plan) -> std::unique_ptr<CellWork> {
      return std::make_unique<SimulateCells>(plan.folder);
    }};

}  // namespace kerf::bench
