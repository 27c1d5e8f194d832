#include "choose/candidates.h"

#include <algorithm>
#include <array>

#include <fmt/core.h>

#include <kerf/models/law.h>

#include "fits/law_options.h"

namespace kerf::bench {
namespace {

/// Of a law, how many parameters a fit searches: all but those that begin with a name of these.
std::size_t searched(const CandidateLaw& law, const std::vector<std::string>& held) {
  const auto all = models::Law::parameters(law.model, options_of_law(law.model, law.law_options));
  return static_cast<std::size_t>(std::ranges::count_if(all, [&](const models::ParameterInfo& info) {
    return std::ranges::none_of(held, [&](const std::string& name) { return info.name.starts_with(name); });
  }));
}

std::vector<CandidateLaw> plain_laws() {
  using enum Effect;
  std::vector<CandidateLaw> all;
  const auto add = [&](std::string name, std::string model, std::vector<std::string> law_options,
                       Effects effects, const std::vector<std::string>& held = {}) {
    all.push_back({.name = std::move(name),
                   .model = std::move(model),
                   .law_options = std::move(law_options),
                   .effects = std::move(effects)});
    all.back().parameters = searched(all.back(), held);
  };
  add("exponential-elastic", "exponential", {"viscous=false"}, {stiffening});
  add("exponential", "exponential", {}, {stiffening, rate});
  add("exponential-offset", "exponential", {"offset=true"}, {stiffening, rate});
  add("springpot-alone", "springpot", {"spring=false"}, {relaxation, rate});
  add("springpot", "springpot", {}, {relaxation, rate});
  add("kelvin", "kelvin", {}, {relaxation, rate});
  add("hunt_crossley", "hunt_crossley", {}, {stiffening, rate});
  add("friction", "friction", {}, {loop, rate});
  add("precontact", "precontact", {}, {stiffening});
  add("scissors_analytic", "scissors_analytic", {}, {loop, cutting, stiffening});
  add("fuzzy_rupture", "fuzzy_rupture", {"memberships=2"}, {stiffening, rate});
  // Of a row of ruptures at one depth the threshold is a line over the speed.
  add("fuzzy_kelvin", "fuzzy_kelvin", {"memberships=1"}, {relaxation, rate, cutting},
      {"depth_", "speed_", "per_depth"});
  // Only the product of toughness and width is felt.
  add("fracture", "fracture", {}, {stiffening, cutting}, {"width"});
  return all;
}

CandidateLaw maxwell(std::size_t arms) {
  return {.name = fmt::format("maxwell-{}", arms),
          .model = "maxwell",
          .law_options = {fmt::format("arms={}", arms)},
          .parameters = 1 + 2 * arms,
          .effects = {Effect::relaxation, Effect::rate}};
}

/// The outer knots are the ends of the data and not fitted.
CandidateLaw piecewise(std::size_t segments, bool loop) {
  Effects effects;
  if (segments > 1) effects.insert(Effect::stiffening);
  if (loop) effects.insert(Effect::loop);
  return {.name = fmt::format("piecewise-{}{}", segments, loop ? "-loop" : ""),
          .model = "piecewise",
          .law_options = {fmt::format("segments={}", segments), fmt::format("loop={}", loop)},
          .parameters = segments - 1 + (loop ? 2 : 1) * (segments + 1),
          .effects = effects};
}

CandidateLaw table(bool loop) {
  constexpr std::size_t points = 101;
  Effects effects{Effect::stiffening};
  if (loop) effects.insert(Effect::loop);
  return {.name = loop ? "recording-loop" : "recording",
          .model = "recording",
          .law_options = {fmt::format("points={}", points), fmt::format("loop={}", loop)},
          .parameters = (loop ? 2 : 1) * points,
          .effects = effects};
}

bool units_fit(const CandidateLaw& law, const schema::Axis& axis) {
  const models::LawInfo info = models::law_info(law.model);
  return info.position_unit.empty() ||
         (info.position_unit == axis.position_unit && info.force_unit == axis.force_unit);
}

}  // namespace

std::string_view name_of(Effect effect) noexcept {
  constexpr std::array<std::string_view, 6> names{"rotation", "loop", "relaxation",
                                                  "cutting",  "rate", "stiffening"};
  return names[static_cast<std::size_t>(effect)];
}

std::vector<CandidateLaw> candidates_for(const schema::Axis& axis, bool has_cycles,
                                         const CandidateOptions& options) {
  std::vector<CandidateLaw> all = plain_laws();
  for (std::size_t arms = 2; arms <= options.max_arms; ++arms) all.push_back(maxwell(arms));
  for (const bool loop : {false, true}) {
    if (loop && !has_cycles) continue;
    for (std::size_t segments = 1; segments <= options.max_segments; ++segments)
      all.push_back(piecewise(segments, loop));
    all.push_back(table(loop));
  }
  std::erase_if(all, [&](const CandidateLaw& law) { return !units_fit(law, axis); });
  std::ranges::stable_sort(all, {}, &CandidateLaw::parameters);
  return all;
}

}  // namespace kerf::bench
