#include "regress/context.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "compare/finding_json.h"
#include "files/json_number.h"
#include "laws/placement.h"
#include "regress/renderers/step_cost.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

json difference_as_json(const RegressionOutcome& outcome, const ForceDifference& worst) {
  const schema::ForceChannel& channel = outcome.stored.channels[worst.channel];
  json result{{"tick", worst.tick},
              {"time_s", outcome.path.time_s[worst.tick]},
              {"channel", channel.name},
              {"unit", channel.unit},
              {"expected", json_number(worst.expected)},
              {"got", json_number(worst.got)},
              {"allowed", json_number(worst.allowed)},
              {"jnds", json_number(worst.jnds)},
              {"context", json::array()}};
  for (const ContextRow& row : context_of(outcome)) {
    result["context"].push_back({{"tick", row.tick},
                                 {"time_s", json_number(row.time_s)},
                                 {"position", json_number(row.position)},
                                 {"velocity", json_number(row.velocity)},
                                 {"expected", json_number(row.expected)},
                                 {"got", json_number(row.got)}});
  }
  return result;
}

json compute_time_as_json(const RegressionOutcome& outcome) {
  if (outcome.got.compute_time_s.empty()) return nullptr;
  const StepCost cost = step_cost(outcome.got.compute_time_s);
  return {{"of", outcome.got.compute_time_of},
          {"median_s", json_number(cost.median_s)},
          {"of_99_in_100_s", json_number(cost.near_all_s)},
          {"largest_s", json_number(cost.largest_s)},
          {"late", outcome.got.late}};
}

json case_as_json(const RegressionOutcome& outcome) {
  json channels = json::array();
  for (const ChannelComparison& one : outcome.comparison.channels) {
    channels.push_back({{"name", one.channel.name},
                        {"unit", one.channel.unit},
                        {"outside", one.outside},
                        {"largest_difference", json_number(one.largest_difference)},
                        {"largest_tick", one.largest_at},
                        {"largest_jnds", json_number(one.largest_jnds)},
                        {"largest_expected", json_number(one.largest_expected)}});
  }
  std::vector<compare::Channel> named;
  for (const schema::ForceChannel& one : outcome.stored.channels)
    named.push_back({.name = one.name, .unit = one.unit});
  return {{"name", outcome.about.name},
          {"model", outcome.about.error.empty() ? json(renderer_of(outcome.about)) : json(nullptr)},
          {"passed", outcome.left_out ? json(nullptr) : json(outcome.passed())},
          {"left_out", outcome.left_out},
          {"error", outcome.error.empty() ? json(nullptr) : json(outcome.error)},
          {"said", outcome.said.empty() ? json(nullptr) : json(outcome.said)},
          {"messages", outcome.messages},
          {"explained", outcome.diagnosis.explained},
          {"names", findings_as_json(outcome.diagnosis.names, named)},
          {"guesses", findings_as_json(outcome.diagnosis.guesses, named)},
          {"why", outcome.why},
          {"note", outcome.note},
          {"samples", outcome.comparison.got_rows},
          {"stored_samples", outcome.comparison.expected_rows},
          {"differing", outcome.comparison.differing},
          {"outside", outcome.comparison.outside},
          {"channels", channels},
          {"worst",
           outcome.comparison.worst ? difference_as_json(outcome, *outcome.comparison.worst) : json(nullptr)},
          {"tick_cost", json_number(outcome.tick_cost)},
          {"stored_tick_cost", json_number(outcome.stored.tick_cost)},
          {"compute_time", compute_time_as_json(outcome)},
          {"made_with", outcome.made_with.empty() ? json(nullptr) : json(outcome.made_with)},
          {"seconds", outcome.seconds}};
}

std::string cell(double value) { return std::isnan(value) ? "-" : fmt::format("{:.9g}", value); }

}  // namespace

std::vector<ContextRow> context_of(const RegressionOutcome& outcome, std::size_t ticks) {
  std::vector<ContextRow> rows;
  if (!outcome.comparison.worst) return rows;
  const ForceDifference& worst = *outcome.comparison.worst;
  const std::size_t columns = outcome.stored.channels.size();
  const std::size_t end =
      std::min(worst.tick + ticks + 1, std::max(outcome.stored.rows(), outcome.got.rows()));
  for (std::size_t tick = worst.tick - std::min(worst.tick, ticks); tick < end; ++tick) {
    ContextRow row{.tick = tick};
    if (tick < outcome.path.ticks()) {
      row.time_s = outcome.path.time_s[tick];
      row.position = outcome.path.sample[tick].position[worst.channel];
      row.velocity = outcome.path.sample[tick].velocity[worst.channel];
    }
    if (tick < outcome.stored.rows()) row.expected = outcome.stored.force[tick * columns + worst.channel];
    const std::size_t got = tick + worst.got_tick - worst.tick;  // where samples are missing, not the same
    if (got < outcome.got.rows()) row.got = outcome.got.force[got * columns + worst.channel];
    rows.push_back(row);
  }
  return rows;
}

std::string context_table(const RegressionOutcome& outcome) {
  const auto rows = context_of(outcome);
  if (rows.empty()) return {};
  const ForceDifference& worst = *outcome.comparison.worst;
  const models::LawAxis axis = axes_of(outcome.about)[worst.channel];
  const auto line = [](const auto&... cells) {
    std::string text;
    ((text += fmt::format("{:>18}", cells)), ...);
    return text + '\n';
  };
  std::string table =
      fmt::format("  {:>6}", "tick") +
      line("time [s]", fmt::format("{} [{}]", axis.name, axis.position_unit),
           fmt::format("speed [{}/s]", axis.position_unit), fmt::format("expected [{}]", axis.force_unit),
           fmt::format("got [{}]", axis.force_unit), fmt::format("apart [{}]", axis.force_unit));
  for (const ContextRow& row : rows) {
    table += fmt::format("{} {:>6}", row.tick == worst.tick ? ">" : " ", row.tick) +
             line(cell(row.time_s), cell(row.position), cell(row.velocity), cell(row.expected), cell(row.got),
                  cell(row.got - row.expected));
  }
  return table;
}

json outcome_as_json(const Suite& suite, const SuiteOutcome& outcome) {
  json result{{"suite", suite.file.string()},    {"name", suite.name},
              {"stored", suite.stored.string()}, {"passed", outcome.failed() == 0},
              {"failed", outcome.failed()},      {"errors", outcome.errors()},
              {"dropped", outcome.dropped},      {"notes", outcome.notes},
              {"seconds", outcome.seconds},      {"cases", json::array()}};
  for (const RegressionOutcome& one : outcome.cases) result["cases"].push_back(case_as_json(one));
  return result;
}

}  // namespace kerf::bench
