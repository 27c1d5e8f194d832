#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/law.h>

#include "support/example_laws.h"
#include "support/law_paths.h"
#include "support/wander.h"

namespace kerf::models {
namespace {

using test::tick_of;
using test::Wander;
using test::WanderRange;

/// A law, and where a tool wanders in it: across all that the law knows, contact and its loss included.
struct Roamed {
  std::string name;
  Law law;
  WanderRange range;
  double lever = 1.0;  ///< of the first axis, where its force acts at one [m]
  unsigned paths = 40;
};

void PrintTo(const Roamed& of, std::ostream* out) { *out << of.name; }

Law example_with(std::string_view model, const Options& changes) {
  const Law law = test::example(model);
  Options options = law.options();
  for (const auto& [name, value] : changes) options[name] = value;
  return Law::make(model, law.values(), options);
}

constexpr double handle_m = 0.28 / 7.58;
const WanderRange into_a_scissors_law{{-0.02}, {-0.02}, {0.35}};

Law liver_that_stiffens(const std::string& form) {
  return Law::make(
      "fuzzy_kelvin_3d",
      std::vector{8.0, 8.0, 8.0, 7.0, 7.0, 7.0, 130.0, 130.0, 130.0, 0.0, 0.02, 0.0, 0.1, 0.0, 0.0, 100.0},
      {{"memberships", 1.0}, {"stiffening", 100.0}, {"form", form}});
}
/// One that never gives way, and whose friction does not hide what its hold gives.
Law holding_blade(const Options& options) {
  return Law::make("blade", std::vector{0.0, 0.0, 0.0, 100.0, 1e6, 3e5, 1e3, 2e3}, options);
}

Law mesh_with_a_strip_of(double stiffness_n_per_m) {
  const Law law = example_with("scissors_mesh", {{"edge", 0.02}});
  std::vector<double> values = law.values();
  const auto parameters = law.parameters();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (parameters[i].name == "cutting_stiffness") values[i] = stiffness_n_per_m;
  }
  return Law::make("scissors_mesh", values, law.options());
}

const WanderRange over_liver{{0.0, 0.0, 2e-3}, {-0.01, -0.01, 2e-3}, {0.01, 0.01, -0.02}};
const WanderRange through_a_surface{
    {0.0, 0.0, 0.125}, {-4e-4, -4e-4, 0.115, -2e-3, -2e-3, -2e-3}, {4e-4, 4e-4, 0.095, 2e-3, 2e-3, 2e-3}};
const WanderRange while_turning{
    {0.0, 0.0, 0.15}, {-4e-3, -4e-3, 0.115, -0.3, -0.3, -0.3}, {4e-3, 4e-3, 0.095, 0.3, 0.3, 0.3}};
const WanderRange of_scissors{{0.6, 0.0}, {0.6, -0.002}, {0.1, 0.02}};
const WanderRange of_a_premium{{0.0, 0.3, 0.0}, {-0.1, 0.3, -0.1}, {0.1, 0.0, 0.1}};

std::vector<Roamed> passive_laws() {
  const auto in_depth = [](double outside, double deepest) {
    return WanderRange{{outside}, {outside}, {deepest}};
  };
  return {
      {"kelvin", Law::make("kelvin", std::vector{400.0, 300.0, 15.0}), in_depth(-2e-3, 0.03)},
      {"maxwell", Law::make("maxwell", std::vector{8.0, 300.0, 20.0, 7.0, 0.003, 0.1, 2.0}, {{"arms", 3.0}}),
       in_depth(-2e-3, 0.03)},
      {"springpot", Law::make("springpot", std::vector{8.0, 20.0, 0.3}), in_depth(-2e-3, 0.03)},
      {"exponential", Law::make("exponential", std::vector{0.02, 3.0, 0.4}, {{"thickness", 0.03}}),
       in_depth(-2e-3, 0.03)},
      {"hunt_crossley", Law::make("hunt_crossley", std::vector{0.5, 0.4, 1.5}), in_depth(-2e-3, 0.03)},
      {"friction", Law::make("friction", std::vector{0.0, 20.0, 0.3, 0.8, 5e-4}), {{0.0}, {-0.02}, {0.02}}},
      {"piecewise", test::example("piecewise"), into_a_scissors_law},
      {"recording", test::example("recording"), into_a_scissors_law},
      {"scissors_analytic", test::example("scissors_analytic"), into_a_scissors_law},
      {"precontact", Law::make("precontact", std::vector{300.0, 0.002}), in_depth(-5e-3, 0.03)},
      {"fracture", test::example("fracture"), in_depth(-2e-3, 0.12)},
      {"fracture_with_hysteresis", example_with("fracture", {{"hysteresis", 0.01}}), in_depth(-2e-3, 0.12)},
      {"fuzzy_kelvin", test::example("fuzzy_kelvin"), in_depth(-2e-3, 0.03)},
      {"fuzzy_kelvin_3d", liver_that_stiffens("passive"), over_liver},
      {"fuzzy_kelvin_3d_that_ruptures", test::example("fuzzy_kelvin_3d"), over_liver},
      {"blade", holding_blade({}), through_a_surface},
      {"blade_that_turns", holding_blade({}), while_turning},
      {"blade_of_strips", holding_blade({{"fidelity", std::string("strips")}}), through_a_surface},
      {"blade_that_tears", test::example("blade"), through_a_surface},
      {"scissors", test::example("scissors"), of_scissors, handle_m},
      {"scissors_mesh", example_with("scissors_mesh", {{"edge", 0.02}}), of_scissors, handle_m, 3},
      {"orthogonal", example_with("orthogonal", {{"compensate", false}}), of_a_premium},
  };
}

/// Each for the reason that its docstring gives.
std::vector<Roamed> laws_that_give() {
  return {
      {"fuzzy_rupture",
       Law::make("fuzzy_rupture", std::vector{0.0, 0.02, 0.0, 0.1, 0.0, 1.0, 0.0}, {{"memberships", 1.0}}),
       {{-1e-3}, {-1e-3}, {0.014}}},
      {"fuzzy_kelvin_3d", liver_that_stiffens("paper"), over_liver},
      {"blade", holding_blade({{"form", std::string("paper")}}), through_a_surface},
      {"blade_of_the_papers_strips", holding_blade({{"fidelity", std::string("paper")}}), while_turning},
      {"scissors_without_friction", Law::make("scissors", std::vector{0.0, 0.0, 0.0, 1000.0, 100.0}),
       of_scissors, handle_m},
      {"scissors_mesh_with_a_soft_strip", mesh_with_a_strip_of(1.0), of_scissors, handle_m, 10},
      {"orthogonal_without_damping",
       Law::make(
           "orthogonal", std::vector{0.1, 5.0, 0.0, 0.0},
           {{"compensate", false}, {"surface", std::string("sphere")}, {"point", std::string("0 -0.02 0")}}),
       of_a_premium},
  };
}

struct Energy {
  double least = 0.0;     ///< lowest that the energy taken in ever fell [J]
  double turnover = 0.0;  ///< sum of what went in and out [J]

  [[nodiscard]] double given() const { return -least / (turnover + 1e-9); }
};

/// Energy that a law takes in along a path, from the forces at both ends of each tick.
Energy along(const Roamed& of, const Wander& path) {
  constexpr double period_s = 5e-4;
  auto state = of.law.initial_state();
  SpatialMotion before = path.at(0.0);
  AxisValues force = tick_of(of.law, state, before, period_s).force;
  Energy energy;
  double sum = 0.0;
  for (int tick = 1; tick * period_s <= Wander::duration_s; ++tick) {
    const SpatialMotion now = path.at(tick * period_s);
    const SpatialResponse response = tick_of(of.law, state, now, period_s);
    EXPECT_FALSE(response.fault);
    for (std::size_t axis = 0; axis < max_law_axes; ++axis) {
      // A scalar force resists its penetration, a spatial one pushes its position up.
      const double lever = (axis == 0 ? of.lever : 1.0) * (of.law.is_spatial() ? -1.0 : 1.0);
      const double part =
          0.5 * lever * (force[axis] + response.force[axis]) * (now.position[axis] - before.position[axis]);
      sum += part;
      energy.turnover += std::abs(part);
    }
    energy.least = std::min(energy.least, sum);
    force = response.force;
    before = now;
  }
  return energy;
}

double most_given(const Roamed& of) {
  double most = 0.0;
  for (unsigned seed = 0; seed < of.paths; ++seed)
    most = std::max(most, along(of, Wander(of.range, seed)).given());
  return most;
}

class ClosedPath : public testing::TestWithParam<Roamed> {};
INSTANTIATE_TEST_SUITE_P(Laws, ClosedPath, testing::ValuesIn(passive_laws()),
                         [](const auto& of) { return of.param.name; });

// The trapezoid over a tick in which a force jumps is not the law's own work.
constexpr double trapezoid = 1e-4;

TEST_P(ClosedPath, GivesNoEnergyThatItDidNotTake) {
  EXPECT_LE(most_given(GetParam()), trapezoid) << "share of the turnover that came out and had not gone in";
}

TEST(ClosedPaths, FindTheLawsThatGiveEnergy) {
  for (const Roamed& law : laws_that_give()) EXPECT_GT(most_given(law), 10.0 * trapezoid) << law.name;
}

TEST(ClosedPaths, GoThroughEveryLaw) {
  std::set<std::string_view> roamed;
  for (const auto& laws : {passive_laws(), laws_that_give()}) {
    for (const Roamed& one : laws) roamed.insert(one.law.model());
  }
  for (const LawInfo& law : registry()) EXPECT_TRUE(roamed.contains(law.name)) << law.name;
}

}  // namespace
}  // namespace kerf::models
