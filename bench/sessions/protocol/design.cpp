#include <algorithm>
#include <limits>
#include <stdexcept>

#include <fmt/core.h>

#include "protocol/protocol.h"

namespace kerf::bench {
namespace {

/// Of designs whose answers are words.
const std::string& answer_word(const Protocol& protocol, std::size_t answer) {
  const SubjectTexts& texts = *protocol.texts;
  if (protocol.design == Design::same_different)
    return answer == 0 ? texts("answer_same") : texts("answer_different");
  return answer == 0 ? texts("answer_no") : texts("answer_yes");
}

}  // namespace

std::string_view name_of(Design design) noexcept {
  switch (design) {
    case Design::preference:
      return "preference";
    case Design::abx:
      return "abx";
    case Design::two_interval:
      return "2ifc";
    case Design::three_interval:
      return "3ifc";
    case Design::constant:
      return "constant";
    case Design::staircase:
      return "staircase";
    case Design::quest_plus:
      return "quest";
    case Design::same_different:
      return "same-different";
    case Design::yes_no:
      return "yes-no";
    case Design::magnitude:
      return "magnitude";
    case Design::rating:
      return "rating";
  }
  return "unknown";
}

bool is_adaptive(Design design) noexcept {
  return design == Design::staircase || design == Design::quest_plus;
}

bool has_levels(Design design) noexcept { return design == Design::constant || is_adaptive(design); }

bool asks_numbers(Design design) noexcept { return design == Design::magnitude || design == Design::rating; }

bool has_two_rates(Design design) noexcept {
  return design == Design::same_different || design == Design::yes_no;
}

std::size_t slots_of(const Protocol& protocol) noexcept {
  if (protocol.design == Design::magnitude) return protocol.numbers.standard ? 2 : 1;
  return slots_of(protocol.design);
}

std::size_t slots_of(Design design) noexcept {
  if (design == Design::yes_no || design == Design::rating) return 1;
  return design == Design::abx || design == Design::three_interval ? 3 : 2;
}

std::string_view label_of(Design design, std::size_t slot) noexcept {
  static constexpr std::array<std::string_view, 3> letters{"A", "B", "X"};
  static constexpr std::array<std::string_view, 3> numbers{"1", "2", "3"};
  if (slot >= slots_of(design)) return "";
  const bool has_letters = design == Design::preference || design == Design::abx || has_two_rates(design);
  return has_letters ? letters[slot] : numbers[slot];
}

std::string_view answer_label_of(Design design, std::size_t answer) noexcept {
  if (has_two_rates(design) && answer > 1) return "";
  if (design == Design::same_different) return answer == 0 ? "same" : "different";
  if (design == Design::yes_no) return answer == 0 ? "no" : "yes";
  if (asks_numbers(design)) return "";
  return label_of(design, answer);
}

std::size_t choices_of(const Protocol& protocol) noexcept {
  if (asks_numbers(protocol.design)) return std::max<std::size_t>(1, protocol.numbers.points);
  return answers_of(protocol.design) * std::max<std::size_t>(1, protocol.confidence.size());
}

std::optional<NumberRange> written_numbers_of(const Protocol& protocol) noexcept {
  if (protocol.design == Design::magnitude) return NumberRange{least_magnitude, largest_magnitude};
  if (protocol.design == Design::rating && protocol.numbers.points == 0)
    return NumberRange{0.0, largest_rating};
  return std::nullopt;
}

double number_of_answer(const Protocol& protocol, std::size_t choice, double written) noexcept {
  if (!asks_numbers(protocol.design) || choice >= choices_of(protocol))
    return std::numeric_limits<double>::quiet_NaN();
  return written_numbers_of(protocol) ? written : static_cast<double>(choice + 1);
}

std::vector<std::string> choice_labels_of(const Protocol& protocol) {
  std::vector<std::string> labels;
  const NumberScale& numbers = protocol.numbers;
  for (std::size_t step = 1; step <= numbers.points; ++step) {
    labels.push_back(step == 1                ? numbers.ends[0]
                     : step == numbers.points ? numbers.ends[1]
                                              : fmt::format("{}", step));
  }
  if (!has_two_rates(protocol.design)) return labels;
  for (std::size_t choice = 0; choice < choices_of(protocol); ++choice) {
    const std::size_t sure = confidence_of_choice(protocol, choice);
    labels.push_back(answer_word(protocol, answer_of_choice(protocol, choice)));
    if (sure == 0) continue;
    labels.back() = (*protocol.texts)(
        "answer_with_confidence", {{"answer", labels.back()}, {"confidence", protocol.confidence[sure - 1]}});
  }
  return labels;
}

std::string told_answer(const Protocol& protocol, std::size_t answer) {
  if (!has_two_rates(protocol.design)) return std::string(label_of(protocol.design, answer));
  return (*protocol.texts)("quoted", {{"word", answer_word(protocol, answer)}});
}

std::size_t answer_of_choice(const Protocol& protocol, std::size_t choice) noexcept {
  if (protocol.confidence.empty() || choice >= choices_of(protocol)) return choice;
  return choice / protocol.confidence.size();
}

std::size_t confidence_of_choice(const Protocol& protocol, std::size_t choice) noexcept {
  const std::size_t levels = protocol.confidence.size();
  if (choice >= levels * answers_of(protocol.design)) return 0;
  return choice < levels ? levels - choice : choice - levels + 1;
}

std::size_t answers_of(Design design) noexcept { return design == Design::three_interval ? 3 : 2; }

bool ends_by_answers(Design design, const IntensityScale& scale) noexcept {
  return design == Design::staircase || (design == Design::quest_plus && scale.quest.narrow > 0.0);
}

std::vector<psychophysics::StaircaseOptions> IntensityScale::staircases() const {
  std::vector<psychophysics::StaircaseOptions> all{staircase};
  all.insert(all.end(), interleaved.begin(), interleaved.end());
  return all;
}

bool IntensityScale::two_sided() const noexcept {
  bool below = false;
  bool above = false;
  for (const double level : levels) (level < 0.0 ? below : above) = true;
  return below && above;
}

psychophysics::Task task_of(const Protocol& protocol) {
  using psychophysics::Decision;
  switch (protocol.design) {
    case Design::abx:
      return {.decision = protocol.differencing ? Decision::abx_differencing : Decision::abx_independent};
    case Design::three_interval:
      if (protocol.odd_one_out) return {.decision = Decision::oddity};
      return {.decision = Decision::forced_choice, .intervals = 3};
    case Design::two_interval:
      return {.decision = Decision::forced_choice, .intervals = 2};
    case Design::constant:
      if (protocol.scale.two_sided()) {
        throw std::invalid_argument(fmt::format(
            "'{}' has levels on both sides of the standard: no answer is right, so there is no d'; its curve "
            "has a JND",
            protocol.name));
      }
      [[fallthrough]];
    case Design::staircase:
    case Design::quest_plus:
      return {.decision = Decision::forced_choice, .intervals = 2};
    case Design::same_different:
      return {.decision =
                  protocol.differencing ? Decision::same_different_differencing : Decision::same_different};
    case Design::yes_no:
      return {.decision = Decision::yes_no};
    case Design::preference:
      break;
    case Design::magnitude:
    case Design::rating:
      throw std::invalid_argument(
          fmt::format("'{}' asks for numbers: no answer is right, so there is no d'", protocol.name));
  }
  throw std::invalid_argument(
      fmt::format("'{}' asks for preferences: no answer is right, so there is no d'", protocol.name));
}

std::vector<std::array<std::size_t, 2>> pairs_of(const Protocol& protocol, std::size_t tissue) {
  if (has_levels(protocol.design)) return {{protocol.scale.standard, protocol.scale.standard}};
  const std::vector<std::size_t>& samples = protocol.tissues.at(tissue).samples;
  std::vector<std::array<std::size_t, 2>> pairs;
  if (asks_numbers(protocol.design)) {
    for (const std::size_t sample : samples)
      pairs.push_back({protocol.numbers.standard.value_or(sample), sample});
    return pairs;
  }
  if (protocol.signal) {
    for (const std::size_t sample : samples) {
      if (sample != *protocol.signal) pairs.push_back({sample, *protocol.signal});
    }
    return pairs;
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t j = i + 1; j < samples.size(); ++j) pairs.push_back({samples[i], samples[j]});
  }
  return pairs;
}

}  // namespace kerf::bench
