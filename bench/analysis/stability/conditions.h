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

inline constexpr std::array plane_conditions{
    Condition{
        "lines.viscous", "necessary and sufficient",
        "for passivity of the spring by viscous friction alone; a delay by a share of a period: necessary, "
        "sufficient if the share counts as a whole one"},
    Condition{
        "lines.coulomb", "necessary",
        "for rest wherever a hand leans; with lines.viscous necessary and sufficient for passivity without "
        "delay (Abbott and Okamura)"},
    Condition{"balance_of_far_swings", "neither necessary nor sufficient",
              "for stability: the energy of one sinusoidal swing"},
    Condition{"behaviour", "necessary", "for stability: two trials in the hand that was given"}};

inline constexpr std::array several_conditions{
    Condition{"eigenvalues", "necessary and sufficient",
              "for stability of the linear, two-sided wall in that hand"},
    Condition{"simulated", "necessary and sufficient", "for the same, by motions from everywhere"},
    Condition{"sufficient", "sufficient", "for stability in that hand, turning or not"},
    Condition{"passive", "sufficient", "for passivity, and for stability in any passive hand"},
    Condition{"one_axis", "neither necessary nor sufficient",
              "for stability of several axes: the others are left free"}};

inline constexpr std::array z_width_conditions{
    Condition{
        "K", "necessary",
        "for passivity: what has a limit cycle in one hand is not passive, and not every hand was tried; for "
        "stability in this hand as far as it was struck"},
    Condition{
        "model", "necessary and sufficient",
        "for stability of the model in the hand that it has, where it is linear; by simulation necessary"},
    Condition{"passive", "necessary and sufficient",
              "for passivity of the linear wall on the model; sufficient for stability in any passive hand"}};

inline constexpr std::array controller_conditions{
    Condition{
        "K_held", "necessary",
        "for stability in this hand, as far as it was struck, and for passivity; every other hand would "
        "have to be tried"},
    Condition{"eigenvalues", "necessary and sufficient",
              "for stability of a linear controller on the model in the hand that it has, without Coulomb "
              "friction and encoder steps"},
    Condition{"passive", "necessary and sufficient",
              "for passivity of the same; sufficient for stability in any passive hand"}};

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
