#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "answer_pages/analysis_json.h"
#include "answer_pages/analysis_page.h"
#include "answers/answers_table.h"
#include "experiment/analyze_experiment.h"
#include "experiment/key_arguments.h"
#include "experiment/session_log.h"
#include "experiment/verb_session.h"
#include "files/whole_file.h"
#include "sealed/opening.h"
#include "sealed/session_store.h"
#include "session/receipt.h"

namespace kerf::bench {
namespace {

struct SessionAnalyzeVerbArguments {
  std::vector<std::string> files;
  std::vector<std::string> receipts;
  std::string output;
  std::string reason;
  std::string design;
  std::string correction = "holm";
  std::string test;
  std::optional<double> level;
  std::vector<double> jnd_margins;
  double bootstrap = AnalysisOptions{}.bootstrap;
  AnalysisOptions options;
  KeyArguments key;
  bool replace = false;
};

std::vector<Receipt> receipts_in(const std::vector<std::string>& named) {
  std::vector<Receipt> receipts;
  for (const std::string& one : named) {
    const auto more = receipts_named(one);
    receipts.insert(receipts.end(), more.begin(), more.end());
  }
  return receipts;
}

/// What a receipt does not bear out is a check that did not pass, and a warning.
void hold_against(const std::vector<Receipt>& receipts, const std::vector<NamedSession>& sessions,
                  Context& context) {
  if (receipts.empty()) return;
  for (const ReceiptFinding& finding : held_against(receipts, sessions)) {
    context.result["receipts"].push_back(
        {{"receipt", finding.receipt.in_full()}, {"holds", finding.holds}, {"finding", finding.text}});
    if (finding.holds) {
      context.say(finding.text);
    } else {
      warn(finding.text);
      context.exit = Exit::check_failed;
    }
  }
}

bool is_table(const std::string& file) {
  return file.ends_with(".csv") || file.ends_with(".tsv") || file.ends_with(".txt");
}

Study read_table(const SessionAnalyzeVerbArguments& arguments) {
  if (!arguments.receipts.empty()) throw std::invalid_argument("--receipt is for sessions; a table has none");
  if (arguments.files.size() != 1)
    throw std::invalid_argument("a table of answers is analysed alone; put all answers into one table");
  if (arguments.design.empty()) return read_answers(arguments.files.front());
  return read_answers(arguments.files.front(), design_named(arguments.design));
}

Study read_sessions(SessionAnalyzeVerbArguments& arguments, Context& context) {
  if (!arguments.design.empty())
    throw std::invalid_argument("--design is for tables: a session knows its design");
  const std::vector<Receipt> receipts = receipts_in(arguments.receipts);  // before a file is opened
  std::vector<std::unique_ptr<SessionStore>> stores;
  std::vector<const SessionStore*> sessions;
  std::vector<NamedSession> named;
  std::vector<std::string> remarks;
  const auto mind = [&](std::string remark) {
    warn(remark);
    remarks.push_back(std::move(remark));
  };
  context.result["early_openings"] = nlohmann::ordered_json::array();
  for (const std::string& file : arguments.files) {
    if (is_table(file))
      throw std::invalid_argument(fmt::format("{}: sessions and tables are not analysed together", file));
    stores.push_back(opened_session(file, arguments.key, arguments.reason));
    const SessionStore& store = *stores.back();
    if (membership_of(store.session()))
      mind(fmt::format("{}: a session of an experiment, analysed outside of it", file));
    sessions.push_back(&store);
    for (const std::string& warning : store.warnings()) mind(warning);
    for (const std::string& opening : store.early_openings()) {
      mind(fmt::format("{}: opened before its end: {}", file, opening));
      context.result["early_openings"].push_back({{"file", file}, {"opening", opening}});
    }
    if (was_rehearsed(store.session()))
      mind(fmt::format("{}: a rehearsal, whose answers are by chance", file));
    named.push_back({.file = file, .session = &store});
  }
  hold_against(receipts, named, context);
  for (auto one = named.begin(); one != named.end(); ++one) {
    const auto twin = std::find_if(named.begin(), one, [&](const NamedSession& other) {
      return other.session->session().subject == one->session->session().subject;
    });
    if (twin != one)
      mind(fmt::format("{} and {} are two sessions of {}, who is counted as one person", twin->file,
                       one->file, one->session->session().subject));
  }
  Study study = study_of(sessions);
  // Those of the sessions themselves, such as notes, stay.
  study.remarks.insert(study.remarks.begin(), std::make_move_iterator(remarks.begin()),
                       std::make_move_iterator(remarks.end()));
  return study;
}

AnalysedExperiment analysed(SessionAnalyzeVerbArguments& arguments, Context& context) {
  AnalysisOptions& options = arguments.options;
  const std::string& first = arguments.files.front();
  if (!is_experiment(first)) {
    if (!arguments.test.empty())
      throw std::invalid_argument("--test is for an experiment: a session has the main test of its design");
    if (arguments.level) options.level = *arguments.level;
    Study study = is_table(first) ? read_table(arguments) : read_sessions(arguments, context);
    Analysis analysis = analyse(study, options);
    return {.study = std::move(study), .analysis = std::move(analysis)};
  }
  if (arguments.files.size() != 1 || !arguments.receipts.empty() || !arguments.design.empty())
    throw std::invalid_argument(
        "an experiment is analysed alone, and knows its design and its receipts; leave out all else");
  return analyse_experiment({.experiment = first,
                             .reason = arguments.reason,
                             .test = arguments.test,
                             .alpha = arguments.level,
                             .margin = options.margin,
                             .d_prime = options.d_prime_bound,
                             .jnd_margins = options.jnd_margins,
                             .options = options},
                            arguments.key, context);
}

void analyze(SessionAnalyzeVerbArguments& arguments, Context& context) {
  if (!arguments.output.empty())
    require_output(std::filesystem::path(arguments.output) / "analysis.html", arguments.replace);
  AnalysisOptions& options = arguments.options;
  options.bootstrap = static_cast<int>(arguments.bootstrap);
  options.seed = context.seed;
  if (arguments.correction == "bh") options.correction = FamilyCorrection::benjamini_hochberg;
  if (!arguments.jnd_margins.empty())
    options.jnd_margins = psychophysics::Interval{arguments.jnd_margins[0], arguments.jnd_margins[1]};
  const auto [study, analysis] = analysed(arguments, context);
  nlohmann::ordered_json json = analysis_as_json(analysis);
  if (!context.result.is_null()) json.update(context.result);
  context.result = std::move(json);
  for (const std::string& line : summary_lines(analysis)) context.say(line);
  if (arguments.output.empty()) return;
  write_analysis(study, analysis, arguments.output, arguments.replace);
  context.say(
      fmt::format("analysis.html, analysis.json, answers.csv and the charts are in {}", arguments.output));
}

}  // namespace

void add_session_analyze(CLI::App& session, Context& context) {
  auto arguments = std::make_shared<SessionAnalyzeVerbArguments>();
  AnalysisOptions& options = arguments->options;
  Verb verb = add_verb(
      session, context, "analyze", "What the answers of sessions show, and what they do not",
      "kerf session analyze study --key-file keeper.key -o analysis\n"
      "  kerf session analyze S*.h5 --key-file keeper.key -o analysis\n"
      "  kerf session analyze examples/sessions/okamura2003-table-1.csv\n\n"
      "Takes an experiment (its folder), the sessions of one protocol, or a table of answers. An experiment\n"
      "is analysed as it was registered: a look before the end is refused, or paid for by its stopping "
      "rule,\n"
      "and kept in its log; what the command line has otherwise is called a deviation. docs/experiments.md,\n"
      "docs/sessions-analysis.md and docs/psychophysics.md have the rest.",
      [arguments, &context] { analyze(*arguments, context); });
  verb.takes_laws(context);
  verb.add_option("FILES", arguments->files, "An experiment, session files, or one table of answers (.csv)")
      .required();
  add_key_options(verb, arguments->key);
  verb.add_option("-o,--output", arguments->output, "Folder for the page, the tables and the charts");
  verb.add_option(
      "--reason", arguments->reason,
      "Why a session is opened before its end, or an experiment looked at although its rule has no look; "
      "kept in the file, and in the log");
  verb.add_option("--receipt", arguments->receipts,
                  "Receipt of 'session run', or a file of them (may be repeated); 1 where a file does not "
                  "bear one out")
      .one_value_each();
  verb.add_option("--design", arguments->design, "Design of a table that does not say it");
  verb.add_option("--confidence", options.confidence, "Confidence level of the intervals")
      .within(0.5, 0.999)
      .with_default();
  verb.add_option("--level", arguments->level,
                  "Significance level of the tests (default: 0.05; of an experiment its alpha)")
      .within(0.001, 0.5);
  verb.add_option("--test", arguments->test,
                  "Primary test of an experiment in place of the registered one: difference or equivalence")
      .one_of({"difference", "equivalence"});
  verb.add_option("--margin", options.margin,
                  "Equivalence margin of a preference, 50 % +- this (default: none)")
      .within(0.001, 0.5);
  verb.add_option("--d-prime", options.d_prime_bound,
                  "Renderings count as equal below this d' (default: none)")
      .positive();
  verb.add_option("--jnd-margins", arguments->jnd_margins, "LOWER UPPER: equivalence margin of a JND")
      .taking(2);
  verb.add_option("--correction", arguments->correction, "For several tests: holm or bh")
      .one_of({"holm", "bh"})
      .with_default();
  verb.add_option("--lapse", options.lapse, "Lapse rate, fixed (default: estimated in 0 to 0.06)");
  verb.add_option("--criterion", options.criterion,
                  "Share of right answers at the threshold (default: half way from guessing)");
  verb.add_option("--bootstrap", arguments->bootstrap, "Samples for the goodness of fit; 0: none")
      .within(0.0, 1e5)
      .with_default();
  verb.add_flag("--force", arguments->replace, "Replace existing files");
}

}  // namespace kerf::bench
