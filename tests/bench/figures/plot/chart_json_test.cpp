#include "plot/chart_json.h"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using nlohmann::ordered_json;

TEST(ChartJson, SaysAllThatIsDrawn) {
  const ordered_json json =
      chart_to_json({.title = "Cost over error",
                     .x_label = "error [N]",
                     .y_label = "cost [us]",
                     .curves = {{.label = "kelvin",
                                 .x = {1.0, line_break, 3.0},
                                 .y = {4.0, 5.0, std::numeric_limits<double>::infinity()},
                                 .colour = Colour::grey,
                                 .mark = Mark::boxes,
                                 .width = 4.0,
                                 .dashed = true,
                                 .of = {7, 8, 9}}},
                     .bands = {{.begin = 1.0, .end = 2.0, .colour = Colour::yellow}},
                     .cells = {.x_edges = {0.0, 1.0},
                               .y_edges = {0.0, 1.0, 2.0},
                               .upwards = true,
                               .kinds = {{Colour::sky, "rests"}, {Colour::orange, "does not", true}},
                               .kind = {1, 0}},
                     .vertical = {{.at = 0.1, .label = "JND", .label_after = true}},
                     .horizontal = {{.at = line_break, .label = "nowhere"}},
                     .labels = {{.x = 1.0, .y = 2.0, .text = "kelvin, exact", .left = true}},
                     .x_ticks = {{.at = 1.0, .name = "one"}},
                     .x_range = {0.1, 10.0},
                     .log_x = true});
  EXPECT_EQ(json, ordered_json::parse(R"({
    "title": "Cost over error", "x_label": "error [N]", "y_label": "cost [us]",
    "curves": [{"label": "kelvin", "x": [1.0, null, 3.0], "y": [4.0, 5.0, null], "colour": "grey",
                "mark": "boxes", "width": 4.0, "dashed": true, "of": [7, 8, 9]}],
    "bands": [{"begin": 1.0, "end": 2.0, "colour": "yellow"}],
    "cells": {"x_edges": [0.0, 1.0], "y_edges": [0.0, 1.0, 2.0], "upwards": true,
              "kinds": [{"colour": "sky", "label": "rests", "dotted": false},
                        {"colour": "orange", "label": "does not", "dotted": true}],
              "kind": [1, 0]},
    "vertical": [{"at": 0.1, "label": "JND", "label_after": true}],
    "horizontal": [{"at": null, "label": "nowhere", "label_after": false}],
    "labels": [{"x": 1.0, "y": 2.0, "text": "kelvin, exact", "left": true,
                "text_x": null, "text_y": null}],
    "x_ticks": [{"at": 1.0, "name": "one"}], "y_ticks": [],
    "x_range": [0.1, 10.0], "y_range": null, "log_x": true, "log_y": false})"));
}

TEST(ChartJson, NamesEveryColourAndMark) {
  const auto curve = [](Colour colour, Mark mark) {
    return chart_to_json({.curves = {{.colour = colour, .mark = mark}}})["curves"][0];
  };
  EXPECT_EQ(curve(Colour::black, Mark::line)["colour"], "black");
  EXPECT_EQ(curve(Colour::vermillion, Mark::points)["colour"], "vermillion");
  EXPECT_EQ(curve(Colour::orange, Mark::circles)["mark"], "circles");
  EXPECT_EQ(curve(Colour::orange, Mark::crosses)["colour"], "orange");
  EXPECT_EQ(curve(Colour::grey, Mark::steps)["mark"], "steps");
}

TEST(ChartJson, IsReadBackAsItWasWritten) {
  const Chart chart{
      .title = "Map",
      .x_label = "a",
      .y_label = "b",
      .curves = {{.label = "line",
                  .x = {1.0, line_break},
                  .y = {2.0, 3.0},
                  .colour = Colour::sky,
                  .mark = Mark::crosses,
                  .width = 2.0,
                  .dashed = true,
                  .of = {4, 5}}},
      .bands = {{.begin = 1.0, .end = 2.0, .colour = Colour::green}},
      .cells = {.x_edges = {0.0, 1.0, 2.0},
                .y_edges = {0.0, 1.0},
                .upwards = true,
                .kinds = {{Colour::sky, "rests"}, {Colour::orange, "does not", true}},
                .kind = {1, 0}},
      .vertical = {{.at = 0.1, .label = "JND", .label_after = true}},
      .horizontal = {{.at = 7.0, .label = "above"}},
      .labels = {{.x = 1.0, .y = 2.0, .text = "here", .left = true, .text_x = 3.0, .text_y = 4.0}},
      .x_ticks = {{.at = 1.0, .name = "one"}},
      .y_ticks = {{.at = 2.0, .name = "two"}},
      .x_range = {0.0, 2.0},
      .y_range = {0.0, 1.0},
      .log_x = true,
      .log_y = true};
  const Chart back = chart_from_json(ordered_json::parse(chart_to_json(chart).dump()));
  EXPECT_EQ(chart_to_json(back), chart_to_json(chart));
  EXPECT_EQ(back.curves[0].mark, Mark::crosses);
  EXPECT_EQ(back.cells.kinds[1].colour, Colour::orange);
}

TEST(ChartJson, NeedsNoMoreThanCurves) {
  const Chart chart = chart_from_json(ordered_json::parse(R"({"curves": [{"x": [1, 2], "y": [3, null]}]})"));
  ASSERT_EQ(chart.curves.size(), 1U);
  EXPECT_EQ(chart.curves[0].colour, Colour::black);
  EXPECT_EQ(chart.curves[0].mark, Mark::line);
  EXPECT_FALSE(chart.log_x);
}

TEST(ChartJson, RefusesWhatCannotBeDrawn) {
  const auto refuses = [](const char* text) {
    EXPECT_THROW((void)chart_from_json(ordered_json::parse(text)), std::invalid_argument) << text;
  };
  refuses(R"({"curves": [{"x": [1], "y": [1], "colour": "pink"}]})");
  refuses(R"({"curves": [{"x": [1], "y": [1], "mark": "hearts"}]})");
  refuses(R"({"curves": [{"x": [1, 2], "y": [1]}]})");
  refuses(R"({"cells": {"x_edges": [0, 1], "y_edges": [0, 1], "kinds": [], "kind": [0]}})");
  EXPECT_THROW((void)chart_from_json(ordered_json::parse(R"({"curves": [{"x": ["a"], "y": [1]}]})")),
               ordered_json::exception);
}

}  // namespace
}  // namespace kerf::bench
