#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace kerf::bench {

/// What a verdict of a study proves: that it is necessary for what it speaks of means that failing it is
/// proof, that it is sufficient means that meeting it is.
struct Condition {
  const char* verdict;  ///< as the JSON of the study names it
  const char* kind;
  const char* of;
};

inline constexpr std::array wall_conditions{
    Condition{"simulated", "necessary", "for stability: one trial in the hand that was given"},
    Condition{"eigenvalues", "necessary and sufficient",
              "for stability of the linear, two-sided wall in that hand"},
    Condition{"passive", "necessary and sufficient",
              "for passivity of the linear wall; sufficient for stability in any passive hand"},
    Condition{"colgate_schenkel", "necessary and sufficient",
              "for the same with the plain difference and without delay"},
    Condition{"abbott_okamura", "necessary and sufficient",
              "for passivity of the wall without damping, with encoder and Coulomb friction"}};

inline constexpr std::array law_conditions{
    Condition{"passive", "necessary",
              "for passivity: one stroke that gains energy disproves it, and not all were tried"},
    Condition{"deepest_by_local_stiffness_m", "neither necessary nor sufficient",
              "for passivity: the balance of small motions about a depth"},
    Condition{"press", "necessary", "for stability: one press in the hand that was given"}};

[[nodiscard]] inline std::vector<std::string> in_words(std::span<const Condition> conditions) {
  std::vector<std::string> lines;
  for (const Condition& one : conditions)
    lines.push_back(fmt::format("'{}' is {} {}", one.verdict, one.kind, one.of));
  return lines;
}

[[nodiscard]] inline nlohmann::ordered_json to_json(std::span<const Condition> conditions) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Condition& one : conditions) json[one.verdict] = {{"is", one.kind}, {"what", one.of}};
  return json;
}

}  // namespace kerf::bench
