#include "registered/looks.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace kerf::bench {
namespace {

bool has_reason(const std::string& reason) {
  return reason.find_first_not_of(" \t\r\n") != std::string::npos;
}

[[noreturn]] void refuse_early(const ExperimentState& state, std::size_t through) {
  throw std::invalid_argument(
      fmt::format("{} of {} participants are through, and the registered rule \"fixed\" has no look before "
                  "the end; say why "
                  "with --reason to look all the same, and the study's log and every analysis will say so",
                  through, state.experiment.participants.target));
}

/// Numbers of participants of the looks that were paid for, each with more than the one before.
std::vector<std::size_t> paid_before(const ExperimentState& state) {
  std::vector<std::size_t> numbers;
  for (const PastLook& look : state.looks) {
    if (look.paid && (numbers.empty() || look.participants.size() > numbers.back()))
      numbers.push_back(look.participants.size());
  }
  return numbers;
}

}  // namespace

std::vector<LookLevel> look_levels(const Experiment& experiment, const std::vector<std::size_t>& participants,
                                   bool two_sided) {
  const AnalysisPlan& plan = experiment.analysis;
  if (plan.stopping.kind != StoppingKind::alpha_spending)
    return std::vector<LookLevel>(participants.size(), {.spent = plan.alpha, .nominal = plan.alpha});
  std::vector<double> information;
  for (const std::size_t number : participants) information.push_back(static_cast<double>(number));
  std::vector<LookLevel> levels;
  for (const auto& bound : psychophysics::spending_bounds(
           {.function = plan.stopping.spending, .alpha = plan.alpha, .two_sided = two_sided}, information,
           static_cast<double>(experiment.participants.target)))
    levels.push_back({.spent = bound.spent, .nominal = bound.nominal});
  return levels;
}

Look look_at(const ExperimentState& state, const LookRequest& request) {
  const Experiment& experiment = state.experiment;
  const StoppingKind kind = experiment.analysis.stopping.kind;
  const std::size_t through = request.participants.size();
  if (through == 0) throw std::invalid_argument("no participant is through: there is nothing to look at");
  Look look{.is_last = state.is_over(), .participants = request.participants, .reason = request.reason};
  ExperimentState before = state;
  look.is_new = state.looks.empty() || state.looks.back().participants != request.participants;
  if (!look.is_new) {
    look.reason = before.looks.back().reason;
    before.looks.pop_back();
  }
  look.number = before.looks.size() + 1;
  const auto planned = experiment.planned_looks();
  look.is_planned = look.is_last || (kind != StoppingKind::fixed && std::ranges::count(planned, through) > 0);
  if (kind == StoppingKind::fixed) {
    if (!look.is_last && look.is_new && !has_reason(request.reason)) refuse_early(state, through);
    look.is_paid = look.is_last;
  }
  std::vector<std::size_t> numbers = paid_before(before);
  if (kind == StoppingKind::alpha_spending && !numbers.empty() && through <= numbers.back())
    look.is_paid = false;
  if (!look.is_paid) {
    // What was spent stays spent, and nothing decides.
    look.spent = numbers.empty() || kind == StoppingKind::fixed
                     ? 0.0
                     : look_levels(experiment, numbers, request.two_sided).back().spent;
    return look;
  }
  numbers.push_back(through);
  const LookLevel level =
      kind == StoppingKind::alpha_spending
          ? look_levels(experiment, numbers, request.two_sided).back()
          : LookLevel{.spent = experiment.analysis.alpha, .nominal = experiment.analysis.alpha};
  look.spent = level.spent;
  look.nominal = level.nominal;
  return look;
}

ExperimentLog::Facts facts_of(const Look& look) {
  ExperimentLog::Facts facts{{"look", look.number},    {"participants", look.participants},
                             {"last", look.is_last},   {"planned", look.is_planned},
                             {"paid", look.is_paid},   {"alpha_spent", look.spent},
                             {"nominal", look.nominal}};
  if (!look.reason.empty()) facts["reason"] = look.reason;
  return facts;
}

}  // namespace kerf::bench
