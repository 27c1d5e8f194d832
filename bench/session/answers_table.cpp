#include "session/answers_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>

#include "files/whole_file.h"
#include "import/decimal.h"
#include "import/text_layout.h"

namespace kerf::bench {
namespace {

constexpr std::array designs{Design::preference,     Design::abx,      Design::two_interval,
                             Design::three_interval, Design::constant, Design::staircase,
                             Design::quest_plus};

struct TextRow {
  std::size_t line = 0;
  std::vector<std::string> fields;
};

/// Head, rows and the remarks of comment lines.
struct AnswerText {
  std::string file;
  std::size_t head_line = 0;
  std::vector<std::string> head;
  std::vector<TextRow> rows;
  std::map<std::string, std::pair<std::string, std::size_t>> remarks;  ///< value and line

  template <typename... Arguments>
  [[noreturn]] void refuse(std::size_t line, fmt::format_string<Arguments...> text,
                           Arguments&&... arguments) const {
    throw std::invalid_argument(
        fmt::format("{}:{}: {}", file, line, fmt::format(text, std::forward<Arguments>(arguments)...)));
  }

  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const {
    const auto found = std::find(head.begin(), head.end(), name);
    if (found == head.end()) return std::nullopt;
    return static_cast<std::size_t>(found - head.begin());
  }

  [[nodiscard]] std::string remark(const char* key) const {
    const auto found = remarks.find(key);
    return found == remarks.end() ? std::string() : found->second.first;
  }
};

/// `key = "value"` after the #.
void take_remark(std::string_view line, std::size_t number, AnswerText& text) {
  const auto equals = line.find('=');
  if (equals == std::string_view::npos) return;
  const auto trimmed = [](std::string_view part) {
    const auto begin = part.find_first_not_of(" \t#\"");
    if (begin == std::string_view::npos) return std::string();
    return std::string(part.substr(begin, part.find_last_not_of(" \t\"") - begin + 1));
  };
  const std::string key = trimmed(line.substr(0, equals));
  if (key == "design" || key == "task" || key == "name")
    text.remarks[key] = {trimmed(line.substr(equals + 1)), number};
}

char separator_of(std::string_view head) {
  for (const char separator : {'\t', ';'}) {
    if (head.find(separator) != std::string_view::npos) return separator;
  }
  return ',';
}

AnswerText split(std::string_view content, const std::string& file) {
  AnswerText text{.file = file};
  if (content.find('\0') != std::string_view::npos)
    text.refuse(1, "a binary file; expected a table of answers as text");
  if (content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
  char separator = ',';
  for (std::size_t number = 1; !content.empty(); ++number) {
    const std::string_view line = take_line(content);
    const auto first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos) continue;
    if (line[first] == '#') {
      take_remark(line.substr(first), number, text);
      continue;
    }
    if (text.head.empty()) separator = separator_of(line);
    std::vector<std::string> fields;
    for (const std::string_view field : split_line(line, separator)) fields.push_back(to_utf8(field));
    if (text.head.empty()) {
      text.head_line = number;
      text.head = std::move(fields);
      continue;
    }
    if (fields.size() != text.head.size()) {
      text.refuse(number, "{} fields, expected {} as in the first line ({})", fields.size(), text.head.size(),
                  fmt::join(text.head, ","));
    }
    text.rows.push_back({.line = number, .fields = std::move(fields)});
  }
  if (text.head.empty())
    text.refuse(1, "no line of column names; expected one such as subject,tissue,preferred");
  for (const std::string& name : text.head) {
    if (std::count(text.head.begin(), text.head.end(), name) > 1)
      text.refuse(text.head_line, "column '{}' is there twice", name);
  }
  return text;
}

/// One field of a row; empty where the table has no such column.
class RowReader {
 public:
  RowReader(const AnswerText& text, const TextRow& row) : text_(text), row_(row) {}

  [[nodiscard]] std::string field(const char* column) const {
    const auto at = text_.column(column);
    return at ? row_.fields[*at] : std::string();
  }

  [[nodiscard]] std::string needed(const char* column) const {
    std::string value = field(column);
    if (value.empty()) refuse("column '{}' is empty; expected a value", column);
    return value;
  }

  [[nodiscard]] double number(const char* column) const {
    const std::string value = field(column);
    if (value.empty()) return std::numeric_limits<double>::quiet_NaN();
    double result = 0.0;
    const char* end = value.data() + value.size();
    if (parse_decimal(value.data(), end, '.', result) != end || !std::isfinite(result))
      refuse("column '{}' is '{}', expected a number such as 0.1", column, value);
    return result;
  }

  [[nodiscard]] std::size_t whole(const char* column, std::size_t otherwise) const {
    const double value = number(column);
    if (std::isnan(value)) return otherwise;
    if (value < 0.0 || value > 1e9 || value != std::floor(value))
      refuse("column '{}' is {:g}, expected a whole number of 0 or more", column, value);
    return static_cast<std::size_t>(value);
  }

  [[nodiscard]] bool yes(const char* column) const {
    const std::string value = needed(column);
    for (const char* text : {"1", "yes", "true", "right"}) {
      if (value == text) return true;
    }
    for (const char* text : {"0", "no", "false", "wrong"}) {
      if (value == text) return false;
    }
    refuse("column '{}' is '{}', expected 1 or 0 (or yes, no, true, false, right, wrong)", column, value);
  }

  [[nodiscard]] std::size_t slot(const char* column, Design design) const {
    const std::string value = needed(column);
    std::string labels;
    for (std::size_t slot = 0; slot < answers_of(design); ++slot) {
      if (value == label_of(design, slot)) return slot;
      labels += fmt::format("{}{}", slot == 0 ? "" : " or ", label_of(design, slot));
    }
    refuse("column '{}' is '{}', expected {}", column, value, labels);
  }

  template <typename... Arguments>
  [[noreturn]] void refuse(fmt::format_string<Arguments...> text, Arguments&&... arguments) const {
    text_.refuse(row_.line, text, std::forward<Arguments>(arguments)...);
  }

 private:
  const AnswerText& text_;
  const TextRow& row_;
};

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
std::array<std::size_t, 2> pair_of(const RowReader& row, const AnswerText& text, Study& study) {
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
  for (const TextRow& row : text.rows) {
    (void)sample_named(study, RowReader(text, row).needed("preferred"));
    if (study.samples.size() > 2) {
      text.refuse(row.line,
                  "'{}' is a third sample besides '{}' and '{}'; of more than two, columns 'first' "
                  "and 'second' have to say which were compared",
                  study.samples[2], study.samples[0], study.samples[1]);
    }
  }
  if (study.samples.size() == 1) study.samples.emplace_back("the other");
}

void read_answer(const RowReader& row, AnswerForm form, Study& study, Judgement& judgement) {
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

Judgement read_row(const AnswerText& text, const TextRow& at, AnswerForm form, Study& study) {
  const RowReader row(text, at);
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
  for (const TextRow& row : text.rows) {
    const double level = RowReader(text, row).number("level");
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
  const AnswerText text = split(content, name);
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
  for (const TextRow& row : text.rows) study.judgements.push_back(read_row(text, row, form, study));
  return study;
}

Study read_answers(const std::filesystem::path& file, std::optional<Design> design) {
  return parse_answers(read_whole_file(file), file.string(), design);
}

}  // namespace kerf::bench
