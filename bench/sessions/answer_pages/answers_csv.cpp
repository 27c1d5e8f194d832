#include <algorithm>

#include <fmt/core.h>
#include <fmt/format.h>

#include "answers/answers_table.h"
#include "tables/csv.h"

namespace kerf::bench {
namespace {

const char* task_name(const psychophysics::Task& task) {
  using psychophysics::Decision;
  switch (task.decision) {
    case Decision::oddity:
      return "oddity";
    case Decision::abx_differencing:
    case Decision::same_different_differencing:
      return "differencing";
    case Decision::same_different:
    case Decision::abx_independent:
    case Decision::forced_choice:
    case Decision::yes_no:
      break;
  }
  return nullptr;
}

}  // namespace

std::string answers_csv(const Study& study) {
  std::string text =
      fmt::format("# name = {}\n# design = \"{}\"\n", csv_quoted(study.name), name_of(study.design));
  if (const char* task = study.task ? task_name(*study.task) : nullptr)
    text += fmt::format("# task = \"{}\"\n", task);
  if (study.scale.quest.narrow > 0.0)
    text += fmt::format("# until = {}\n", csv_number(study.scale.quest.narrow));
  const bool has_tracks = std::any_of(study.judgements.begin(), study.judgements.end(),
                                      [](const Judgement& each) { return each.track > 0; });
  const bool two_sided = study.scale.two_sided();
  const bool preference = study.design == Design::preference;
  const bool of_numbers = asks_numbers(study.design);
  if (study.numbers.modulus > 0.0) text += fmt::format("# modulus = {}\n", csv_number(study.numbers.modulus));
  if (study.numbers.points > 0) text += fmt::format("# points = {}\n", study.numbers.points);
  const char* answer = of_numbers          ? "estimate,intensity"
                       : study.slots_known ? "right,answer"
                       : preference        ? "preferred"
                       : two_sided         ? "comparison"
                                           : "correct";
  const bool any_void =
      std::ranges::any_of(study.judgements, [](const Judgement& each) { return !each.void_reasons.empty(); });
  const bool any_catch = std::ranges::any_of(study.judgements, &Judgement::is_catch);
  text +=
      fmt::format("subject,number,practice,tissue,first,second,level,{},response_s,switches{}{}{}\n", answer,
                  study.confidence_levels > 0 ? ",confidence"
                  : has_tracks                ? ",track"
                                              : "",
                  any_void ? ",void" : "", any_catch ? ",catch" : "");
  for (const Judgement& each : study.judgements) {
    const auto sample = [&](std::size_t at) {
      return at < study.samples.size() ? csv_text(study.samples[at]) : std::string();
    };
    std::string said = each.is_right() ? "1" : "0";
    if (of_numbers) {
      said = fmt::format("{},{}", csv_number(each.estimate), csv_number(each.intensity));
    } else if (study.slots_known) {
      said = fmt::format("{},{}", answer_label_of(study.design, each.right),
                         answer_label_of(study.design, each.answer));
    } else if (preference) {
      said = sample(each.pair[each.is_right() ? 1 : 0]);
    }
    text += fmt::format(
        "{},{},{},{},{},{},{},{},{},{}{}{}{}\n", csv_text(each.subject), each.session, each.practice ? 1 : 0,
        csv_text(each.tissue), sample(each.pair[0]), sample(each.pair[1]), csv_number(each.level), said,
        csv_number(each.response_s), each.switches,
        study.confidence_levels > 0 ? fmt::format(",{}", each.confidence)
        : has_tracks                ? fmt::format(",{}", each.track + 1)
                                    : "",
        any_void ? "," + joined(each.void_reasons) : "", any_catch ? (each.is_catch ? ",1" : ",0") : "");
  }
  return text;
}

}  // namespace kerf::bench
