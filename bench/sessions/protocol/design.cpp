#include <stdexcept>

#include <fmt/core.h>

#include "protocol/protocol.h"

namespace kerf::bench {

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
  }
  return "unknown";
}

bool is_adaptive(Design design) noexcept {
  return design == Design::staircase || design == Design::quest_plus;
}

bool has_levels(Design design) noexcept { return design == Design::constant || is_adaptive(design); }

std::size_t slots_of(Design design) noexcept {
  return design == Design::abx || design == Design::three_interval ? 3 : 2;
}

std::string_view label_of(Design design, std::size_t slot) noexcept {
  static constexpr std::array<std::string_view, 3> letters{"A", "B", "X"};
  static constexpr std::array<std::string_view, 3> numbers{"1", "2", "3"};
  if (slot >= slots_of(design)) return "";
  return design == Design::preference || design == Design::abx ? letters[slot] : numbers[slot];
}

std::size_t answers_of(Design design) noexcept { return design == Design::three_interval ? 3 : 2; }

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
    case Design::preference:
      break;
  }
  throw std::invalid_argument(
      fmt::format("'{}' asks for preferences: no answer is right, so there is no d'", protocol.name));
}

std::vector<std::array<std::size_t, 2>> pairs_of(const Protocol& protocol, std::size_t tissue) {
  if (has_levels(protocol.design)) return {{protocol.scale.standard, protocol.scale.standard}};
  const std::vector<std::size_t>& samples = protocol.tissues.at(tissue).samples;
  std::vector<std::array<std::size_t, 2>> pairs;
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
