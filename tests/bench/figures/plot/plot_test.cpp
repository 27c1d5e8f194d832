#include "plot/plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/version.h>

namespace kerf::bench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

TEST(Plot, IsOneSvgElementWithItsLabels) {
  const std::string svg = draw({.title = "Force over time",
                                .x_label = "time [s]",
                                .y_label = "force [N]",
                                .curves = {{.label = "measured", .x = {0, 1, 2}, .y = {0, 3, 1}}}});
  EXPECT_THAT(svg, StartsWith("<svg"));
  EXPECT_THAT(svg, HasSubstr("</svg>"));
  for (const auto* text : {"Force over time", "time [s]", "force [N]", "measured"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_THAT(svg, HasSubstr("<title>Force over time</title>\n<desc>" + software() + ", by gnuplot</desc>"));
}

TEST(Plot, NamesTicksOnBothAxes) {
  const std::string svg =
      draw({.curves = {{.x = {0, 1, 2}, .y = {0, 3, 1}}},
            .x_ticks = {{.at = 1.0, .name = "the standard"}},
            .y_ticks = {{.at = 3.0, .name = "subject 1"}, {.at = 2.0, .name = "50 % off"}}});
  EXPECT_THAT(svg, HasSubstr("the standard"));
  EXPECT_THAT(svg, HasSubstr("subject 1"));
  EXPECT_THAT(svg, HasSubstr("50 % off"));
}

TEST(Plot, SlantsNamesThatWouldRunIntoEachOther) {
  Chart chart{.curves = {{.x = {0, 1, 2, 3}, .y = {0, 3, 1, 2}}},
              .x_ticks = {{0.0, "one"}, {1.0, "two"}, {2.0, "three"}, {3.0, "four"}}};
  EXPECT_THAT(draw(chart), Not(HasSubstr("rotate(-30")));
  for (NamedTick& tick : chart.x_ticks) tick.name += ", of a law with a very long name";
  EXPECT_THAT(draw(chart),
              AllOf(HasSubstr("rotate(-30"), HasSubstr("three, of a law with a very long name")));
  chart.width_px = 1800;
  EXPECT_THAT(draw(chart), Not(HasSubstr("rotate(-30"))) << "there is room for them";
}

TEST(Plot, NumbersALogarithmicAxisOfOneDecadeByMoreThanItsEnds) {
  const Chart narrow{.curves = {{.x = {1.3, 1.4}, .y = {1, 2}}}, .x_range = {0.15, 2.4}, .log_x = true};
  const std::string svg = draw(narrow);
  for (const auto* number : {"<text>0.2</text>", "<text>0.5</text>", "<text>1</text>", "<text>2</text>"})
    EXPECT_THAT(svg, HasSubstr(number)) << number;
  const Chart wide{.curves = {{.x = {1.3, 1.4}, .y = {1, 2}}}, .x_range = {0.15, 240.0}, .log_x = true};
  EXPECT_THAT(draw(wide), AllOf(HasSubstr("<text>100</text>"), Not(HasSubstr("<text>0.5</text>"))));
}

TEST(Plot, NumbersALogarithmicAxisThatNobodyGaveARange) {
  const std::string svg = draw({.curves = {{.x = {0, 1, 2}, .y = {300, 700, 1900}}}, .log_y = true});
  for (const auto* number : {"<text>500</text>", "<text>1000</text>"})
    EXPECT_THAT(svg, HasSubstr(number)) << number;
  const std::string narrow = draw({.curves = {{.x = {0, 1, 2}, .y = {210, 250, 490}}}, .log_y = true});
  for (const auto* number : {"<text>300</text>", "<text>400</text>"})
    EXPECT_THAT(narrow, HasSubstr(number)) << number;
}

TEST(Plot, DrawsRunsOfCellsOfOneColourAsOneRectangle) {
  Chart chart{.curves = {{.x = {0, 3}, .y = {0, 2}}},
              .cells = {.x_edges = {0, 1, 2, 3},
                        .y_edges = {0, 1, 2},
                        .kinds = {{Colour::sky, "holds"},
                                  {Colour::orange, "breaks"},
                                  {Colour::sky, "holds, which theory denies", true}},
                        .kind = {0, 2, 0, 1, 1, 1}}};
  const auto rectangles = [&] {
    const std::string svg = draw(chart);
    std::size_t count = 0;
    for (std::size_t at = 0; (at = svg.find("fill-opacity = '0.3", at)) != std::string::npos; ++at) ++count;
    return count;
  };
  EXPECT_EQ(rectangles(), 2U) << "a row below, one above";
  chart.cells.upwards = true;
  EXPECT_EQ(rectangles(), 4U) << "the middle one of three columns is of two colours";
  EXPECT_THAT(draw(chart), AllOf(HasSubstr("holds"), HasSubstr("breaks"), Not(HasSubstr("denies"))));
  chart.cells.kind.clear();
  EXPECT_EQ(rectangles(), 0U);
  EXPECT_THAT(draw(chart), HasSubstr("breaks"));
}

TEST(Plot, TakesHostileTextAsText) {
  const std::string svg = draw({.title = "a_b^2 <script>alert(1)</script> 'quoted' \"; system('true') äöü",
                                .x_label = "x\nset output '/dev/null'",
                                .y_label = "`date` $HOME",
                                .curves = {{.label = "{/Symbol a} & @b", .x = {0, 1}, .y = {0, 1}}}});
  EXPECT_THAT(svg, Not(HasSubstr("<script>")));
  EXPECT_THAT(svg, HasSubstr("a_b^2"));
  EXPECT_THAT(svg, HasSubstr("'quoted'"));
  EXPECT_THAT(svg, HasSubstr("`date`"));
  EXPECT_THAT(svg, HasSubstr("äöü"));
}

TEST(Plot, DrawsAroundWhatIsNotFinite) {
  EXPECT_THAT(draw({.curves = {{.x = {0, 1, 2, 3, 4},
                                .y = {0, 1, nothing, 3, std::numeric_limits<double>::infinity()}}}}),
              HasSubstr("</svg>"));
}

TEST(Plot, SaysWhatGnuplotComplainsOf) {
  EXPECT_THROW((void)draw({.title = "nothing to draw", .curves = {{.x = {}, .y = {}}}}), std::runtime_error);
}

TEST(Decimated, KeepsASpikeOfOneSample) {
  Curve curve;
  for (int i = 0; i < 1'000'000; ++i) {
    curve.x.push_back(i);
    curve.y.push_back(std::sin(1e-5 * i));
  }
  curve.y[543'210] = 40.0;
  curve.y[123'456] = -40.0;
  const Curve fewer = decimated(curve);
  EXPECT_LE(fewer.x.size(), 4000U);
  EXPECT_EQ(*std::max_element(fewer.y.begin(), fewer.y.end()), 40.0);
  EXPECT_EQ(*std::min_element(fewer.y.begin(), fewer.y.end()), -40.0);
  EXPECT_TRUE(std::is_sorted(fewer.x.begin(), fewer.x.end()));
  EXPECT_EQ(fewer.x.front(), 0.0);
  EXPECT_EQ(fewer.x.back(), 999'999.0);
}

TEST(Decimated, LeavesAShortCurveAlone) {
  const Curve curve{.x = {0, 1, 2}, .y = {5, nothing, 7}};
  EXPECT_EQ(decimated(curve).x, curve.x);
}

TEST(DecimatedRows, KeepTheExtremesOfEveryColumn) {
  std::vector<double> position(100'000);
  std::vector<double> force(100'000);
  for (std::size_t i = 0; i < position.size(); ++i) position[i] = std::sin(1e-4 * static_cast<double>(i));
  position[31'234] = 5.0;
  position[31'235] = -5.0;
  force[77'777] = 9.0;
  force[77'778] = -9.0;
  force[0] = std::nan("");
  const auto points = decimated_rows({position, force}, 600);
  EXPECT_LE(points.size(), 600U);
  for (const std::size_t row : {0U, 31'234U, 31'235U, 77'777U, 77'778U, 99'999U}) {
    EXPECT_THAT(points, testing::Contains(row));
  }
  EXPECT_TRUE(std::is_sorted(points.begin(), points.end()));
}

TEST(DecimatedRows, AreAllWhereTheyAreFew) {
  const std::vector<double> values{1.0, 2.0, 3.0};
  const std::vector<double> nobody;
  EXPECT_THAT(decimated_rows({values, values}, 600), testing::ElementsAre(0, 1, 2));
  EXPECT_TRUE(decimated_rows({nobody, nobody}, 600).empty());
}

TEST(Thinned, KeepsEverySoManyPointsOfACloud) {
  Curve cloud;
  for (int i = 0; i < 1000; ++i) {
    cloud.x.push_back(i);
    cloud.y.push_back(-i);
  }
  const Curve fewer = thinned(cloud, 300);
  EXPECT_EQ(fewer.x.size(), 334U);
  EXPECT_EQ(fewer.x[7], 21.0);
  EXPECT_EQ(fewer.y[7], -21.0);
  EXPECT_EQ(thinned(cloud, 4000).x, cloud.x);
}

}  // namespace
}  // namespace kerf::bench
