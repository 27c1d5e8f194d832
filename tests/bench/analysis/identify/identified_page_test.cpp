#include "identify/identified_page.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "identify/identified_device.h"
#include "plot/chart_json.h"

namespace kerf::bench {
namespace {

using nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* of_one_axis = R"({
  "device": "falcon:0", "model": "Novint Falcon", "held": false, "good": false,
  "axes": [{"name": "x", "problem": "", "fits": false, "verdict": "this model predicts the device to 12 %",
            "why_not": ["play of 0.2 mm"], "z_width": null,
            "numbers": [{"name": "mass", "value": 0.12, "lower": 0.11, "upper": 0.13, "unit": "kg"},
                        {"name": "motor constant", "value": null, "lower": null, "upper": null, "unit": "1"}],
            "charts": [{"name": "x-gain", "figure": {"title": "Gain of x", "x_label": "f [Hz]",
                        "curves": [{"label": "device", "x": [1, 2], "y": [3, 4]}]}}]}],
  "charts": [{"name": "others", "figure": {"title": "What somebody adds",
              "curves": [{"label": "damped", "x": [1, 2], "y": [3, 4]}]}}]})";

TEST(IdentifiedPage, SaysTheVerdictTheNumbersAndDrawsWhateverChartIsThere) {
  const std::string html = identified_body(ordered_json::parse(of_one_axis));
  EXPECT_THAT(html,
              AllOf(HasSubstr("the model does not fit: this model predicts the device to 12 %"),
                    HasSubstr("play of 0.2 mm"), HasSubstr("<td>0.11 to 0.13</td>"),
                    HasSubstr("<td>unknown</td>"), HasSubstr("Gain of x"), HasSubstr("What somebody adds")));
}

TEST(IdentifiedPage, ShowsAnAxisOfWhichNothingWasFound) {
  const std::string html = identified_body(ordered_json::parse(
      R"({"device": "a", "model": "b", "held": true, "good": false,
          "axes": [{"name": "x", "problem": "no motor <moves> it"}]})"));
  EXPECT_THAT(html, AllOf(HasSubstr("nothing was found"), HasSubstr("no motor &lt;moves&gt; it"),
                          Not(HasSubstr("<svg"))));
}

TEST(IdentifiedPage, RefusesAChartThatCannotBeDrawn) {
  auto json = ordered_json::parse(of_one_axis);
  json["charts"][0]["figure"]["curves"][0]["y"] = {1.0};
  EXPECT_THROW((void)identified_body(json), std::invalid_argument);
}

TEST(IdentifiedPage, IsMadeOfWhatTheFileTells) {
  const std::atomic<bool> stop{false};
  AxisExperiment measured = excite_axis({.device_uri = "sim:axis?hand=off&coulomb=0.1N&step=0.01mm&delay=1ms",
                                         .force_n = 2.0,
                                         .seconds = 10.0,
                                         .period_s = 0.5,
                                         .lowest_hz = 2.0,
                                         .virtual_time = true},
                                        0, {}, stop);
  IdentifiedDevice device;
  device.device = measured.device;
  device.axes.push_back(identified_axis(std::move(measured), 0));
  const auto json = ordered_json::parse(identified_as_json(device).dump());
  const auto& axis = json["axes"][0];
  ASSERT_EQ(axis["charts"].size(), 4U);
  EXPECT_EQ(axis["charts"][0]["name"], "x-gain");
  // Gain of the device and its coherence at every line that was excited: 2 Hz apart.
  const Chart gain = chart_from_json(axis["charts"][0]["figure"]);
  EXPECT_TRUE(gain.log_x && gain.log_y);
  EXPECT_EQ(gain.curves.back().x.size(), axis["response"].size());
  for (const double hz : gain.curves.back().x) EXPECT_NEAR(hz, 2.0 * std::round(0.5 * hz), 1e-9);
  EXPECT_EQ(axis["numbers"][0]["value"], axis["mass"]["value"]);
  EXPECT_EQ(axis["numbers"][0]["unit"], "kg");
  const auto delay = std::ranges::find(axis["numbers"], ordered_json("delay"),
                                       [](const auto& number) { return number["name"]; });
  EXPECT_NEAR((*delay)["value"].get<double>(), 1e-3, 1e-4);
}

}  // namespace
}  // namespace kerf::bench
