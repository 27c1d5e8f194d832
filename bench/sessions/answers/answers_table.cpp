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

constexpr std::array designs{
    Design::preference, Design::abx,       Design::two_interval, Design::three_interval,
    Design::constant,   Design::staircase, Design::quest_plus,   Design::same_different,
    Design::yes_no,     Design::magnitude, Design::rating};

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
                    ((design == Design::abx || design == Design::same_different) &&
                     (said == "differencing" || said == "independent"));
  if (!fits) {
    text.refuse(text.remarks.at("task").second,
                "task '{}' does not go with the design '{}'; expected oddity with 3ifc, or independent or "
                "differencing with abx and same-different",
                said, name_of(design));
  }
  if (design == Design::abx)
    return {.decision = said == "differencing" ? Decision::abx_differencing : Decision::abx_independent};
  if (design == Design::same_different)
    return {.decision =
                said == "differencing" ? Decision::same_different_differencing : Decision::same_different};
  if (design == Design::yes_no) return {.decision = Decision::yes_no};
  if (said == "oddity") return {.decision = Decision::oddity, .intervals = 3};
  return {.decision = Decision::forced_choice, .intervals = design == Design::three_interval ? 3 : 2};
}

/// How the table says what was answered.
enum class AnswerForm { preferred, slots, correct, comparison, estimate };

AnswerForm form_of(const AnswerText& text, Design design) {
  if (!text.column("subject")) {
    text.refuse(text.head_line, "no column 'subject' among {}; expected one such as subject,tissue,preferred",
                fmt::join(text.head, ","));
  }
  if (asks_numbers(design)) {
    for (const char* const needed : {"second", "estimate"}) {
      if (!text.column(needed))
        text.refuse(text.head_line, "no column '{}', which the design '{}' needs", needed, name_of(design));
    }
    return AnswerForm::estimate;
  }
  if (has_levels(design) && !text.column("level"))
    text.refuse(text.head_line, "no column 'level', which the design '{}' needs", name_of(design));
  if (text.column("right") && text.column("answer")) return AnswerForm::slots;
  if (has_two_rates(design))
    text.refuse(text.head_line, "no columns 'right' and 'answer', which the design '{}' needs, such as {},{}",
                name_of(design), answer_label_of(design, 0), answer_label_of(design, 1));
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
  if (asks_numbers(study.design)) {
    const std::size_t sample = sample_named(study, row.needed("second"));
    const std::string standard = row.field("first");
    return {standard.empty() ? sample : sample_named(study, standard), sample};
  }
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
  if (form == AnswerForm::estimate) return;
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

/// A number that the design can have; nothing of a trial that was taken back.
void read_estimate(const AnswerReader& row, const Study& study, Judgement& judgement) {
  const bool is_taken_back = !row.field("void").empty() && row.field("estimate").empty();
  judgement.intensity = row.number("intensity");
  if (std::isnan(judgement.intensity)) judgement.intensity = 1.0 + judgement.level;  // NaN of no level
  if (is_taken_back) {
    judgement.answer = no_answer;
    return;
  }
  judgement.estimate = row.number("estimate");
  const bool is_magnitude = study.design == Design::magnitude;
  const std::size_t points = study.numbers.points;
  const double upper = is_magnitude ? largest_magnitude
                       : points > 0 ? static_cast<double>(points)
                                    : largest_rating;
  const double lower = is_magnitude ? least_magnitude : points > 0 ? 1.0 : 0.0;
  if (!(judgement.estimate >= lower && judgement.estimate <= upper))
    row.refuse("'estimate' is '{}', expected a number {}", row.field("estimate"),
               is_magnitude ? std::string("above 0") : fmt::format("from {:g} to {:g}", lower, upper));
}

void read_answer(const AnswerReader& row, AnswerForm form, Study& study, Judgement& judgement) {
  if (form == AnswerForm::estimate) return read_estimate(row, study, judgement);
  if (form == AnswerForm::slots) {
    judgement.right = row.slot("right", study.design);
    const bool is_taken_back = !row.field("void").empty() && row.field("answer").empty();
    judgement.answer = is_taken_back ? no_answer : row.slot("answer", study.design);
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

/// From 0; the column counts from 1.
std::size_t track_of(const AnswerReader& row) {
  const std::size_t track = row.whole("track", 1);
  if (track == 0) row.refuse("'track' is 0, expected a number from 1");
  return track - 1;
}

Judgement read_row(const AnswerText& text, const AnswerRow& at, AnswerForm form, Study& study) {
  const AnswerReader row(text, at);
  Judgement judgement{.subject = row.needed("subject"),
                      .session = row.whole("number", 1),
                      .tissue = row.field("tissue"),
                      .pair = pair_of(row, text, study),
                      .level = row.number("level"),
                      .track = track_of(row),
                      .confidence = row.whole("confidence", 0),
                      .response_s = row.number("response_s"),
                      .switches = row.whole("switches", 0),
                      .practice = !row.field("practice").empty() && row.yes("practice"),
                      .is_catch = !row.field("catch").empty() && row.yes("catch")};
  if (has_levels(study.design) && std::isnan(judgement.level))
    row.refuse("column 'level' is empty; the design '{}' needs one", name_of(study.design));
  read_answer(row, form, study, judgement);
  try {
    judgement.void_reasons = void_reasons_in(row.field("void"));
  } catch (const std::invalid_argument& error) {
    row.refuse("column 'void': {}", error.what());
  }
  return judgement;
}

/// Of numbers: the standard's, and how many steps a rating has; 0: there is none.
void read_number_remarks(const AnswerText& text, Study& study) {
  const auto number = [&](const char* key, double lower, double upper) {
    const std::string said = text.remark(key);
    if (said.empty()) return 0.0;
    char* end = nullptr;
    const double value = std::strtod(said.c_str(), &end);
    if (*end != '\0' || !(value >= lower && value <= upper))
      text.refuse(text.remarks.at(key).second, "{} is '{}', expected a number from {:g} to {:g}", key, said,
                  lower, upper);
    return value;
  };
  if (study.design == Design::magnitude) study.numbers.modulus = number("modulus", 1e-3, 1e6);
  if (study.design == Design::rating)
    study.numbers.points = static_cast<std::size_t>(number("points", 3.0, 9.0));
}

/// The width of an interval by which QUEST+ ended; 0: it did not.
double until_of(const AnswerText& text) {
  const std::string said = text.remark("until");
  if (said.empty()) return 0.0;
  char* end = nullptr;
  const double ratio = std::strtod(said.c_str(), &end);
  if (*end != '\0' || !(ratio > 1.0 && std::isfinite(ratio)))
    text.refuse(
        text.remarks.at("until").second,
        "until is '{}', expected upper over lower end of the interval by which QUEST+ ended, such as 2",
        said);
  return ratio;
}

/// Levels in a table whose design knows none.
void remark_idle_levels(Study& study) {
  const auto has_level = [](const Judgement& one) { return !one.is_catch && !std::isnan(one.level); };
  if (has_levels(study.design) || std::ranges::none_of(study.judgements, has_level)) return;
  study.remarks.push_back(fmt::format(
      "the column 'level' is not looked at, since the design '{}' has none: with # design = \"constant\" a "
      "psychometric function of two intervals is fitted to it, and a JND is told",
      name_of(study.design)));
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
  if (study.design == Design::quest_plus) study.scale.quest.narrow = until_of(text);
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
  read_number_remarks(text, study);
  if (study.design != Design::preference && !asks_numbers(study.design) && !study.scale.two_sided())
    study.task = task_for(text, study.design);
  if (form == AnswerForm::comparison && !study.scale.two_sided())
    text.refuse(text.head_line, "'comparison' is for levels on both sides of 0; expected a column 'correct'");
  name_samples(text, form, study);
  for (const AnswerRow& row : text.rows) study.judgements.push_back(read_row(text, row, form, study));
  for (const Judgement& each : study.judgements)
    study.confidence_levels = std::max(study.confidence_levels, each.confidence);
  remark_idle_levels(study);
  return study;
}

Study read_answers(const std::filesystem::path& file, std::optional<Design> design) {
  return parse_answers(read_named_file(file, LargestInput::table), file.string(), design);
}

}  // namespace kerf::bench
