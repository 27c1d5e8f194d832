#include "answer_pages/experiment_words.h"

#include <cmath>

#include <fmt/format.h>

#include "answer_pages/analysis_words.h"
#include "answer_pages/levels_json.h"
#include "files/json_number.h"
#include "html/html.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string counts_line(const FlowCounts& counts) {
  return fmt::format(
      "{}: {} assigned, {} begun, {} completed, {} dropped, {} replaced, {} excluded, {} analysed",
      counts.group.empty() ? "participants" : "group " + counts.group, counts.assigned, counts.begun,
      counts.completed, counts.dropped, counts.replaced, counts.excluded, counts.analysed);
}

/// "S04 dropped: left after practice; S13 has their order"
std::string leaving_line(const Participant& who) {
  std::string line =
      fmt::format("{} {}: {}", who.code, who.dropped ? "dropped" : "excluded",
                  who.rule.empty() ? who.reason : fmt::format("{} ({})", who.rule, who.reason));
  if (!who.replaced_by.empty()) line += fmt::format("; {} has their order", who.replaced_by);
  return line;
}

std::string look_line(const ExperimentReport& report) {
  const Look& look = report.look;
  return fmt::format("look {} at {} of {} participants, {}, rule \"{}\"", look.number,
                     look.participants.size(), report.state.experiment.participants.target,
                     look.is_last   ? "the last"
                     : look.is_paid ? "before the end"
                                    : "before the end and in no rule",
                     name_of(report.state.experiment.analysis.stopping.kind));
}

/// "with those excluded by measured criteria, p = 0.03"
std::string excluded_line(const ExperimentReport& report) {
  if (std::isnan(report.p_with_excluded)) return {};
  return fmt::format("had those been analysed whom a measured criterion excludes: {}",
                     p_text(report.p_with_excluded));
}

Json counts_json(const FlowCounts& counts) {
  Json facts = Json::object();
  if (!counts.group.empty()) facts["group"] = counts.group;
  facts["assigned"] = counts.assigned;
  facts["begun"] = counts.begun;
  facts["completed"] = counts.completed;
  facts["dropped"] = counts.dropped;
  facts["replaced"] = counts.replaced;
  facts["excluded"] = counts.excluded;
  facts["analysed"] = counts.analysed;
  return facts;
}

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json plan_json(const Experiment& experiment) {
  const AnalysisPlan& plan = experiment.analysis;
  return {{"target", experiment.participants.target},
          {"visits", experiment.participants.visits},
          {"replace", name_of(experiment.participants.replace)},
          {"test", name_of(plan.test)},
          {"alpha", plan.alpha},
          {"margin", plan.margin ? Json(*plan.margin) : Json(nullptr)},
          {"d_prime", plan.d_prime ? Json(*plan.d_prime) : Json(nullptr)},
          {"jnd_margins", plan.jnd_margins ? pair_of(*plan.jnd_margins) : Json(nullptr)},
          {"catch_right", plan.exclude.catch_right ? Json(*plan.exclude.catch_right) : Json(nullptr)},
          {"stopping", name_of(plan.stopping.kind)},
          {"looks", experiment.planned_looks()}};
}

std::string list_section(const char* title, const std::vector<std::string>& sentences) {
  if (sentences.empty()) return {};
  std::string html = fmt::format("<h3>{}</h3>\n<ul>\n", title);
  for (const std::string& sentence : sentences)
    html += fmt::format("<li>{}</li>\n", escaped(as_sentence(sentence)));
  return html + "</ul>\n";
}

std::vector<std::string> leavings(const ExperimentState& state) {
  std::vector<std::string> lines;
  for (const Participant& each : state.participants) {
    if (each.is_out()) lines.push_back(leaving_line(each));
  }
  return lines;
}

}  // namespace

std::vector<std::string> flow_lines(const ExperimentState& state, const std::vector<FlowCounts>& flow) {
  std::vector<std::string> lines;
  for (const FlowCounts& counts : flow) lines.push_back(counts_line(counts));
  for (std::string& line : leavings(state)) lines.push_back("  " + std::move(line));
  return lines;
}

Json flow_json(const ExperimentState& state, const std::vector<FlowCounts>& flow) {
  Json facts = counts_json(flow.front());
  facts["groups"] = Json::array();
  for (std::size_t i = 1; i < flow.size(); ++i) facts["groups"].push_back(counts_json(flow[i]));
  facts["participants"] = Json::array();
  for (const Participant& each : state.participants) {
    Json files = Json::array();
    for (const AssignedSession& session : each.sessions)
      files.push_back({{"visit", session.visit},
                       {"file", session.file.string()},
                       {"there", session.is_there},
                       {"finished", session.finished},
                       {"trials", session.trials}});
    facts["participants"].push_back({{"participant", each.code},
                                     {"group", text_or_null(each.group)},
                                     {"order", each.number},
                                     {"stage", stage_of(each)},
                                     {"replaces", text_or_null(each.replaces)},
                                     {"replaced_by", text_or_null(each.replaced_by)},
                                     {"reason", text_or_null(each.reason)},
                                     {"rule", text_or_null(each.rule)},
                                     {"sessions", std::move(files)}});
  }
  return facts;
}

std::vector<std::string> experiment_lines(const ExperimentReport& report) {
  std::vector<std::string> lines = flow_lines(report.state, report.flow);
  lines.push_back(look_line(report));
  lines.push_back("decision: " + as_sentence(report.decision.text));
  if (const std::string line = excluded_line(report); !line.empty()) lines.push_back(line);
  for (const std::string& deviation : report.deviations)
    lines.push_back("deviation: " + as_sentence(deviation));
  for (const std::string& problem : report.state.problems) lines.push_back("file: " + problem);
  lines.push_back("log: receipt " + report.log_receipt);
  return lines;
}

Json experiment_json(const ExperimentReport& report) {
  const Look& look = report.look;
  const LookDecision& decision = report.decision;
  Json looks = Json::array();
  for (const PastLook& past : report.state.looks)
    looks.push_back({{"time", past.time},
                     {"participants", past.participants},
                     {"paid", past.paid},
                     {"reason", text_or_null(past.reason)}});
  return {{"name", report.state.experiment.name},
          {"registered", plan_json(report.state.experiment)},
          {"flow", flow_json(report.state, report.flow)},
          {"looks_before", std::move(looks)},
          {"look",
           {{"number", look.number},
            {"participants", look.participants},
            {"last", look.is_last},
            {"planned", look.is_planned},
            {"paid", look.is_paid},
            {"alpha_spent", look.spent},
            {"nominal", look.nominal}}},
          {"decision",
           {{"p_value", json_number(decision.p_value)},
            {"bayes_factor", decision.bayes_factor ? json_number(*decision.bayes_factor) : Json(nullptr)},
            {"shown", decision.is_shown},
            {"ends", decision.ends},
            {"text", as_sentence(decision.text)}}},
          {"p_value_with_excluded", json_number(report.p_with_excluded)},
          {"deviations", report.deviations},
          {"files", report.state.problems},
          {"log_receipt", report.log_receipt}};
}

std::string experiment_section(const ExperimentReport& report) {
  std::vector<std::vector<std::string>> rows{
      {"", "assigned", "begun", "completed", "dropped", "replaced", "excluded", "analysed"}};
  for (const FlowCounts& counts : report.flow) {
    rows.push_back({counts.group.empty() ? "all" : counts.group});
    for (const std::size_t number : {counts.assigned, counts.begun, counts.completed, counts.dropped,
                                     counts.replaced, counts.excluded, counts.analysed})
      rows.back().push_back(std::to_string(number));
  }
  return fmt::format("<h2>The experiment</h2>\n<p>{}</p>\n<p class=\"soft\">{} Receipt of the log: {}.</p>\n",
                     escaped(as_sentence(report.decision.text)), escaped(as_sentence(look_line(report))),
                     report.log_receipt) +
         "<h3>Participants</h3>\n" + html_table(rows) + list_section("Who left", leavings(report.state)) +
         (std::isnan(report.p_with_excluded)
              ? std::string()
              : fmt::format("<p>{}</p>\n", escaped(as_sentence(excluded_line(report))))) +
         list_section("Deviations from what was registered", report.deviations) +
         list_section("Files of the study", report.state.problems);
}

}  // namespace kerf::bench
