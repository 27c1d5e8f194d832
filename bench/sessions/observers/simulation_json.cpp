#include <fmt/core.h>

#include "files/json_number.h"
#include "observers/simulation_report.h"
#include "tables/csv.h"

namespace kerf::bench {
namespace {

using nlohmann::ordered_json;

/// JSON knows no infinity and no NaN: null.
ordered_json json_of(const SimulatedShare& share) {
  if (share.count.trials == 0) return nullptr;
  const auto interval = share.interval();
  return {{"share", share.value()},
          {"ci95", {interval.lower, interval.upper}},
          {"experiments", share.count.trials}};
}

ordered_json json_of(const SimulatedFindings& found) {
  return {{"power", json_of(found.significant)},
          {"equivalent", json_of(found.equivalent)},
          {"answers", found.trials},
          {"jnd_found", json_of(found.jnd_found)},
          {"jnd_bounded", json_of(found.jnd_bounded)},
          {"jnd_coverage", json_of(found.jnd_covered)},
          {"jnd_bias", json_number(found.jnd_bias)},
          {"jnd_spread", json_number(found.jnd_spread)},
          {"jnd_interval_ratio", json_number(found.jnd_ratio)},
          {"d_prime_coverage", json_of(found.d_prime_covered)},
          {"d_prime_median", json_number(found.d_prime_median)},
          {"exponent_coverage", json_of(found.exponent_covered)},
          {"exponent_mean", json_number(found.exponent_mean)},
          {"notes", found.notes}};
}

ordered_json json_of(const PowerPoint& point) {
  ordered_json json{{"trials", point.trials}, {"theory", json_number(point.theory)}};
  json.update(json_of(point.found));
  return json;
}

ordered_json json_of(const Observer& observer) {
  return {{"jnd", observer.jnd},
          {"least_jnd_N", observer.least_jnd_n},
          {"criterion", observer.criterion},
          {"lapse", observer.lapse},
          {"bias", observer.bias},
          {"preference", observer.preference},
          {"spread", observer.spread},
          {"preference_spread", observer.preference_spread},
          {"share_inattentive", observer.share_inattentive},
          {"inattention", observer.inattention},
          {"exponent", observer.exponent},
          {"exponent_spread", observer.exponent_spread},
          {"number_noise", observer.number_noise},
          {"modulus_spread", observer.modulus_spread},
          {"share_feeling", observer.share_feeling},
          {"slip", observer.slip},
          {"unexplored", observer.unexplored}};
}

ordered_json json_of(const SimulatedVoid& voided) {
  return {{"given", voided.given},
          {"slipped", voided.slipped},
          {"unexplored", voided.unexplored},
          {"again", voided.again},
          {"lost", voided.lost}};
}

ordered_json json_of(const SimulatedTruth& truth) {
  ordered_json cells = ordered_json::array();
  for (const CellTruth& cell : truth.cells)
    cells.push_back({{"name", cell.name},
                     {"level", json_number(cell.level)},
                     {"jnds", cell.jnds},
                     {"d_prime", cell.d_prime},
                     {"share", cell.share}});
  return {{"chance", truth.chance},
          {"share", json_number(truth.share)},
          {"d_prime", json_number(truth.d_prime)},
          {"criterion", truth.criterion},
          {"jnd", json_number(truth.jnd)},
          {"exponent", json_number(truth.exponent)},
          {"note", truth.note},
          {"cells", std::move(cells)}};
}

ordered_json json_of(const LookedAt& found) {
  ordered_json ended = ordered_json::array();
  for (const SimulatedShare& share : found.ended) ended.push_back(json_of(share));
  return {{"shown", json_of(found.shown)},
          {"none", json_of(found.none)},
          {"participants", found.participants},
          {"ended", std::move(ended)}};
}

ordered_json json_of(const SimulatedLooks& looks) {
  ordered_json at = ordered_json::array();
  for (const Look& look : looks.looks)
    at.push_back(
        {{"participants", look.participants.size()}, {"alpha_spent", look.spent}, {"nominal", look.nominal}});
  return {{"looks", std::move(at)}, {"found", json_of(looks.found)}, {"nothing", json_of(looks.nothing)}};
}

ordered_json json_of(const SimulatedCatches& catches) {
  return {{"catch_right", catches.least_share},
          {"trials", json_number(catches.trials)},
          {"attentive_right", json_number(catches.attentive_right)},
          {"inattentive_right", json_number(catches.inattentive_right)},
          {"attentive_excluded", json_of(catches.attentive_out)},
          {"inattentive_excluded", json_of(catches.inattentive_out)}};
}

}  // namespace

ordered_json simulation_json(const Simulation& simulation) {
  const SimulationOptions& options = simulation.options;
  ordered_json samples = ordered_json::array();
  for (const FeltSample& sample : simulation.samples)
    samples.push_back({{"name", sample.name},
                       {"rms_N", sample.rms_n},
                       {"peak_N", sample.peak_n},
                       {"limited_share", sample.limited_share}});
  ordered_json curve = ordered_json::array();
  for (const PowerPoint& point : simulation.curve) curve.push_back(json_of(point));
  ordered_json psychometric = ordered_json::array();
  for (const CellTruth& at : simulation.curve_truth)
    psychometric.push_back({{"level", at.level}, {"jnds", at.jnds}, {"share", at.share}});
  return {
      {"protocol", simulation.name},
      {"design", name_of(simulation.design)},
      {"experiments", options.experiments},
      {"subjects", options.subjects},
      {"seed", options.seed},
      {"observer", json_of(options.observer)},
      {"device", simulation.device_uri.empty() ? ordered_json(nullptr) : ordered_json(simulation.device_uri)},
      {"told_by", simulation.by_strength ? "strength" : "difference"},
      {"samples", std::move(samples)},
      {"truth", json_of(simulation.truth)},
      {"rendering_scatter_jnd", simulation.scatter},
      {"psychometric", std::move(psychometric)},
      {"level", options.analysis.level},
      {"found", json_of(simulation.found)},
      {"power_by_theory", json_number(simulation.theory)},
      {"false_alarms", json_of(simulation.false_alarms)},
      {"catch", simulation.catches ? json_of(*simulation.catches) : ordered_json(nullptr)},
      {"looks", simulation.looks ? json_of(*simulation.looks) : ordered_json(nullptr)},
      {"void_per_session", simulation.voided ? json_of(*simulation.voided) : ordered_json(nullptr)},
      {"session_s", simulation.mean_session_s},
      {"power_wanted", options.power},
      {"answers_needed",
       simulation.needed_total == 0 ? ordered_json(nullptr) : ordered_json(simulation.needed_total)},
      {"confirmed", simulation.confirmed ? json_of(*simulation.confirmed) : ordered_json(nullptr)},
      {"curve_of", simulation.curve_of},
      {"curve", std::move(curve)}};
}

std::string simulation_csv(const Simulation& simulation) {
  std::string csv =
      "trials,answers,experiments,power,power_lower,power_upper,power_by_theory,jnd_coverage,jnd_bias,"
      "jnd_spread,jnd_interval_ratio\n";
  const auto cell = [](double value) { return csv_number(value, 6); };
  for (const PowerPoint& point : simulation.curve) {
    const SimulatedShare& power = point.found.significant;
    const bool has_test = power.count.trials > 0;
    csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", point.trials, cell(point.found.trials),
                       simulation.curve_experiments, cell(power.value()),
                       has_test ? cell(power.interval().lower) : "",
                       has_test ? cell(power.interval().upper) : "", cell(point.theory),
                       cell(point.found.jnd_covered.value()), cell(point.found.jnd_bias),
                       cell(point.found.jnd_spread), cell(point.found.jnd_ratio));
  }
  return csv;
}

}  // namespace kerf::bench
