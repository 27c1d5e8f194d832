#include "plot/heat_map.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plot/parallel_axes.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

HeatMap two_panels() {
  HeatMap map{.title = "Walls, 100 %",
              .x = {.label = "delay [s]", .parts = 3, .ticks = {{.at = 0.5, .name = "5 %"}}},
              .y = {.label = "stiffness [N/m]", .parts = 2, .ticks = {{.at = 0.5, .name = "100"}}},
              .across = 2,
              .panels = {{.title = "light", .tiles = {}}, {.title = "heavy", .tiles = {}}},
              .colours = share_steps("share of cells")};
  for (HeatPanel& panel : map.panels)
    for (int i = 0; i < 6; ++i) panel.tiles.push_back({.value = i / 6.0});
  return map;
}

TEST(HeatMap, NamesItsAxesPanelsAndScale) {
  const std::string svg = draw(two_panels());
  for (const char* text :
       {"Walls, 100 %", "delay [s]", "stiffness [N/m]", "light", "heavy", "share of cells", "5 %"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_THAT(svg, Not(HasSubstr("cells failed")));
}

TEST(HeatMap, DrawsATileInItsColourAndNoneOfWhatHasNoNumber) {
  HeatMap map = two_panels();
  const std::string colour = map.colours.colour_of_step(8);
  map.panels.resize(1);
  map.panels[0].tiles.assign(6, {});
  map.panels[0].tiles[0].value = 0.85;
  map.panels[0].tiles[1].has_failed = true;
  map.panels[0].tiles[2].has_missing = true;
  const std::string svg = draw(map);
  const auto count = [&](const std::string& what) {
    std::size_t found = 0;
    for (auto at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) ++found;
    return found;
  };
  const auto rgb = [](const std::string& hex) {
    return "rgb(" + std::to_string(std::stoi(hex.substr(1, 2), nullptr, 16));
  };
  EXPECT_EQ(count(rgb(colour)), 2U);  // the tile and the scale
  EXPECT_THAT(svg, HasSubstr("× cells failed"));
  EXPECT_THAT(svg, HasSubstr("○ cells are missing"));
  EXPECT_THAT(svg, HasSubstr("grey: no number is known"));
}

TEST(ParallelAxes, TellsFailedCellsFromOthers) {
  ParallelAxes axes{
      .title = "Lines",
      .axes = {{.label = "mass [kg]", .ticks = {{.at = 0.0, .name = "0.02"}}},
               {.label = "rest", .ticks = {}}},
      .lines = {{.at = {0.0, 1.0}, .value = 0.3}, {.at = {1.0, line_break}, .value = 0.0, .is_failed = true}},
      .colours = share_steps("rest")};
  const std::string svg = draw(axes);
  for (const char* text : {"mass [kg]", "0.02", "no number", ">?<"}) EXPECT_THAT(svg, HasSubstr(text));
  axes.lines.pop_back();
  EXPECT_THAT(draw(axes), Not(HasSubstr("no number")));
}

}  // namespace
}  // namespace kerf::bench
