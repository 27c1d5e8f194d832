#include "observers/sensation.h"

#include <gtest/gtest.h>

#include "bench/sessions/observers/simulated_protocols.h"

namespace kerf::bench {
namespace {

const std::string abx = "design = \"abx\"\ntrials = 4\n";
const SensationOptions once{.felt = {.renderings = 1}};
constexpr double none = std::numeric_limits<double>::quiet_NaN();

TEST(Sensation, FindsNoDifferenceBetweenTwoOfTheSame) {
  const Protocol protocol = simulated_protocol(abx + two_springs(8, 8));
  EXPECT_EQ(Sensation(protocol, {}, once).jnds({0, 1}, none), 0.0);
}

TEST(Sensation, FindsTheFurtherApartTheMoreLawsDiffer) {
  const Observer observer;
  const auto apart = [&](double stiffness) {
    return Sensation(simulated_protocol(abx + two_springs(8, stiffness)), observer, once).jnds({0, 1}, none);
  };
  EXPECT_GT(apart(8.4), 0.3);
  EXPECT_GT(apart(9.6), 2.0 * apart(8.4));
}

TEST(Sensation, OfOneJndMoreForceThroughoutIsOneJnd) {
  // 0.001 N as the least JND, so that Weber's law holds nearly everywhere on the way.
  const Observer observer{.jnd = 0.07, .least_jnd_n = 0.001};
  const Protocol levels = simulated_protocol(
      "design = \"constant\"\n[[sample]]\nname = \"spring\"\nlaw = \"law 8\"\n"
      "[scale]\nvary = \"force\"\nlevels = [0.07, 0.14]\n");
  const SensationOptions open{.felt = {.open_loop = true}};
  const Sensation by_strength(levels, observer, open);
  EXPECT_NEAR(by_strength.jnds({0, 0}, 0.07), 1.0, 1e-3);
  EXPECT_NEAR(by_strength.jnds({0, 0}, 0.0), 0.0, 1e-12);
  const Sensation by_difference(levels, observer, {.felt = open.felt, .by = ToldBy::difference});
  EXPECT_NEAR(by_difference.jnds({0, 0}, 0.07), 1.0, 0.01);
}

TEST(Sensation, IsOfTheForcesThatTheDeviceGivesAfterItsLimits) {
  // Springs against which the hand of sim:scissors presses with all its force.
  const Observer observer;
  const auto two_levels = [&](int stiffness) {
    return simulated_protocol(fmt::format(
        "design = \"constant\"\n[[sample]]\nname = \"spring\"\nlaw = \"law {}\"\n[scale]\nvary = \"force\"\n"
        "levels = [0.5, 1]\n",
        stiffness));
  };
  const Sensation soft(two_levels(2), observer, once);
  EXPECT_EQ(soft.samples()[0].limited_share, 0.0);
  const Sensation clipped(
      two_levels(60), observer,
      {.felt = {.device_uri = "sim:scissors?close=-20deg&grip=3000N/m", .renderings = 1}});
  EXPECT_GT(clipped.samples()[0].limited_share, 0.1);
  EXPECT_NEAR(clipped.samples()[0].peak_n, 7.58, 0.01);
  EXPECT_LT(clipped.jnds({0, 0}, 1.0), 0.5 * soft.jnds({0, 0}, 1.0));
}

TEST(Sensation, TakesTheDirectionThatTheScaleGrowsIn) {
  // A damper that is stiffer relaxes less: both kinds of question have a right answer.
  const Observer observer;
  const Protocol both = simulated_protocol(
      "design = \"constant\"\n[[sample]]\nname = \"spring\"\nlaw = \"law 8\"\n"
      "[scale]\nvary = [\"parallel_stiffness\"]\nlevels = [-0.2, 0.2]\n");
  const Sensation sensation(both, observer, once);
  EXPECT_LT(sensation.jnds({0, 0}, -0.2), -0.5);
  EXPECT_GT(sensation.jnds({0, 0}, 0.2), 0.5);
  EXPECT_EQ(sensation.jnds({0, 0}, 0.0), 0.0);
}

TEST(Sensation, IsASmoothCurveThroughWhatWasRendered) {
  const Protocol levels = simulated_protocol(
      "design = \"constant\"\n[[sample]]\nname = \"spring\"\nlaw = \"law 8\"\n"
      "[scale]\nvary = \"force\"\nlevels = [0.05, 0.1, 0.3]\n");
  const Observer observer{.least_jnd_n = 0.001};
  const Sensation sensation(levels, observer, {.felt = {.open_loop = true}});
  EXPECT_LT(sensation.scatter(), 0.01);
  EXPECT_NEAR(sensation.jnds({0, 0}, 0.3), std::log(1.3) / std::log(1.07), 0.02);
  EXPECT_NEAR(sensation.jnds({0, 0}, 0.15), std::log(1.15) / std::log(1.07), 0.02);
}

TEST(Sensation, FeelsALawByAsManyRenderingsAsItIsTold) {
  const Protocol protocol = simulated_protocol(abx + two_springs(8, 9));
  const PlayedLaw law = played(protocol, 0, none);
  const std::size_t one = FeltRenderer(protocol, {.renderings = 1}).rendered(law).ticks();
  EXPECT_EQ(FeltRenderer(protocol, {.renderings = 3}).rendered(law).ticks(), 3 * one);
  EXPECT_EQ(FeltRenderer(protocol, {.device_uri = "sim:scissors?seed=5"}).rendered(law).ticks(), one);
  EXPECT_EQ(one, 3500U);  // 4 s without the soft start
}

TEST(Sensation, IsTheOneThatWasWantedWhateverIsRendered) {
  const Protocol protocol = simulated_protocol(abx + two_springs(8, 8));
  const Observer observer;
  const Sensation sensation(protocol, observer, {.felt = once.felt, .d_prime = 1.5});
  EXPECT_NEAR(d_prime_per_jnd(observer) * sensation.jnds({0, 1}, none), 1.5, 1e-12);
}

TEST(Sensation, ByStrengthHasADirectionOnlyWhereTheStrongerOneIsAskedFor) {
  const SensationOptions by_strength{.felt = once.felt, .by = ToldBy::strength};
  const std::string weaker_second = two_springs(9, 8);
  EXPECT_GT(Sensation(simulated_protocol(abx + weaker_second), {}, by_strength).jnds({0, 1}, none), 0.2);
  const Protocol asked = simulated_protocol("design = \"2ifc\"\nsignal = \"second\"\n" + weaker_second);
  EXPECT_LT(Sensation(asked, {}, by_strength).jnds({0, 1}, none), -0.2);
  EXPECT_THROW(Sensation(asked, {}, {.felt = once.felt, .d_prime = -1.0}), std::invalid_argument);
}

TEST(Sensation, TakesTheFirstSimulatedDeviceThatFitsAndElseAsksForAMotion) {
  Protocol protocol = simulated_protocol(abx + two_springs(8, 9));
  protocol.device_uri.clear();
  EXPECT_EQ(Sensation(protocol, {}, once).device_uri(), "sim:scissors");
  protocol.device_uri = "falcon:0";
  EXPECT_EQ(Sensation(protocol, {}, once).device_uri(), "");  // along the motion, without limits
  protocol.motion.reset();
  EXPECT_THROW(Sensation(protocol, {}, once), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
