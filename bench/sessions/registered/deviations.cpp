#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

#include "registered/assignment.h"
#include "registered/experiment_report.h"

namespace kerf::bench {
namespace {

std::string number_text(const std::optional<double>& value) {
  return value ? fmt::format("{:g}", *value) : std::string("none");
}

std::string number_text(const std::optional<psychophysics::Interval>& value) {
  return value ? fmt::format("{:g} to {:g}", value->lower, value->upper) : std::string("none");
}

std::string stopping_text(const StoppingRule& rule) {
  std::string text(name_of(rule.kind));
  if (rule.kind == StoppingKind::alpha_spending) text += fmt::format(" ({})", name_of(rule.spending));
  if (rule.kind == StoppingKind::bayes_factor) text += fmt::format(" ({:g})", rule.evidence);
  if (!rule.looks.empty()) text += fmt::format(" at {}", fmt::join(rule.looks, ", "));
  return text;
}

std::string exclusions_text(const ExclusionPlan& plan) {
  const std::string catches =
      plan.catch_right ? fmt::format("catch_right {}, ", number_text(plan.catch_right)) : std::string();
  return fmt::format("faulty {}, unfelt {}, {}rules [{}]", number_text(plan.faulty), number_text(plan.unfelt),
                     catches, fmt::join(plan.rules, "; "));
}

class Deviations {
 public:
  void differ(std::string_view what, const std::string& registered, const std::string& now,
              std::string_view where) {
    if (registered != now) add("{} is {} {}, and {} was registered", what, now, where, registered);
  }

  template <typename... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    all_.push_back(fmt::format(format, std::forward<Arguments>(arguments)...));
  }

  void compare(const AnalysisPlan& registered, const AnalysisPlan& now, std::string_view where) {
    differ("the primary test", std::string(name_of(registered.test)), std::string(name_of(now.test)), where);
    differ("alpha", number_text(registered.alpha), number_text(now.alpha), where);
    differ("the margin", number_text(registered.margin), number_text(now.margin), where);
    differ("the bound of d'", number_text(registered.d_prime), number_text(now.d_prime), where);
    differ("the margin of the JND", number_text(registered.jnd_margins), number_text(now.jnd_margins), where);
    differ("the rule of exclusion", exclusions_text(registered.exclude), exclusions_text(now.exclude), where);
    differ("the stopping rule", stopping_text(registered.stopping), stopping_text(now.stopping), where);
  }

  void compare(const Experiment& registered, const AnalysisAsMade& made) {
    if (made.experiment_toml.empty()) {
      add("{} is missing; the plan is the one that the log registered", made.experiment_name);
      return;
    }
    if (made.experiment_toml == registered.toml) return;
    const std::string where = "in " + made.experiment_name;
    try {
      const Experiment now = parse_experiment(made.experiment_toml, made.experiment_name);
      const std::size_t before = all_.size();
      const ParticipantPlan& was = registered.participants;
      const ParticipantPlan& is = now.participants;
      differ("the number of participants", std::to_string(was.target), std::to_string(is.target), where);
      differ("the number of visits", std::to_string(was.visits), std::to_string(is.visits), where);
      differ("the list of groups", fmt::format("[{}]", fmt::join(was.groups, ", ")),
             fmt::format("[{}]", fmt::join(is.groups, ", ")), where);
      differ("the rule of replacement", std::string(name_of(was.replace)), std::string(name_of(is.replace)),
             where);
      differ("the protocol", registered.protocol, now.protocol, where);
      compare(registered.analysis, now.analysis, where);
      if (all_.size() == before)
        add("{} was edited since it was registered, in words that change no rule", made.experiment_name);
    } catch (const std::invalid_argument& error) {
      add("{} was changed since it was registered, and is no plan now: {}", made.experiment_name,
          error.what());
    }
  }

  /// Sessions hold protocol and laws as they were registered; what stands beside them may be another.
  void compare(const ExperimentLog::Facts& registered, const std::string& protocol_file) {
    std::error_code ignored;
    if (protocol_file.empty() || !std::filesystem::exists(protocol_file, ignored)) return;
    try {
      const auto now = registered_facts({}, read_protocol(protocol_file));
      if (now["protocol"] != registered.at("protocol"))
        add("{} was changed since it was registered; the sessions hold the registered one", protocol_file);
      for (const auto& [name, digest] : registered.at("laws").items()) {
        if (now["laws"].contains(name) && now["laws"][name] != digest)
          add("the law {} was changed since it was registered; the sessions hold the registered one", name);
      }
    } catch (const std::exception& error) {
      add("the protocol was changed since it was registered, and does not open now: {}", error.what());
    }
  }

  void participants(const ExperimentState& state) {
    const ExclusionPlan& plan = state.experiment.analysis.exclude;
    const auto is_registered = [&](const std::string& rule) {
      return (rule == "faulty" && plan.faulty) || (rule == "unfelt" && plan.unfelt) ||
             (rule == "catch_right" && plan.catch_right) || std::ranges::count(plan.rules, rule) > 0;
    };
    for (const Participant& each : state.participants) {
      if (each.excluded && !is_registered(each.rule))
        add("{} was excluded by no registered rule: {}", each.code, each.reason);
      if (each.excluded && each.after_look)
        add("{} was excluded after the answers had been looked at: {}", each.code, each.reason);
      for (const AssignedSession& session : each.sessions) {
        if (session.rehearsed && !each.is_out())
          add("{} of {} is a rehearsal, whose answers are by chance", session.file.filename().string(),
              each.code);
      }
    }
  }

  void looks(const ExperimentState& state, const Look& look) {
    for (std::size_t i = 0; i < state.looks.size(); ++i) {
      const PastLook& past = state.looks[i];
      if (past.paid || (!look.is_new && i + 1 == state.looks.size())) continue;
      add("look {} at {} participants was in no rule{}{}: false alarms are more than alpha says", i + 1,
          past.participants.size(), past.reason.empty() ? "" : ", for this reason: ", past.reason);
    }
    if (!look.is_paid)
      add("this look, at {} participants, is in no rule{}{}: it decides nothing", look.participants.size(),
          look.reason.empty() ? "" : ", for this reason: ", look.reason);
    if (look.is_paid && !look.is_planned)
      add("a look at {} participants was not planned; the stopping rule allows for it",
          look.participants.size());
    for (const std::string& opening : state.openings) add("{}", opening);
    const std::size_t target = state.experiment.participants.target;
    if (look.is_last && look.participants.size() != target)
      add("the number of analysed participants is {}, and {} was registered", look.participants.size(),
          target);
  }

  [[nodiscard]] std::vector<std::string> all() && { return std::move(all_); }

 private:
  std::vector<std::string> all_;
};

}  // namespace

std::vector<std::string> deviations_of(const ExperimentState& state, const Look& look,
                                       const AnalysisAsMade& made, const ExperimentLog::Facts& registered) {
  Deviations deviations;
  deviations.compare(state.experiment.analysis, made.plan, "in this analysis");
  deviations.compare(state.experiment, made);
  deviations.compare(registered, made.protocol_file);
  if (!made.tests_people)
    deviations.add("the primary test is of answers, not of people, since they are too few: {}",
                   made.main_test);
  deviations.participants(state);
  deviations.looks(state, look);
  return std::move(deviations).all();
}

}  // namespace kerf::bench
