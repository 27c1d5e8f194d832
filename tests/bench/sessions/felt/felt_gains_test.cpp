#include "felt/felt_gains.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/observers/simulated_protocols.h"
#include "felt/felt_forces.h"
#include "felt/felt_remarks.h"
#include "files/named_file.h"

namespace kerf::bench {
namespace {

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Kelvin against piecewise, whose opening pulls: along the motion nothing tells how the hand gives way.
Protocol kelvin_or_piecewise(const std::string& top) {
  return parse_protocol(
      "name = \"p\"\ndesign = \"abx\"\n" + top +
          "\n[[sample]]\nname = \"kelvin\"\nlaw = \"kelvin\"\n"
          "[[sample]]\nname = \"piecewise\"\nlaw = \"piecewise\"\n"
          "[motion]\nfrom = { value = 32, unit = \"deg\" }\nto = { value = 8, unit = \"deg\" }\n"
          "seconds = { value = 4.2, unit = \"s\" }\n",
      "p.protocol.toml", [](const std::string& name) {
        return read_named_file(KERF_SOURCE_DIR "/examples/" + name + ".law.toml");
      });
}

FeltLevel felt_level_of(const Protocol& protocol, std::size_t sample) {
  const FeltRenderer renderer(protocol, {.device_uri = "sim:scissors"});
  return renderer.rendered(played(protocol, sample, std::numeric_limits<double>::quiet_NaN())).level();
}

const std::string on_scissors = "device = \"sim:scissors\"\n";

TEST(FeltGains, InOpenLoopLeaveSamplesMoreThanAJndApartInTheHand) {
  Protocol protocol = kelvin_or_piecewise(on_scissors + "loudness = \"rms\"");
  EXPECT_THAT(find_gains(protocol), IsEmpty());
  EXPECT_NEAR(protocol.samples[1].gain, 3.65, 0.01);
  EXPECT_EQ(protocol.gain_origin->hand, "");
  const FeltApart apart = felt_apart(felt_level_of(protocol, 0), felt_level_of(protocol, 1));
  EXPECT_NEAR(apart.rms_jnds, 1.2, 0.1);
  EXPECT_NEAR(apart.limited_share, 0.0233, 0.001);
  EXPECT_TRUE(is_strength_apart(apart.rms_jnds));
  EXPECT_TRUE(is_limit_apart(apart));
}

TEST(FeltGains, InClosedLoopMakeThemAlikeInTheHand) {
  for (const char* const what : {"felt-rms", "felt-peak"}) {
    Protocol protocol = kelvin_or_piecewise(fmt::format("{}loudness = \"{}\"", on_scissors, what));
    EXPECT_THAT(find_gains(protocol), IsEmpty());
    const FeltLevel first = felt_level_of(protocol, 0);
    const FeltLevel second = felt_level_of(protocol, 1);
    const bool by_peak = protocol.loudness == Loudness::felt_peak;
    const double wanted = by_peak ? first.peak_n : first.rms_n;
    EXPECT_NEAR(by_peak ? second.peak_n : second.rms_n, wanted, felt_tolerance * wanted) << what;
    EXPECT_EQ(protocol.samples[0].gain, 1.0);
    const GainOrigin& origin = *protocol.gain_origin;
    EXPECT_EQ(origin.hand, "sim:scissors");
    EXPECT_EQ(origin.stands_for, "");
    EXPECT_EQ(origin.tolerance, felt_tolerance);
    EXPECT_THAT(origin.felt_n, ElementsAre(wanted, by_peak ? second.peak_n : second.rms_n));
    // A power of 1.001, which the last bit of a force does not move.
    const double steps = std::log(protocol.samples[1].gain) / std::log(1.001);
    EXPECT_NEAR(steps, std::round(steps), 1e-6);
    EXPECT_EQ(by_peak || std::lround(steps) == 993, true) << "a gain of 2.698: " << steps;
  }
}

TEST(FeltGains, TakeASimulatedHandInPlaceOfARealDeviceAndSaySo) {
  Protocol protocol = kelvin_or_piecewise("device = \"falcon:0\"\nloudness = \"felt-rms\"");
  EXPECT_THAT(find_gains(protocol),
              ElementsAre(HasSubstr("falcon:0 has no simulated hand; the gains were found "
                                    "in that of sim:scissors")));
  EXPECT_EQ(protocol.gain_origin->hand, "sim:scissors");
  EXPECT_EQ(protocol.gain_origin->stands_for, "falcon:0");
}

TEST(FeltGains, FallBackToTheOpenLoopWhereNoSimulatedHandFitsAndSayWhy) {
  Protocol protocol = simulated_protocol("design = \"abx\"\nloudness = \"felt-rms\"\n" + two_springs(8, 4));
  for (SessionSample& sample : protocol.samples) sample.law.force_unit = "Pa";
  protocol.device_uri = "falcon:0";
  EXPECT_THAT(find_gains(protocol),
              ElementsAre(HasSubstr(
                  "open loop, along the [motion]: no simulated device has the axes of all samples")));
  EXPECT_NEAR(protocol.samples[1].gain, 2.0, 0.05);
  EXPECT_THAT(protocol.gain_origin->fallback, HasSubstr("no simulated device"));
  EXPECT_EQ(protocol.gain_origin->hand, "");
}

TEST(FeltGains, AreRefusedWhereNeitherWayIsOpen) {
  Protocol protocol = simulated_protocol("design = \"abx\"\nloudness = \"felt-rms\"\n" + two_springs(8, 0.1));
  protocol.motion.reset();
  EXPECT_THAT([&] { find_gains(protocol); },
              testing::ThrowsMessage<std::invalid_argument>(
                  AllOf(HasSubstr("no gain from 0.05 to 20 makes sample 'second' as strong as 'first'"),
                        HasSubstr("there is no [motion] either"))));
  EXPECT_EQ(protocol.samples[1].gain, 1.0);
}

TEST(FeltGains, AreSearchedWhereTheLevelBends) {
  const auto saturates = [](double gain) { return 3.0 * std::tanh(gain); };
  const GainSearch found = gain_for(saturates, 2.5, 0.005);
  EXPECT_TRUE(found.is_found);
  EXPECT_NEAR(found.level, 2.5, 0.0125);
  const GainSearch none = gain_for(saturates, 3.5, 0.005);
  EXPECT_FALSE(none.is_found);
  EXPECT_NEAR(none.level, 3.0, 1e-6) << "the closest there is";
  const auto jumps = [](double gain) { return gain < 2.0 ? 1.0 : 3.0; };
  EXPECT_FALSE(gain_for(jumps, 2.0, 0.005).is_found);
}

TEST(FeltRemarks, NameSamplesToWhoeverMakesTheSessionAndNoneAtARun) {
  Protocol protocol = kelvin_or_piecewise(on_scissors + "loudness = \"rms\"");
  find_gains(protocol);
  const auto named = felt_remarks(protocol, "", SamplesTold::by_name);
  ASSERT_THAT(named, ElementsAre(HasSubstr("1.2 JND apart in strength"), HasSubstr("cut to a limit"),
                                 HasSubstr("dB apart from 20 Hz to 1 kHz")));
  EXPECT_THAT(named, Each(HasSubstr("samples 'kelvin' and 'piecewise'")));
  const auto unnamed = felt_remarks(protocol, "", SamplesTold::without_names);
  EXPECT_EQ(unnamed.size(), 3U);
  EXPECT_THAT(unnamed, Each(Not(HasSubstr("kelvin"))));
  EXPECT_THAT(unnamed, Each(Not(HasSubstr("piecewise"))));
}

TEST(FeltRemarks, AreNoneOfTwoThatAreAlike) {
  EXPECT_THAT(
      felt_remarks(simulated_protocol("design = \"abx\"\n" + two_springs(8, 8)), "", SamplesTold::by_name),
      IsEmpty());
}

TEST(FeltRemarks, AreNoneOfADesignThatVariesStrength) {
  EXPECT_THAT(felt_remarks(simulated_protocol(force_levels(4)), "", SamplesTold::by_name), IsEmpty());
}

}  // namespace
}  // namespace kerf::bench
