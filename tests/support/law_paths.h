#pragma once

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include <kerf/models/law.h>

namespace kerf::test {

/// Places of a tool for the example of a law (example_laws.h): the position of each of its axes, for a
/// scalar law its penetration.
struct LawPath {
  models::AxisValues outside;  ///< before contact
  models::AxisValues pressed;  ///< in contact, before anything has given way
  models::AxisValues deeper;   ///< a little further, likewise
  models::AxisValues cut;      ///< in the middle of what the law cuts
  models::AxisValues reach;    ///< as far from there as a hand gets during a stall
};

inline LawPath path_of(std::string_view model) {
  const auto along = [](double outside, double pressed, double deeper, double cut, double reach) {
    return LawPath{{outside}, {pressed}, {deeper}, {cut}, {reach}};
  };
  static const std::map<std::string, LawPath, std::less<>> own{
      {"fracture", along(-0.002, 0.01, 0.02, 0.085, 0.12)},
      {"fuzzy_rupture", along(-0.002, 0.002, 0.003, 0.006, 0.03)},
      {"fuzzy_kelvin", along(-0.002, 0.001, 0.0012, 0.01, 0.06)},
      {"precontact", along(-0.02, -0.002, 0.002, 0.01, 0.03)},
      {"fuzzy_kelvin_3d",
       {{0.0, 0.0, 0.002},
        {0.0, 0.0, -0.003},
        {3e-4, 3e-4, -0.003},
        {0.01, 0.001, -0.005},
        {0.06, 0.01, -0.01}}},
      {"blade",
       {{0.0, 0.0, 0.115},
        {0.0, 0.0, 0.1},
        {0.0, 1e-4, 0.1},
        {0.0, 0.004, 0.098, 0.0, 0.0, 0.05},
        {0.02, 0.03, 0.09, 0.1, 0.1, 0.2}}},
      {"scissors", {{0.6, 0.0}, {0.12, 0.0055}, {0.12, 0.006}, {0.1, 0.01}, {0.08, 0.04}}},
      {"scissors_mesh", {{0.6, 0.0}, {0.35, 0.0085}, {0.35, 0.009}, {0.18, 0.0}, {0.13, 0.001}}},
      {"orthogonal",
       {{0.0, 0.2, 0.0}, {0.0, 0.1, 0.0}, {0.02, 0.09, 0.0}, {0.0, 0.05, 0.05}, {0.1, 0.0, 0.1}}}};
  const auto found = own.find(model);
  if (found != own.end()) return found->second;
  if (models::Law::axes(model).empty()) return along(-0.02, 0.1, 0.12, 0.3, 0.38);
  throw std::logic_error("no path for the law " + std::string(model));
}

/// Between two places, `share` of the way.
inline models::AxisValues between(const models::AxisValues& from, const models::AxisValues& to,
                                  double share) {
  models::AxisValues at{};
  for (std::size_t axis = 0; axis < at.size(); ++axis) {
    at[axis] = from[axis] + share * (to[axis] - from[axis]);
  }
  return at;
}

/// One tick of a law of either kind; of a scalar one along the first axis, its force there.
inline models::SpatialResponse tick_of(const models::Law& law, models::Law::State& state,
                                       const models::SpatialMotion& motion, double period_s) {
  if (law.is_spatial()) return law.step(state, motion, period_s);
  const models::Response response =
      law.step(state, models::Motion{motion.position[0], motion.velocity[0]}, period_s);
  return {.force = {response.force}, .fault = response.fault};
}

}  // namespace kerf::test
