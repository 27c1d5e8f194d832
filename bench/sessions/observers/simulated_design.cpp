#include "observers/simulated_design.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "observers/simulate.h"
#include "registered/experiment.h"

namespace kerf::bench {

Protocol protocol_to_simulate(const std::filesystem::path& file, SimulationOptions& options) {
  if (!is_experiment(file)) return read_protocol(file);
  const std::filesystem::path registered = experiment_file(file);
  const Experiment experiment = read_experiment(registered);
  if (options.subjects != 1 || options.analysis.margin || options.analysis.d_prime_bound)
    throw std::invalid_argument(
        "the experiment has the number of its participants and its margins: leave out --subjects, --margin "
        "and --equal-below");
  options.subjects = experiment.participants.target;
  options.visits = experiment.participants.visits;
  options.analysis.level = experiment.analysis.alpha;
  options.analysis.margin = experiment.analysis.margin;
  options.analysis.d_prime_bound = experiment.analysis.d_prime;
  options.analysis.jnd_margins = experiment.analysis.jnd_margins;
  options.catch_right = experiment.analysis.exclude.catch_right;
  options.experiment = experiment;
  return protocol_of(experiment, registered);
}

Protocol with_trials(Protocol protocol, std::size_t trials) {
  if (trials == 0) throw std::invalid_argument("a session needs a trial at least");
  protocol.trials = trials;
  protocol.scale.quest_trials = trials;
  protocol.scale.staircase.max_trials = static_cast<int>(trials);
  for (auto& other : protocol.scale.interleaved) other.max_trials = static_cast<int>(trials);
  return protocol;
}

std::size_t cells_of(const Protocol& protocol) {
  if (is_adaptive(protocol.design)) return 1;
  std::size_t cells = 0;
  for (std::size_t tissue = 0; tissue < protocol.tissues.size(); ++tissue)
    cells += pairs_of(protocol, tissue).size();
  if (protocol.design == Design::constant)
    cells *= static_cast<std::size_t>(
        std::ranges::count_if(protocol.scale.levels, [](double level) { return level != 0.0; }));
  return cells;
}

std::string counted_on_curve(Design design) {
  if (design == Design::staircase) return "reversals of each subject (of the first staircase)";
  if (design == Design::constant) return "trials of each level and subject";
  if (design == Design::quest_plus) return "trials of each subject";
  if (asks_numbers(design)) return "trials of each sample or level and subject";
  return "trials of each pair and subject";
}

Protocol resized(const Protocol& protocol, std::size_t size) {
  if (protocol.design != Design::staircase) return with_trials(protocol, size);
  const auto reversals = static_cast<std::size_t>(protocol.scale.staircase.reversals);
  Protocol larger =
      with_trials(protocol, std::max(protocol.trials, (protocol.trials * size + reversals - 1) / reversals));
  larger.scale.staircase.reversals = static_cast<int>(size);
  for (auto& other : larger.scale.interleaved) {
    const auto own = static_cast<std::size_t>(other.reversals) * size / reversals;
    other.reversals = std::max(other.dropped + 2, static_cast<int>(own));
  }
  return larger;
}

std::size_t size_of(const Protocol& protocol) {
  return protocol.design == Design::staircase ? static_cast<std::size_t>(protocol.scale.staircase.reversals)
                                              : protocol.trials;
}

double session_seconds(const Protocol& protocol, double trials, double answer_s) {
  const auto slots = static_cast<double>(slots_of(protocol));
  const double trial_s = slots * protocol.interval_s + (slots - 1.0) * protocol.gap_s + answer_s;
  const auto practice = static_cast<double>(protocol.practice);
  double breaks = 0.0;
  if (protocol.break_every > 0)
    breaks = std::max(0.0, std::ceil(trials / static_cast<double>(protocol.break_every)) - 1.0);
  const double catches =
      protocol.catches.every > 0 ? std::floor(trials / static_cast<double>(protocol.catches.every)) : 0.0;
  return (trials + catches + practice) * trial_s + breaks * protocol.break_s;
}

}  // namespace kerf::bench
