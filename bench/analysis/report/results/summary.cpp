#include "report/results/summary.h"

#include <algorithm>
#include <array>

#include <fmt/core.h>

#include "identify/identified_page.h"
#include "report/results/states.h"
#include "run/check.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

/// What a report of a recording ought to have.
constexpr std::array all_kinds{ResultKind::inspection, ResultKind::fits,      ResultKind::choice,
                               ResultKind::chart,      ResultKind::stability, ResultKind::replay,
                               ResultKind::check};

SummaryLine of_inspection(const json& inspection, const std::optional<CycleCount>& now) {
  std::size_t flagged = 0;
  std::size_t cycles = 0;
  if (inspection.at("cycles").contains("list")) {
    for (const json& cycle : inspection.at("cycles").at("list")) {
      ++cycles;
      flagged += cycle.at("good").get<bool>() ? 0 : 1;
    }
  }
  const std::size_t warnings = inspection.at("warnings").size();
  if (now && cycles > 0 && (now->all != cycles || now->all - now->good != flagged))
    return {.is_known = false,
            .text = fmt::format("the recording: {} of {} cycles flagged now, {} of {} when it was inspected: "
                                "run kerf inspect again",
                                now->all - now->good, now->all, flagged, cycles)};
  return {.answer = flagged + warnings == 0 ? Answer::good : Answer::partly,
          .text = fmt::format("the recording: {} of {} cycles flagged, {} warning{}", flagged, cycles,
                              warnings, warnings == 1 ? "" : "s")};
}

SummaryLine of_fits(const json& fits) {
  const json& choice = fits.at("choice");
  const std::string model = choice.at("model").get<std::string>();
  if (model.empty()) return {.answer = Answer::bad, .text = "fits: no law could be fitted"};
  const auto within = choice.find("within_jnd");
  if (within == choice.end() || !within->is_boolean())
    return {.is_known = false, .text = fmt::format("fits: whether {} is within the JND", model)};
  if (within->get<bool>())
    return {.answer = Answer::good, .text = fmt::format("fits: {} is within the JND", model)};
  return {.answer = Answer::partly, .text = fmt::format("fits: {}, the best, is not within the JND", model)};
}

SummaryLine of_choice(const json& choice) {
  const json& made = choice.at("choice");
  const std::string law = made.at("law").is_string() ? made.at("law").get<std::string>() : "no law";
  if (made.value("in_doubt", false))
    return {.is_known = false, .text = fmt::format("choice: whether {} serves is in doubt", law)};
  if (made.at("serves").get<bool>())
    return {.answer = Answer::good, .text = fmt::format("choice: {} serves", law)};
  return {.answer = Answer::bad, .text = fmt::format("choice: none serves; {} is the best", law)};
}

SummaryLine of_chart(const json& chart) {
  std::size_t within = 0;
  for (const json& point : chart.at("points")) {
    if (!point.contains("within_jnd"))  // of an earlier version
      return {.is_known = false, .text = "chart: which laws are within the JND"};
    within += point.at("within_jnd").get<bool>() ? 1 : 0;
  }
  return {.answer = within > 0 ? Answer::good : Answer::partly,
          .text = fmt::format("chart: {} of {} laws and fidelities are within the JND", within,
                              chart.at("points").size())};
}

SummaryLine of_stability(const json& stability) {
  const auto passive = stability.find("passive");
  const std::string law = stability.value("law", std::string("the law"));
  if (passive != stability.end() && passive->is_null())
    return {.is_known = false, .text = fmt::format("stability: {} was never met", law)};
  if (passive == stability.end() || !passive->is_boolean())
    return {.is_known = false, .text = "stability: a study of walls or cases, not of a law"};
  if (!passive->get<bool>())
    return {.answer = Answer::bad, .text = fmt::format("stability: {} is not passive", law)};
  return {.answer = Answer::good,
          .text = fmt::format("stability: no stroke that was tried disproves that {} is passive", law)};
}

SummaryLine of_device(const json& device) {
  std::string text = fmt::format("device {}:", device.at("device").get<std::string>());
  bool known = true;
  for (const json& axis : device.at("axes")) {
    known = known && axis.contains("fits") && axis.at("fits").is_boolean();
    text += fmt::format(" {}: {},", axis.at("name").get<std::string>(), axis_verdict(axis));
  }
  text.pop_back();
  return {.answer = device.at("good").get<bool>() ? Answer::good : Answer::partly,
          .is_known = known,
          .text = text};
}

SummaryLine of_replay(const json& replay) {
  std::string text = "replay:";
  bool within = true;
  bool known = false;
  for (const json& law : replay.at("laws")) {
    for (const json& axis : law.value("axes", json::array())) {
      if (!axis.at("rms_jnd").is_number()) continue;
      known = true;
      const double error = axis.at("rms_jnd").get<double>();
      within = within && error <= 1.0;
      text += fmt::format(" {} errs by {:.2g} JND along {};", law.at("name").get<std::string>(), error,
                          axis.at("axis").get<std::string>());
    }
  }
  if (!known) return {.is_known = false, .text = "replay: nothing was compared"};
  text.pop_back();
  return {.answer = within ? Answer::good : Answer::partly, .text = text};
}

SummaryLine of_check(const json& check) {
  const std::string law = check.value("law", std::string("the law"));
  if (check.at("verdict") == not_felt)
    return {.is_known = false, .text = fmt::format("closed loop: {} was never felt", law)};
  if (check.at("verdict") != "pass")
    return {.answer = Answer::bad, .text = fmt::format("closed loop: {} fails", law)};
  if (!check.at("passive").get<bool>())
    return {.answer = Answer::partly,
            .text = fmt::format("closed loop: {} is in time, but not passive", law)};
  return {.answer = Answer::good, .text = fmt::format("closed loop: {} is in time and passive", law)};
}

std::string listed(const char* what, const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string html = fmt::format("<br><strong>{}</strong>:", what);
  for (const std::string& line : lines) html += " " + escaped(line) + (&line == &lines.back() ? "." : ";");
  return html;
}

}  // namespace

SummaryLine summary_of(const FoundResult& result, const std::optional<CycleCount>& cycles) {
  SummaryLine line;
  switch (result.kind) {
    case ResultKind::inspection:
      line = of_inspection(result.json, cycles);
      break;
    case ResultKind::fits:
      line = of_fits(result.json);
      break;
    case ResultKind::choice:
      line = of_choice(result.json);
      break;
    case ResultKind::chart:
      line = of_chart(result.json);
      break;
    case ResultKind::stability:
      line = of_stability(result.json);
      break;
    case ResultKind::device:
      line = of_device(result.json);
      break;
    case ResultKind::replay:
      line = of_replay(result.json);
      break;
    case ResultKind::check:
      line = of_check(result.json);
      break;
  }
  if (!line.is_known) line.answer = Answer::partly;
  if (result.belongs == Belongs::elsewhere) {
    line.is_known = false;
    if (line.answer == Answer::good) line.answer = Answer::partly;
    line.text += " (of another recording)";
  }
  if (is_outdated(result.state)) {
    line.is_known = false;
    line.answer = std::max(line.answer, Answer::partly);
    line.text += fmt::format(" ({})", outdated_in_words(result));
  }
  if (result.kind == ResultKind::device) return line;
  if (result.belongs == Belongs::unknown && line.answer == Answer::good) {
    line = {.is_known = false, .text = line.text + " (of which recording, it does not say)"};
  }
  return line;
}

std::string summary_paragraph(const std::vector<FoundResult>& results,
                              const std::optional<CycleCount>& cycles) {
  std::vector<std::string> holds, fails, unknown;
  Answer worst = Answer::good;
  for (const FoundResult& result : results) {
    SummaryLine line = summary_of(result, cycles);
    worst = std::max(worst, line.answer);
    (!line.is_known ? unknown : line.answer == Answer::good ? holds : fails).push_back(std::move(line.text));
  }
  std::string missing;
  for (const ResultKind kind : all_kinds) {
    if (std::ranges::any_of(results, [&](const FoundResult& one) { return one.kind == kind; })) continue;
    missing += fmt::format("{}{}", missing.empty() ? "what " : ", ", verb_of(kind));
  }
  if (!missing.empty()) {
    worst = std::max(worst, Answer::partly);
    unknown.push_back(missing + " would say");
  }
  const std::string lists =
      listed("Holds", holds) + listed("Does not hold", fails) + listed("Not known", unknown);
  return html_answer(worst, lists.substr(4));  // without the first line break
}

}  // namespace kerf::bench
