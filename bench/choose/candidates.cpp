#include "choose/candidates.h"

#include <algorithm>
#include <array>

#include <fmt/core.h>

#include <kerf/models/law.h>

#include "fits/law_options.h"

namespace kerf::bench {
namespace {

/// Variants with a fixed number of parameters: all of the law's own.
std::vector<CandidateLaw> plain_laws() {
  using enum Effect;
  std::vector<CandidateLaw> all{
      {.name = "exponential-elastic",
       .model = "exponential",
       .law_options = {"viscous=false"},
       .effects = {stiffening}},
      {.name = "exponential", .model = "exponential", .law_options = {}, .effects = {stiffening, rate}},
      {.name = "exponential-offset",
       .model = "exponential",
       .law_options = {"offset=true"},
       .effects = {stiffening, rate}},
      {.name = "springpot-alone",
       .model = "springpot",
       .law_options = {"spring=false"},
       .effects = {relaxation, rate}},
      {.name = "springpot", .model = "springpot", .law_options = {}, .effects = {relaxation, rate}},
      {.name = "kelvin", .model = "kelvin", .law_options = {}, .effects = {relaxation, rate}},
      {.name = "hunt_crossley", .model = "hunt_crossley", .law_options = {}, .effects = {stiffening, rate}},
      {.name = "friction", .model = "friction", .law_options = {}, .effects = {loop, rate}},
      {.name = "precontact", .model = "precontact", .law_options = {}, .effects = {stiffening}},
      {.name = "scissors_analytic",
       .model = "scissors_analytic",
       .law_options = {},
       .effects = {loop, cutting, stiffening}},
      {.name = "fuzzy_rupture", .model = "fuzzy_rupture", .law_options = {}, .effects = {stiffening, rate}},
      {.name = "fuzzy_kelvin",
       .model = "fuzzy_kelvin",
       .law_options = {},
       .effects = {relaxation, rate, cutting}}};
  for (CandidateLaw& law : all) {
    law.parameters = models::Law::parameters(law.model, options_of_law(law.model, law.law_options)).size();
  }
  // Only the product of toughness and width is felt, so that one of them is held.
  all.push_back({.name = "fracture",
                 .model = "fracture",
                 .law_options = {},
                 .parameters = models::Law::parameters("fracture").size() - 1,
                 .effects = {stiffening, cutting}});
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
  for (std::size_t arms = 2; arms <= options.most_arms; ++arms) all.push_back(maxwell(arms));
  for (const bool loop : {false, true}) {
    if (loop && !has_cycles) continue;
    for (std::size_t segments = 1; segments <= options.most_segments; ++segments)
      all.push_back(piecewise(segments, loop));
    all.push_back(table(loop));
  }
  std::erase_if(all, [&](const CandidateLaw& law) { return !units_fit(law, axis); });
  std::ranges::stable_sort(all, {}, &CandidateLaw::parameters);
  return all;
}

}  // namespace kerf::bench
