#include "session/sensation.h"

#include <gtest/gtest.h>

#include "bench/session/simulated_protocols.h"

namespace kerf::bench {
namespace {

const std::string abx = "design = \"abx\"\ntrials = 4\n";
constexpr double none = std::numeric_limits<double>::quiet_NaN();

TEST(Sensation, FindsNoDifferenceBetweenTwoOfTheSame) {
  const Protocol protocol = simulated_protocol(abx + two_springs(8, 8));
  EXPECT_EQ(Sensation(protocol, {}, {}).jnds({0, 1}, none), 0.0);
}

TEST(Sensation, FindsTheFurtherApartTheMoreLawsDiffer) {
  const Observer observer;
  const auto apart = [&](double stiffness) {
    return Sensation(simulated_protocol(abx + two_springs(8, stiffness)), observer, {}).jnds({0, 1}, none);
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
  EXPECT_NEAR(by_strength.jnds({0, 0}, 0.07), 1.0, 1e-9);
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
  const Sensation soft(two_levels(2), observer, {});
  EXPECT_EQ(soft.samples()[0].limited_share, 0.0);
  const Sensation clipped(two_levels(60), observer,
                          {.felt = {.device_uri = "sim:scissors?close=-20deg&grip=3000N/m"}});
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
  const Sensation sensation(both, observer, {});
  EXPECT_LT(sensation.jnds({0, 0}, -0.2), -0.5);
  EXPECT_GT(sensation.jnds({0, 0}, 0.2), 0.5);
  EXPECT_EQ(sensation.jnds({0, 0}, 0.0), 0.0);
}

TEST(Sensation, TakesTheFirstSimulatedDeviceThatFitsAndElseAsksForAMotion) {
  Protocol protocol = simulated_protocol(abx + two_springs(8, 9));
  protocol.device_uri.clear();
  EXPECT_EQ(Sensation(protocol, {}, {}).device_uri(), "sim:scissors");
  protocol.device_uri = "falcon:0";
  EXPECT_EQ(Sensation(protocol, {}, {}).device_uri(), "");  // along the motion, without limits
  protocol.motion.reset();
  EXPECT_THROW(Sensation(protocol, {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
