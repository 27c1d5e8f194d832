#include "regress/junit.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/version.h>

#include "bench/analysis/regress/small_suite.h"
#include "regress/context.h"
#include "regress/regress_page.h"

namespace kerf::bench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

TEST(Xml, HasNothingInItThatXmlForbids) {
  EXPECT_EQ(xml_escaped("a < b & \"c\""), "a &lt; b &amp; &quot;c&quot;");
  EXPECT_EQ(xml_escaped(std::string("nul \0 bell \a tab \t", 16)), "nul ? bell ? tab");
  EXPECT_EQ(xml_escaped("N·m"), "N·m");
  EXPECT_EQ(xml_escaped("cut \xC2"), "cut ?") << "half a character";
  EXPECT_EQ(xml_escaped("\xED\xA0\x80"), "???") << "a surrogate";
  EXPECT_EQ(xml_escaped("\xEF\xBF\xBF"), "???") << "no character at all";
  EXPECT_EQ(xml_escaped("\xC0\xAF"), "??") << "longer than it need be";
}

/// A suite whose law went silent after its forces were stored.
class SilentLaw : public testing::Test {
 protected:
  SilentLaw() {
    const Suite before = read_suite(folder_.suite());
    write_update(before, plan_update(before, {}), "<first> & best");
    folder_.change_law("value = 8, unit = \"N/rad\"", "value = 1e-6, unit = \"N/rad\"");
    folder_.change_law("value = 7,", "value = 1e-6,");
    suite_ = read_suite(folder_.suite());
    outcome_ = run_suite(suite_, {});
  }
  test::SuiteFolder folder_;
  Suite suite_;
  SuiteOutcome outcome_;
};

TEST_F(SilentLaw, IsAFailureInJUnit) {
  const std::string xml = junit_xml(suite_, outcome_);
  EXPECT_THAT(
      xml,
      AllOf(HasSubstr("<testsuite name=\"a small suite\" tests=\"1\" failures=\"1\" errors=\"0\" time=\""),
            HasSubstr("<testcase classname=\"a small suite\" name=\"kelvin\" time=\""),
            HasSubstr("<failure message=\"the force differs in "),
            HasSubstr(software() + ": &lt;first&gt; &amp; best"),
            HasSubstr("<property name=\"software\" value=\"" + software() + "\"/>"),
            HasSubstr("</testsuites>\n")));
}

TEST_F(SilentLaw, IsShownFiveTicksAroundTheWorst) {
  const auto rows = context_of(outcome_.cases[0]);
  const std::size_t worst = outcome_.cases[0].comparison.worst->tick;
  ASSERT_THAT(rows, SizeIs(11));
  EXPECT_EQ(rows[5].tick, worst);
  EXPECT_EQ(rows[0].tick, worst - 5);
  EXPECT_DOUBLE_EQ(rows[5].time_s, 1e-3 * static_cast<double>(worst));
  EXPECT_EQ(rows[5].position, outcome_.cases[0].path.sample[worst].position[0]);
  EXPECT_EQ(rows[5].expected, outcome_.cases[0].stored.force[worst]);
  EXPECT_EQ(rows[5].got, outcome_.cases[0].got.force[worst]);
  EXPECT_THAT(context_table(outcome_.cases[0]), AllOf(HasSubstr("theta [rad]"), HasSubstr("speed [rad/s]"),
                                                      HasSubstr("expected [N]"), HasSubstr("\n> ")));
}

TEST_F(SilentLaw, IsDrawnBesideWhatWasExpected) {
  const auto figures = figures_of(outcome_.cases[0]);
  ASSERT_THAT(figures, SizeIs(4));
  EXPECT_EQ(figures[0].name, "kelvin-worst");
  ASSERT_THAT(figures[0].chart.curves, SizeIs(2));
  EXPECT_EQ(figures[0].chart.curves[0].label, "expected");
  EXPECT_EQ(figures[1].name, "kelvin-whole");
  EXPECT_EQ(figures[1].chart.curves[0].x.size(), 400U);
  EXPECT_EQ(figures[2].name, "kelvin-difference");
  EXPECT_EQ(figures[2].chart.curves[0].label, "allowed");
  EXPECT_EQ(figures[3].name, "kelvin-jnd");
  const Curve& jnds = figures[3].chart.curves[0];
  const auto& worst = *outcome_.cases[0].comparison.worst;
  EXPECT_DOUBLE_EQ(jnds.y[worst.tick], worst.difference() / std::max(0.07 * std::abs(worst.expected), 0.05));
  EXPECT_EQ(figures[3].chart.y_label, "difference [JND]");
  EXPECT_FALSE(figures[2].chart.bands.empty()) << "what is outside is marked";
  write_regress_page(suite_, outcome_, folder_.at("page"));
  const std::string page = test::read_text(folder_.at("page/regress.html"));
  EXPECT_THAT(page, AllOf(HasSubstr("<figure class=\"zoom\">"), HasSubstr("script-src 'sha256-")));
  EXPECT_THAT(page, AllOf(HasSubstr("1 of 1 cases did not pass"), HasSubstr("<svg"), HasSubstr("FAILED"),
                          Not(HasSubstr("<first>"))));
  EXPECT_THAT(test::read_text(folder_.at("page/kelvin-worst.svg")), HasSubstr("<svg"));
}

/// A suite with a tolerance, whose law became a little stiffer: some ticks are outside, more differ at all.
class StifferLaw : public testing::Test {
 protected:
  StifferLaw() {
    std::string tolerant = test::one_case;
    tolerant.replace(tolerant.find("exact = true"), 12, "absolute = { value = 0.01, unit = \"N\" }");
    folder_.write_suite(tolerant);
    const Suite before = read_suite(folder_.suite());
    write_update(before, plan_update(before, {}), "first");
    folder_.change_law("value = 8, unit = \"N/rad\"", "value = 8.1, unit = \"N/rad\"");
    suite_ = read_suite(folder_.suite());
    outcome_ = run_suite(suite_, {});
  }
  test::SuiteFolder folder_;
  Suite suite_;
  SuiteOutcome outcome_;
};

TEST_F(StifferLaw, IsCountedAlikeInTableSentenceAndJUnit) {
  const ForceComparison& counts = outcome_.cases[0].comparison;
  ASSERT_GT(counts.outside, 0U);
  ASSERT_GT(counts.differing, counts.outside);
  const std::string sentence =
      fmt::format("the force is outside the tolerance in {} of 400 ticks, and differs at all in {}; worst",
                  counts.outside, counts.differing);
  write_regress_page(suite_, outcome_, folder_.at("page"));
  const std::string page = test::read_text(folder_.at("page/regress.html"));
  EXPECT_THAT(
      page,
      AllOf(HasSubstr("<th>outside the tolerance</th><th>different at all</th>"),
            HasSubstr(fmt::format("<td>FAILED</td><td>{}</td><td>{}</td>", counts.outside, counts.differing)),
            HasSubstr(sentence)));
  EXPECT_THAT(junit_xml(suite_, outcome_), HasSubstr("<failure message=\"" + sentence));
  EXPECT_THAT(outcome_.cases[0].messages, testing::Contains(HasSubstr(sentence)));
}

}  // namespace
}  // namespace kerf::bench
