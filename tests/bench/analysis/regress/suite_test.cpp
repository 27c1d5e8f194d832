#include "regress/suite.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/analysis/regress/small_suite.h"

namespace kerf::bench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::SizeIs;
using testing::ThrowsMessage;

class SuiteFile : public testing::Test {
 protected:
  /// The suite of one case with a text in it replaced.
  Suite with(const std::string& from, const std::string& to) const {
    std::string text = test::one_case;
    text.replace(text.find(from), from.size(), to);
    folder_.write_suite(text);
    return read_suite(folder_.suite());
  }
  void refused(const std::string& from, const std::string& to, const std::string& message) const {
    EXPECT_THAT([&] { (void)with(from, to); },
                ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("suite.toml:"), HasSubstr(message))))
        << to;
  }
  test::SuiteFolder folder_;
};

TEST_F(SuiteFile, NamesLawTrajectoryAndTolerance) {
  const Suite suite = read_suite(folder_.suite());
  EXPECT_EQ(suite.name, "a small suite");
  EXPECT_EQ(suite.stored, folder_.at("suite.h5"));
  ASSERT_THAT(suite.cases, SizeIs(1));
  const RegressionCase& one = suite.cases[0];
  EXPECT_EQ(one.law.law.model(), "kelvin");
  EXPECT_TRUE(one.tolerance.exact);
  EXPECT_EQ(one.motion.rate_hz, 1000.0);
  ASSERT_THAT(one.motion.axes, SizeIs(1));
  const auto& strokes = std::get<StrokesToAndFro>(one.motion.axes[0].script);
  EXPECT_NEAR(strokes.from, 0.610865, 1e-6);
  EXPECT_EQ(strokes.pause_s, 0.05);
}

TEST_F(SuiteFile, TakesLimitsOfTheWholeRunAndOfAChannel) {
  const Suite suite =
      with("exact = true",
           "jnd = 0.5\nvibration = 3\nslew = { value = 20, unit = \"mN/s\" }\n"
           "drift = [{ value = 1, unit = \"N\" }, { value = 2, unit = \"N·mm\" }]\n"
           "channel.theta = { absolute = { value = 1, unit = \"N\" }, peak = { value = 2, unit = \"N\" } }");
  const Tolerance& given = suite.cases[0].tolerance;
  EXPECT_EQ(given.vibration_limit(), 3.0);
  EXPECT_DOUBLE_EQ(given.slew.force.value(), 0.02);
  EXPECT_DOUBLE_EQ(given.drift.torque.value(), 0.002);
  const Tolerance& own = given.of("theta");
  EXPECT_EQ(own.force_n, 1.0);
  EXPECT_EQ(own.jnd, std::nullopt) << "one tolerance of each tick in place of another";
  EXPECT_EQ(own.vibration, 3.0) << "what it does not say it inherits";
  EXPECT_EQ(own.peak.force, 2.0);
  EXPECT_EQ(given.of("other").jnd, 0.5);
  refused("exact = true", "exact = true\nchannel.phi = { jnd = 1 }",
          "'phi' is no channel of the case; it has theta");
  refused("exact = true", "exact = true\nchannel.theta = { rate = 1 }", "rate");
  refused("exact = true", "jnd = 1\nslew = { value = 1, unit = \"N\" }", "slew");
}

TEST_F(SuiteFile, TakesTolerancesInForceAndTorqueApart) {
  const Suite suite = with("exact = true",
                           "absolute = [{ value = 2, unit = \"mN\" }, { value = 3, unit = \"N·m\" }]\n"
                           "relative = 1e-6\njnd = 0.5");
  const Tolerance& given = suite.cases[0].tolerance;
  EXPECT_DOUBLE_EQ(given.force_n.value(), 0.002);
  EXPECT_DOUBLE_EQ(given.torque_n_m.value(), 3.0);
  EXPECT_EQ(given.relative, 1e-6);
  EXPECT_EQ(given.jnd, 0.5);
  EXPECT_FALSE(given.exact);
}

TEST_F(SuiteFile, LetsACaseDepartFromTheDefaults) {
  folder_.write_suite("[defaults]\nexact = true\ntick_cost = 4\nrate = { value = 500, unit = \"Hz\" }\n" +
                      std::string(test::one_case).substr(std::string(test::one_case).find("[[case]]")));
  EXPECT_EQ(read_suite(folder_.suite()).cases[0].motion.rate_hz, 500.0);
  EXPECT_EQ(read_suite(folder_.suite()).cases[0].tick_cost, 4.0);
  folder_.write_suite(
      "[defaults]\nexact = true\n" +
      std::string("[[case]]\nname = \"a\"\nlaw = \"kelvin.law.toml\"\njnd = 1\n[case.motion]\n"
                  "kind = \"rest\"\nat = { value = 0, unit = \"rad\" }\n"));
  EXPECT_FALSE(read_suite(folder_.suite()).cases[0].tolerance.exact) << "a JND is not exact";
}

TEST_F(SuiteFile, RefusesByItsLine) {
  refused("name = \"kelvin\"", "name = \"a/b\"", "'a/b' is no name for a case");
  refused("law = \"kelvin.law.toml\"", "", "a [[case]] needs 'law'");
  refused("exact = true", "exact = true\nrelative = 1e-3", "'exact' leaves no room");
  refused("exact = true", "exakt = true", "unknown key 'exakt'");
  refused("exact = true", "", "has no tolerance for 'theta' in N");
  refused("exact = true", "absolute = { value = 1, unit = \"N·m\" }", "has no tolerance for 'theta' in N");
  refused("exact = true", "relative = -1", "'relative' is -1");
  refused("exact = true", "exact = true\ntick_cost = 1", "'tick_cost' is 1");
  refused("exact = true", "exact = true\nscene = \"kelvin.law.toml\"", "needs one trajectory");
  refused("[[case.motion]]", "[[case.motoin]]", "unknown key 'motoin'");
  refused("kind = \"strokes\"", "kind = \"circles\"", "'kind' is \"circles\", expected \"rest\"");
  refused("kind = \"strokes\"", "kind = \"strokes\"\naxis = \"x\"", "'axis' is \"x\", and the law has theta");
  refused("unit = \"deg\"", "unit = \"mm\"", "given in mm");
  refused("value = 0.3", "value = 0", "'stroke' is 0");
}

TEST_F(SuiteFile, RefusesTwoMotionsOfOneAxisAndTwoCasesOfOneName) {
  refused("[[case.motion]]",
          "[[case.motion]]\nkind = \"rest\"\nat = { value = 1, unit = \"rad\" }\n[[case.motion]]",
          "axis 'theta' has two motions");
  const std::string text = test::one_case;
  folder_.write_suite(text + text.substr(text.find("[[case]]")));
  EXPECT_THAT([&] { (void)read_suite(folder_.suite()); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("there are two cases named 'kelvin'")));
}

TEST_F(SuiteFile, KnowsItsCasesByName) {
  const Suite suite = read_suite(folder_.suite());
  EXPECT_THAT(only(suite, {"kelvin"}).cases, SizeIs(1));
  EXPECT_THAT([&] { (void)only(suite, {"maxwell"}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("has no case 'maxwell'; it has kelvin")));
}

}  // namespace
}  // namespace kerf::bench
