#include <cmath>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.h"

// Runs with rows missing, and lags that were not found.

namespace kerf {
namespace {

using test::Outcome;
using test::run_kerf;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class CompareGaps : public testing::Test {
 protected:
  /// A table of two seconds at 1 kHz whose force comes late, and with a ripple that no hand feels; rows
  /// [from, to) are not there.
  [[nodiscard]] std::string table(const std::string& name, double late_s = 0.0, double ripple = 0.0,
                                  int from = 0, int to = 0) const {
    std::string text = "time [s],x [N]\n";
    for (int i = 0; i < 2000; ++i) {
      const double t = 1e-3 * i - late_s;
      if (i < from || i >= to)
        text += fmt::format("{:.3f},{:.9f}\n", 1e-3 * i,
                            2.0 + std::sin(7.0 * t) + 0.3 * std::sin(31.0 * t) + ripple * std::sin(1e3 * i));
    }
    test::write_text(folder_ / name, text);
    return (folder_ / name).string();
  }
  [[nodiscard]] static nlohmann::json compared(std::vector<std::string> words) {
    words.insert(words.begin(), {"compare", "--json"});
    return nlohmann::json::parse(run_kerf(words).output);
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(CompareGaps, AreNoLatencyWhereTheForcesAreNotAlike) {
  const std::string whole = table("whole.csv");
  const std::string part = table("part.csv", 0.0, 1e-4, 900, 1200);
  const auto json = compared({whole, part});
  EXPECT_FALSE(json.at("passed").get<bool>());
  EXPECT_EQ(json.at("outside"), 0);
  EXPECT_EQ(json.at("compared_rows"), 1700);
  EXPECT_EQ(json.at("names").at(0).at("kind"), "lost");
  EXPECT_EQ(json.at("names").at(0).at("numbers").at("row"), 900);
  const auto& x = json.at("channels").at(0);
  EXPECT_NEAR(x.at("gain").get<double>(), 1.0, 1e-4);
  EXPECT_NEAR(x.at("latency_ms").get<double>(), 0.0, 0.01);
}

TEST_F(CompareGaps, AreToldByTimeAndNotBridged) {
  const std::string whole = table("whole.csv");
  const std::string part = table("part.csv", 0.0, 0.0, 900, 1200);
  for (const bool of_got : {true, false}) {
    const std::vector<std::string> runs = of_got ? std::vector{whole, part} : std::vector{part, whole};
    for (const char* align : {"time", "lag"}) {
      const auto json = compared({runs[0], runs[1], "--align", align});
      EXPECT_TRUE(json.at("passed").get<bool>()) << json.at("messages");
      ASSERT_EQ(json.at("gaps").size(), 1U);
      EXPECT_EQ(json.at("gaps").at(0).at("run"), of_got ? "got" : "expected");
      EXPECT_EQ(json.at("gaps").at(0).at("rows_not_compared"), 300);
      EXPECT_NEAR(json.at("gaps").at(0).at("from_s").get<double>(), 0.899, 1e-9);
      EXPECT_EQ(json.at("compared_rows"), 1700);
    }
  }
  EXPECT_THAT(run_kerf({"compare", whole, part, "--align", "time"}).errors,
              HasSubstr("a gap in time, the longest of 301 ms after 0.899 s: 300 rows of the other"));
  EXPECT_FALSE(compared({whole, whole, "--align", "time"}).contains("gaps"));
}

TEST_F(CompareGaps, LeaveALagThatIsTooLongUnknown) {
  const std::string early = table("early.csv");
  const std::string late = table("late.csv", 0.0137);
  const Outcome outcome = run_kerf({"compare", early, late, "--align", "lag", "--max-lag", "5"});
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("lag unknown: it is longer than the 5 ms"),
                                    HasSubstr("larger --max-lag"), Not(HasSubstr("ticks), taken out"))));
  const auto json = compared({early, late, "--align", "lag", "--max-lag", "5"});
  EXPECT_TRUE(json.at("lag").is_null());
  EXPECT_EQ(json.at("no_lag_within_ms"), 5.0);
  EXPECT_NEAR(compared({early, late, "--align", "lag"}).at("lag").at("ms").get<double>(), 13.7, 0.01);
}

}  // namespace
}  // namespace kerf
