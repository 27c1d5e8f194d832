#include "answers/answers_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>

#include "answer_pages/answer_text.h"
#include "files/named_file.h"

namespace kerf::bench {
namespace {

constexpr std::array designs{Design::preference,     Design::abx,      Design::two_interval,
                             Design::three_interval, Design::constant, Design::staircase,
                             Design::quest_plus};

Design design_of(const AnswerText& text, std::optional<Design> said) {
  if (said) return *said;
  if (const auto remark = text.remarks.find("design"); remark != text.remarks.end()) {
    try {
      return design_named(remark->second.first);
    } catch (const std::invalid_argument& error) {
      text.refuse(remark->second.second, "{}", error.what());
    }
  }
  if (text.column("preferred")) return Design::preference;
  if (text.column("level") || text.column("comparison")) return Design::constant;
  text.refuse(
      text.head_line,
      "the table does not say what was asked; add a line such as # design = \"abx\" above the columns");
}

psychophysics::Task task_for(const AnswerText& text, Design design) {
  using psychophysics::Decision;
  const std::string said = text.remark("task");
  const bool fits = said.empty() || (design == Design::three_interval && said == "oddity") ||
                    (design == Design::abx && (said == "differencing" || said == "independent"));
  if (!fits) {
    text.refuse(text.remarks.at("task").second,
                "task '{}' does not go with the design '{}'; expected oddity with 3ifc, or independent or "
                "differencing with abx",
                said, name_of(design));
  }
  if (design == Design::abx)
    return {.decision = said == "differencing" ? Decision::abx_differencing : Decision::abx_independent};
  if (said == "oddity") return {.decision = Decision::oddity, .intervals = 3};
  return {.decision = Decision::forced_choice, .intervals = design == Design::three_interval ? 3 : 2};
}

/// How the table says what was answered.
enum class AnswerForm { preferred, slots, correct, comparison };

AnswerForm form_of(const AnswerText& text, Design design) {
  if (!text.column("subject")) {
    text.refuse(text.head_line, "no column 'subject' among {}; expected one such as subject,tissue,preferred",
                fmt::join(text.head, ","));
  }
  if (has_levels(design) && !text.column("level"))
    text.refuse(text.head_line, "no column 'level', which the design '{}' needs", name_of(design));
  if (text.column("right") && text.column("answer")) return AnswerForm::slots;
  if (design == Design::preference) {
    if (text.column("preferred")) return AnswerForm::preferred;
    text.refuse(text.head_line, "no column 'preferred', nor 'right' and 'answer': what was preferred?");
  }
  if (text.column("comparison")) return AnswerForm::comparison;
  if (text.column("correct")) return AnswerForm::correct;
  text.refuse(text.head_line, "no column 'correct', nor 'right' and 'answer': what was answered?");
}

std::size_t sample_named(Study& study, const std::string& name) {
  const auto found = std::find(study.samples.begin(), study.samples.end(), name);
  if (found != study.samples.end()) return static_cast<std::size_t>(found - study.samples.begin());
  study.samples.push_back(name);
  return study.samples.size() - 1;
}

/// The two that are compared: those of the columns `first` and `second`, or the two of the whole table.
std::array<std::size_t, 2> pair_of(const AnswerReader& row, const AnswerText& text, Study& study) {
  if (text.column("first") && text.column("second")) {
    const std::string first = row.field("first");
    const std::string second = row.field("second");
    if (!first.empty() || !second.empty()) {
      if (first.empty() || second.empty()) row.refuse("only one of 'first' and 'second' is given");
      const std::size_t one = sample_named(study, first);
      return {one, sample_named(study, second)};
    }
  }
  return {0, study.samples.size() > 1 ? std::size_t{1} : std::size_t{0}};
}

void name_samples(const AnswerText& text, AnswerForm form, Study& study) {
  if (text.column("first") && text.column("second")) return;
  if (form != AnswerForm::preferred) {
    study.samples = {"standard", "comparison"};
    return;
  }
  for (const AnswerRow& row : text.rows) {
    (void)sample_named(study, AnswerReader(text, row).needed("preferred"));
    if (study.samples.size() > 2) {
      text.refuse(row.line,
                  "'{}' is a third sample besides '{}' and '{}'; of more than two, columns 'first' "
                  "and 'second' have to say which were compared",
                  study.samples[2], study.samples[0], study.samples[1]);
    }
  }
  if (study.samples.size() == 1) study.samples.emplace_back("the other");
}

void read_answer(const AnswerReader& row, AnswerForm form, Study& study, Judgement& judgement) {
  if (form == AnswerForm::slots) {
    judgement.right = row.slot("right", study.design);
    judgement.answer = row.slot("answer", study.design);
    return;
  }
  bool is_right = false;  // with the right one taken to be in the first slot
  if (form == AnswerForm::preferred) {
    const std::string name = row.needed("preferred");
    if (name != study.samples[judgement.pair[0]] && name != study.samples[judgement.pair[1]]) {
      row.refuse("'{}' was preferred, which is neither '{}' nor '{}'", name, study.samples[judgement.pair[0]],
                 study.samples[judgement.pair[1]]);
    }
    is_right = name == study.samples[judgement.pair[1]];
  } else if (form == AnswerForm::comparison) {
    is_right = row.yes("comparison");
  } else {
    is_right = row.yes("correct");
    if (study.scale.two_sided()) {
      if (judgement.level == 0.0)
        row.refuse("no answer is right at level 0; say in a column 'comparison' whether it was named");
      is_right = is_right == (judgement.level > 0.0);
    }
  }
  judgement.answer = is_right ? 0 : 1;
}

Judgement read_row(const AnswerText& text, const AnswerRow& at, AnswerForm form, Study& study) {
  const AnswerReader row(text, at);
  Judgement judgement{.subject = row.needed("subject"),
                      .session = row.whole("number", 1),
                      .tissue = row.field("tissue"),
                      .pair = pair_of(row, text, study),
                      .level = row.number("level"),
                      .response_s = row.number("response_s"),
                      .switches = row.whole("switches", 0),
                      .practice = !row.field("practice").empty() && row.yes("practice")};
  if (has_levels(study.design) && std::isnan(judgement.level))
    row.refuse("column 'level' is empty; the design '{}' needs one", name_of(study.design));
  read_answer(row, form, study, judgement);
  return judgement;
}

/// The levels that were shown, which also say whether they lie on both sides of the standard.
void take_levels(const AnswerText& text, Study& study) {
  if (!has_levels(study.design)) return;
  for (const AnswerRow& row : text.rows) {
    const double level = AnswerReader(text, row).number("level");
    if (!std::isnan(level)) study.scale.levels.push_back(level);
  }
  std::vector<double>& levels = study.scale.levels;
  std::sort(levels.begin(), levels.end());
  if (study.design == Design::quest_plus && !levels.empty() && levels.front() > 0.0)
    study.scale.expected_jnd = levels[levels.size() / 2];
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
}

}  // namespace

Design design_named(std::string_view name) {
  std::string all;
  for (const Design design : designs) {
    if (name_of(design) == name) return design;
    all += fmt::format("{}{}", all.empty() ? "" : ", ", name_of(design));
  }
  throw std::invalid_argument(fmt::format("design '{}' is not known; expected one of {}", name, all));
}

Study parse_answers(std::string_view content, const std::string& name, std::optional<Design> design) {
  const AnswerText text = split_answers(content, name);
  Study study{.name = text.remark("name"), .design = design_of(text, design)};
  if (study.name.empty()) study.name = std::filesystem::path(name).stem().string();
  const AnswerForm form = form_of(text, study.design);
  study.slots_known = form == AnswerForm::slots;
  take_levels(text, study);
  if (study.design != Design::preference && !study.scale.two_sided())
    study.task = task_for(text, study.design);
  if (form == AnswerForm::comparison && !study.scale.two_sided())
    text.refuse(text.head_line, "'comparison' is for levels on both sides of 0; expected a column 'correct'");
  name_samples(text, form, study);
  for (const AnswerRow& row : text.rows) study.judgements.push_back(read_row(text, row, form, study));
  return study;
}

Study read_answers(const std::filesystem::path& file, std::optional<Design> design) {
  return parse_answers(read_named_file(file, LargestInput::table), file.string(), design);
}

}  // namespace kerf::bench
