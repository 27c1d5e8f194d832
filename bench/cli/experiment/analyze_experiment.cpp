#include "experiment/analyze_experiment.h"

#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "answers/look_decision.h"
#include "experiment/session_log.h"
#include "files/named_file.h"
#include "registered/participant_sessions.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

/// The registered plan, with what the command line has otherwise.
AnalysisPlan plan_as_made(const AnalysisPlan& registered, const ExperimentAnalysisArguments& arguments) {
  AnalysisPlan plan = registered;
  if (arguments.alpha) plan.alpha = *arguments.alpha;
  if (arguments.margin) plan.margin = arguments.margin;
  if (arguments.d_prime) plan.d_prime = arguments.d_prime;
  if (arguments.jnd_margins) plan.jnd_margins = arguments.jnd_margins;
  if (arguments.test == "difference") plan.test = PrimaryTest::difference;
  if (arguments.test == "equivalence") plan.test = PrimaryTest::equivalence;
  return plan;
}

class ExperimentAnalysis {
 public:
  ExperimentAnalysis(const ExperimentAnalysisArguments& arguments, KeyArguments& key, Context& context)
      : arguments_(arguments),
        key_(key),
        context_(context),
        opened_(open_experiment(arguments.experiment, key)),
        plan_(plan_as_made(opened_.state.experiment.analysis, arguments)) {}

  AnalysedExperiment run() {
    for (const std::string& found : opened_.state.problems) warn(found);
    require_may_look();
    open_sessions();
    const Study whole = open_.empty() ? Study() : study_of(sessions_of(open_));
    leave_out_excluded();
    const Look look = look_of(codes());
    if (look.is_new) opened_.log.append("look", facts_of(look));
    if (look.is_new) note_in_sessions(look);
    Study study = study_of(sessions_of(open_));
    Analysis analysis = analyse(study, options_at(plan_, look, arguments_.options));
    analysis.experiment = report_of(study, analysis, look);
    if (whole.judgements.size() > study.judgements.size()) {
      AnalysisOptions test_alone = options_at(plan_, look, arguments_.options);
      test_alone.curves = false;
      analysis.experiment->p_with_excluded = main_result(whole, test_alone).p_value;
    }
    if (!opened_.state.problems.empty()) context_.exit = Exit::check_failed;
    return {.study = std::move(study), .analysis = std::move(analysis)};
  }

 private:
  [[nodiscard]] Experiment experiment_as_made() const {
    Experiment made = opened_.state.experiment;
    made.analysis = plan_;
    return made;
  }

  [[nodiscard]] Look look_of(std::vector<std::string> participants) const {
    ExperimentState state = opened_.state;
    state.experiment = experiment_as_made();
    return look_at(
        state,
        {.participants = std::move(participants), .reason = arguments_.reason, .two_sided = two_sided_});
  }

  /// Before any session is opened, by who is through.
  void require_may_look() {
    std::vector<std::string> through;
    for (const Participant& each : opened_.state.participants) {
      if (each.completed() && !each.is_out()) through.push_back(each.code);
    }
    (void)look_of(through);
  }

  void open_sessions() {
    std::vector<std::string> warnings;
    for (const Participant& each : opened_.state.participants) {
      if (!each.completed() || each.is_out()) continue;
      open_.push_back(open_participant(
          each, [&](const fs::path& file) { return key_for(key_, derivation_of(file)); }, opened_.state,
          warnings));
    }
    for (const std::string& warning : warnings) warn(warning);
    if (open_.empty()) return;
    const Protocol& protocol = open_.front().stores.front()->protocol();
    require_fits(experiment_as_made(), protocol, opened_.file.string());
    two_sided_ = is_two_sided(protocol, plan_.test);
  }

  void leave_out_excluded() {
    exclude_by_measure(open_, plan_.exclude, opened_.state);
    std::erase_if(open_,
                  [&](const OpenParticipant& each) { return opened_.state.find(each.code)->is_out(); });
  }

  [[nodiscard]] std::vector<std::string> codes() const {
    std::vector<std::string> all;
    for (const OpenParticipant& each : open_) all.push_back(each.code);
    return all;
  }

  /// So that a log whose end is cut off is told from what the sessions to come know.
  void note_in_sessions(const Look& look) {
    for (const Participant& each : opened_.state.participants) {
      if (each.is_out()) continue;
      for (const AssignedSession& session : each.sessions) {
        if (!session.is_there || session.finished) continue;
        try {
          SessionStore store(session.file, key_for(key_, derivation_of(session.file)),
                             SessionStore::Purpose::run);
          store.note("look", fmt::format("look {} of the study", look.number));
          store.close();
        } catch (const std::invalid_argument& error) {
          warn(fmt::format("the look is not noted in a session to come: {}", error.what()));
        }
      }
    }
  }

  [[nodiscard]] std::string experiment_now() const {
    std::error_code ignored;
    return fs::exists(opened_.file, ignored) ? read_named_file(opened_.file) : std::string();
  }

  ExperimentReport report_of(const Study& study, const Analysis& analysis, const Look& look) {
    const ExperimentState& state = opened_.state;
    AnalysisAsMade made{
        .plan = plan_,
        .experiment_toml = experiment_now(),
        .experiment_name = opened_.file.string(),
        .protocol_file = (opened_.file.parent_path() / state.experiment.protocol).lexically_normal().string(),
        .main_test = analysis.main_test};
    made.tests_people = plan_.test != PrimaryTest::difference || !analysis.all || analysis.levels ||
                        analysis.all->tests_subjects;
    ExperimentReport report{.state = state,
                            .flow = flow_of(state),
                            .look = look,
                            .decision = decide(study, experiment_as_made(), look, primary_figures(analysis)),
                            .deviations = deviations_of(state, look, made, opened_.log.registered().facts),
                            .log_receipt = opened_.log.receipt()};
    return report;
  }

  const ExperimentAnalysisArguments& arguments_;
  KeyArguments& key_;
  Context& context_;
  OpenedExperiment opened_;
  AnalysisPlan plan_;
  bool two_sided_ = false;
  std::vector<OpenParticipant> open_;
};

}  // namespace

AnalysedExperiment analyse_experiment(const ExperimentAnalysisArguments& arguments, KeyArguments& key,
                                      Context& context) {
  return ExperimentAnalysis(arguments, key, context).run();
}

}  // namespace kerf::bench
