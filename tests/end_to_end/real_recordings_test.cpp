#include <cstddef>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/measured_data.h"
#include "support/program.h"

// The whole path on measurements of other labs, through the program as a user runs it.

namespace kerf {
namespace {

using nlohmann::json;
using test::Outcome;
using test::run_kerf;

json parsed(const Outcome& outcome) {
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
  return json::parse(outcome.output, nullptr, false);
}

class RealRecording : public testing::Test {
 protected:
  json import(const std::string& data, const std::string& map) {
    return parsed(
        run_kerf({"import", test::measured_file(data).string(), "--map", map, "-o", file(), "--json"}));
  }
  json segment() { return parsed(run_kerf({"segment", file(), "--json"})); }
  json fit() { return parsed(run_kerf({"fit", file(), "-o", fits(), "--json"})); }

  [[nodiscard]] std::string file() const { return (folder_ / "r.h5").string(); }
  [[nodiscard]] std::string fits() const { return (folder_ / "fits").string(); }
  [[nodiscard]] std::string report() const { return (folder_ / "report.html").string(); }

  static json fit_of(const json& result, const std::string& model) {
    for (const json& one : result.at("fits")) {
      if (one.at("model") == model) return one;
    }
    return {};
  }

 private:
  test::TemporaryFolder folder_;
};

const std::string punch = "time=5[ms],position=4[deg],force=2[gf]";

TEST_F(RealRecording, OfAMeniscusGoesFromTextToReport) {
  KERF_NEEDS_DATA("meniscus/9_meniscus_slow_1824.txt");
  const json imported = import("meniscus/9_meniscus_slow_1824.txt", punch);
  EXPECT_EQ(imported.at("samples"), 17687);
  EXPECT_EQ(imported.at("bad_lines"), 1);
  EXPECT_EQ(imported.at("channels").at("position").at("unit"), "rad");
  EXPECT_NEAR(imported.at("duration_s").get<double>(), 50.6, 0.1);
  EXPECT_NEAR(imported.at("channels").at("force_measured").at("max").get<double>(), 6.92, 0.02);
  EXPECT_EQ(segment().at("closings"), 10);

  const json fits = fit();
  for (const auto* model : {"kelvin", "exponential", "piecewise", "recording"}) {
    EXPECT_TRUE(fit_of(fits, model).at("converged").get<bool>()) << model;
  }
  const double line = fits.at("line_rmse").get<double>();
  EXPECT_LT(fit_of(fits, "recording").at("rmse").get<double>(), line);
  EXPECT_LT(fit_of(fits, "piecewise").at("rmse").get<double>(), line);

  const Outcome page = run_kerf({"report", file(), "--fits", this->fits(), "-o", report()});
  EXPECT_EQ(page.exit_status, 0) << page.errors;
  const std::string text = test::read_text(report());
  EXPECT_THAT(text, testing::AllOf(testing::HasSubstr("piecewise"), testing::HasSubstr("<svg")));
}

TEST_F(RealRecording, OfAnEmptyPunchHasElevenClosings) {
  KERF_NEEDS_DATA("meniscus/7_blank_slow_1819.txt");
  EXPECT_EQ(import("meniscus/7_blank_slow_1819.txt", punch).at("samples"), 17421);
  EXPECT_EQ(segment().at("closings"), 11);
}

TEST_F(RealRecording, OfATendonRelaxes) {
  KERF_NEEDS_DATA("tendon/relaxation_fresh_1.csv");
  (void)import("tendon/relaxation_fresh_1.csv", "time=Time,position=Extension,force=Load");
  const json fits = fit();
  const json kelvin = fit_of(fits, "kelvin");
  EXPECT_TRUE(kelvin.at("converged").get<bool>());
  EXPECT_GT(kelvin.at("parameters").at("parallel_stiffness").at("ci95").at(0).get<double>(), 0.0);
  EXPECT_GT(kelvin.at("parameters").at("series_stiffness").at("ci95").at(0).get<double>(), 0.0);
  for (const auto* model : {"exponential", "piecewise", "recording"}) {
    EXPECT_TRUE(fit_of(fits, model).at("converged").get<bool>()) << model;
  }
  EXPECT_LT(kelvin.at("rmse").get<double>(), fits.at("line_rmse").get<double>());
}

TEST_F(RealRecording, OfVhbIsReadInBothItsEncodings) {
  for (const auto* data : {"vhb/relaxation_4d0.csv", "vhb/cycle_0d03_1d5_gbk.csv"}) {
    KERF_NEEDS_DATA(data);
    const json imported = parsed(run_kerf({"import", test::measured_file(data).string(), "--map",
                                           "time=1,position=2,force=3", "-o", file(), "--force", "--json"}));
    EXPECT_EQ(imported.at("channels").at("position").at("unit"), "m") << data;
    const json fits = parsed(run_kerf({"fit", file(), "-o", this->fits(), "--force", "--json"}));
    for (const json& one : fits.at("fits")) {
      EXPECT_TRUE(one.at("converged").get<bool>()) << data << ": " << one.at("model");
    }
  }
}

}  // namespace
}  // namespace kerf
