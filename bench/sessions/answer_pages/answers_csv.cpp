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
      return "differencing";
    case Decision::same_different:
    case Decision::abx_independent:
    case Decision::forced_choice:
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
  const bool two_sided = study.scale.two_sided();
  const bool preference = study.design == Design::preference;
  const char* answer = study.slots_known ? "right,answer"
                       : preference      ? "preferred"
                       : two_sided       ? "comparison"
                                         : "correct";
  text += fmt::format("subject,number,practice,tissue,first,second,level,{},response_s,switches\n", answer);
  for (const Judgement& each : study.judgements) {
    const auto sample = [&](std::size_t at) {
      return at < study.samples.size() ? csv_text(study.samples[at]) : std::string();
    };
    std::string said = each.is_right() ? "1" : "0";
    if (study.slots_known) {
      said = fmt::format("{},{}", label_of(study.design, each.right), label_of(study.design, each.answer));
    } else if (preference) {
      said = sample(each.pair[each.is_right() ? 1 : 0]);
    }
    text +=
        fmt::format("{},{},{},{},{},{},{},{},{},{}\n", csv_text(each.subject), each.session,
                    each.practice ? 1 : 0, csv_text(each.tissue), sample(each.pair[0]), sample(each.pair[1]),
                    csv_number(each.level), said, csv_number(each.response_s), each.switches);
  }
  return text;
}

}  // namespace kerf::bench
