#include <cmath>

#include <fmt/core.h>
#include <fmt/format.h>

#include "observers/simulation_report.h"

namespace kerf::bench {
namespace {

std::string percent(double share) { return fmt::format("{:.3g} %", 100.0 * share); }

/// "83.2 % (80.7 to 85.5 %)"
std::string with_interval(const SimulatedShare& share) {
  const auto interval = share.interval();
  return fmt::format("{:.1f} % ({:.1f} to {:.1f} %)", 100.0 * share.value(), 100.0 * interval.lower,
                     100.0 * interval.upper);
}

/// "0.832 (0.807 to 0.855)"
std::string as_power(const SimulatedShare& share) {
  const auto interval = share.interval();
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", share.value(), interval.lower, interval.upper);
}

std::string felt_line(const Simulation& simulation) {
  std::string line = simulation.device_uri.empty()
                         ? std::string("Felt along the protocol's motion, without a device's limits:")
                         : fmt::format("Felt on {}, in closed loop:", simulation.device_uri);
  for (const FeltSample& sample : simulation.samples) {
    line += fmt::format(" {} {:.3g} N", sample.name, sample.rms_n);
    if (sample.limited_share > 0.0) line += fmt::format(" (at a limit in {})", percent(sample.limited_share));
    line += &sample == &simulation.samples.back() ? " rms." : ",";
  }
  if (simulation.truth.is_of_levels)
    line += fmt::format(" Renderings of the levels scatter by {:.2f} JND about a smooth curve.",
                        simulation.scatter);
  return line;
}

std::string observer_line(const SimulationOptions& options) {
  const Observer& observer = options.observer;
  std::string line = fmt::format(
      "Observers with a JND of {} of the force ({} right in two intervals) but at least {:g} N, "
      "who lapse in {}",
      percent(observer.jnd), percent(observer.criterion), observer.least_jnd_n, percent(observer.lapse));
  if (observer.bias != 0.0) line += fmt::format(", response bias to the first slot d' = {:g}", observer.bias);
  if (observer.preference != 0.0)
    line += fmt::format(", like the second of a pair better by d' = {:g}", observer.preference);
  if (observer.spread > 0.0)
    line += fmt::format(", and differ by {} from each other", percent(observer.spread));
  if (observer.preference_spread > 0.0)
    line += fmt::format(", whose tastes differ by d' = {:g}", observer.preference_spread);
  if (observer.share_inattentive > 0.0)
    line += fmt::format(", and of whom {} do not attend: {} of their answers come by chance",
                        percent(observer.share_inattentive), percent(observer.inattention));
  if (observer.slip > 0.0) line += fmt::format(", who take {} of the trials back", percent(observer.slip));
  if (observer.unexplored > 0.0)
    line += fmt::format(", who explore {} of the trials too little", percent(observer.unexplored));
  if (observer.share_feeling < 1.0)
    line += fmt::format(", and of whom {} feel any difference", percent(observer.share_feeling));
  return line + ".";
}

std::string number_observer_line(const Simulation& simulation) {
  const Observer& observer = simulation.options.observer;
  if (simulation.design == Design::rating)
    return fmt::format(
        "Observers with a JND of {}, who rate what they feel with a noise of one d' on a scale of 3 d' "
        "either way, "
        "lapse in {}, and differ by {:g} d' in where they rate and {:g} d' in what they like.",
        percent(observer.jnd), percent(observer.lapse), observer.modulus_spread, observer.preference_spread);
  return fmt::format(
      "Observers whose numbers grow with the exponent {:g} (+- {:g} between them) of what they feel, with a "
      "noise "
      "of {}, lapse in {}, and choose the size of their numbers within a factor of {:.3g}.",
      observer.exponent, observer.exponent_spread, percent(observer.number_noise), percent(observer.lapse),
      std::exp(observer.modulus_spread));
}

void add_exponent(const Simulation& simulation, std::vector<std::string>& lines) {
  const SimulatedShare& covered = simulation.found.exponent_covered;
  if (covered.count.trials == 0) return;
  lines.push_back(
      fmt::format("Intervals of {} covered the exponent of {:g} in {}; mean of the estimates {:.3f}.",
                  percent(simulation.options.analysis.confidence), simulation.truth.exponent,
                  with_interval(covered), simulation.found.exponent_mean));
}

/// Who finds nothing.
const char* who_feel_nothing(const Simulation& simulation) {
  if (simulation.design == Design::magnitude && simulation.example &&
      !simulation.example->judgements.empty() && !std::isnan(simulation.example->judgements.front().level))
    return "whose exponent is 1";
  if (asks_numbers(simulation.design)) return "who tell no sample from another";
  return simulation.design == Design::preference && simulation.options.observer.preference_spread > 0.0
             ? "who on the average prefer none"
             : "who feel no difference";
}

void add_cells(const Simulation& simulation, std::vector<std::string>& lines) {
  if (simulation.truth.is_of_levels) return;
  for (const CellTruth& cell : simulation.truth.cells)
    lines.push_back(fmt::format("  {:32} {:5.2f} JND apart, d' = {:.2f}: {:.1f} % {}", cell.name, cell.jnds,
                                cell.d_prime, 100.0 * cell.share,
                                simulation.design == Design::preference ? "for the first" : "right"));
}

/// The binomial test, whose power is known, asks nothing of people.
const char* were_independent(const Simulation& simulation) {
  return simulation.options.subjects > 1 ? ", were the answers of a subject independent" : "";
}

void add_power(const Simulation& simulation, std::vector<std::string>& lines) {
  const SimulatedFindings& found = simulation.found;
  if (found.significant.count.trials == 0) {
    lines.emplace_back("No power: this design has no main test, for the levels follow the answers.");
  } else {
    std::string line = fmt::format("Power {} over {} experiments of {:.0f} answers",
                                   as_power(found.significant), found.significant.count.trials, found.trials);
    if (std::isfinite(simulation.theory))
      line += fmt::format("; {:.2f} by the exact probability of {:.1f} %{}", simulation.theory,
                          100.0 * simulation.truth.share, were_independent(simulation));
    lines.push_back(line + ".");
  }
  if (simulation.false_alarms.count.trials > 0)
    lines.push_back(fmt::format("False alarms {} with observers {}, at a level of {}.",
                                with_interval(simulation.false_alarms), who_feel_nothing(simulation),
                                percent(simulation.options.analysis.level)));
  if (found.equivalent.count.trials > 0)
    lines.push_back(fmt::format("Called equivalent in {}.", with_interval(found.equivalent)));
}

void add_catches(const Simulation& simulation, std::vector<std::string>& lines) {
  if (!simulation.catches) return;
  const SimulatedCatches& catches = *simulation.catches;
  lines.push_back(fmt::format(
      "Of {:.1f} catch trials a subject {} are right where people attend, {} where {} of the answers come by "
      "chance; less than {} right are {} of those who attend and {} of the others{}.",
      catches.trials, percent(catches.attentive_right), percent(catches.inattentive_right),
      percent(simulation.options.observer.inattention), percent(catches.least_share),
      with_interval(catches.attentive_out), with_interval(catches.inattentive_out),
      simulation.options.catch_right ? ", who are not analysed" : ""));
}

void add_looks(const Simulation& simulation, std::vector<std::string>& lines) {
  if (!simulation.looks) return;
  const SimulatedLooks& looks = *simulation.looks;
  const Experiment& experiment = *simulation.options.experiment;
  const bool by_evidence = experiment.analysis.stopping.kind == StoppingKind::bayes_factor;
  const auto tell = [&](const char* whom, const LookedAt& found) {
    std::string line =
        fmt::format("With looks, {}: {} is shown in {}", whom,
                    experiment.analysis.test == PrimaryTest::difference ? "a difference" : "an equivalence",
                    with_interval(found.shown));
    if (by_evidence) line += fmt::format(", that there is none in {}", with_interval(found.none));
    lines.push_back(line + fmt::format("; {:.1f} participants on the average.", found.participants));
  };
  tell("these observers", looks.found);
  tell("observers who feel no difference", looks.nothing);
  for (std::size_t i = 0; i < looks.looks.size(); ++i) {
    const Look& look = looks.looks[i];
    const std::string level = by_evidence ? std::string() : fmt::format(", p <= {:.2g}", look.nominal);
    lines.push_back(
        fmt::format("  look {} at {} participants{}: {:.1f} % of the studies end there, {:.1f} % of those "
                    "with nothing to find",
                    look.number, look.participants.size(), level, 100.0 * looks.found.ended[i].value(),
                    100.0 * looks.nothing.ended[i].value()));
  }
}

void add_jnd(const Simulation& simulation, std::vector<std::string>& lines) {
  const SimulatedTruth& truth = simulation.truth;
  const SimulatedFindings& found = simulation.found;
  if (!truth.is_of_levels) return;
  if (!std::isfinite(truth.jnd)) {
    lines.push_back(fmt::format("No true JND: {}.", truth.note));
  } else {
    lines.push_back(fmt::format(
        "Intervals of {} covered the true JND of {:.4f} in {} of the {} experiments that told one.",
        percent(simulation.options.analysis.confidence), truth.jnd, with_interval(found.jnd_covered),
        found.jnd_covered.count.trials));
    lines.push_back(fmt::format(
        "The JND came out {:.1f} % too {} on the average (geometric mean), with a scatter of {:.0f} %; the "
        "median interval ends at {:.2f} times its beginning.",
        100.0 * std::abs(found.jnd_bias), found.jnd_bias < 0.0 ? "small" : "large", 100.0 * found.jnd_spread,
        found.jnd_ratio));
  }
  const int none = found.jnd_found.count.trials - found.jnd_found.count.successes;
  const int open = found.jnd_bounded.count.trials - found.jnd_bounded.count.successes;
  if (none > 0 || open > 0)
    lines.push_back(fmt::format("{} of the experiments told no JND, {} an interval that is open at one end.",
                                none, open));
  for (const std::string& note : found.notes) lines.push_back("  " + note);
}

void add_d_prime(const Simulation& simulation, std::vector<std::string>& lines) {
  const SimulatedShare& covered = simulation.found.d_prime_covered;
  if (covered.count.trials == 0) return;
  lines.push_back(fmt::format(
      "Intervals of {} covered the d' of {:.2f}, which belongs to {:.1f} % right, in {}; median {:.2f}.",
      percent(simulation.options.analysis.confidence), simulation.truth.d_prime,
      100.0 * simulation.truth.share, with_interval(covered), simulation.found.d_prime_median));
}

void add_needed(const Simulation& simulation, std::vector<std::string>& lines) {
  if (simulation.needed_total == 0) {
    if (std::isfinite(simulation.truth.share))
      lines.push_back(
          fmt::format("No number of trials up to 100,000 gives a power of {:g}.", simulation.options.power));
    return;
  }
  std::string line =
      fmt::format("For a power of {:g} it takes {} answers by theory{}", simulation.options.power,
                  simulation.needed_total, were_independent(simulation));
  if (simulation.confirmed)
    line += fmt::format(", {} {}; simulated {}", simulation.confirmed->trials, simulation.curve_of,
                        as_power(simulation.confirmed->found.significant));
  lines.push_back(line + ".");
}

}  // namespace

std::vector<std::string> simulation_lines(const Simulation& simulation) {
  std::vector<std::string> lines{
      fmt::format("{}: {}, {} experiments of {} subject{}", simulation.name, name_of(simulation.design),
                  simulation.options.experiments, simulation.options.subjects,
                  simulation.options.subjects == 1 ? "" : "s"),
      asks_numbers(simulation.design) ? number_observer_line(simulation) : observer_line(simulation.options),
      felt_line(simulation)};
  add_cells(simulation, lines);
  add_power(simulation, lines);
  add_catches(simulation, lines);
  add_looks(simulation, lines);
  add_jnd(simulation, lines);
  add_d_prime(simulation, lines);
  add_exponent(simulation, lines);
  add_needed(simulation, lines);
  if (const auto& voided = simulation.voided)
    lines.push_back(
        fmt::format("A session has {:.2f} trials on the average, practice included, and {:.2f} of them are "
                    "void (taken back {:.2f}, "
                    "not explored {:.2f}): {:.2f} come again, {:.3f} are lost.",
                    voided->given, voided->slipped + voided->unexplored, voided->slipped, voided->unexplored,
                    voided->again, voided->lost));
  lines.push_back(
      fmt::format("A subject is busy for {:.0f} min, if each slot is felt once and an answer takes "
                  "{:g} s.",
                  std::ceil(simulation.mean_session_s / 60.0), simulation.options.answer_s));
  return lines;
}

}  // namespace kerf::bench
