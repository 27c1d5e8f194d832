#include "stability/map_pictures.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plot/chart_json.h"
#include "stability/study.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using nlohmann::ordered_json;
using testing::ElementsAre;

/// A map of three cells a side, as an earlier version wrote it.
ordered_json older(const std::string& name) {
  return ordered_json::parse(
      test::read_text(std::string(KERF_SOURCE_DIR) + "/tests/bench/analysis/stability/" + name));
}

TEST(MapPictures, ShowTheCellsThatAnEarlierVersionWrote) {
  for (const auto* name : {"older_wall.json", "older_law.json"}) {
    const ordered_json study = older(name);
    const Chart picture = map_picture(study).value();
    ASSERT_EQ(picture.cells.kind.size(), study["cells"].size());
    for (std::size_t i = 0; i < picture.cells.kind.size(); ++i) {
      const CellKind& kind = picture.cells.kinds.at(picture.cells.kind[i]);
      const ordered_json& cell = study["cells"][i];
      EXPECT_EQ(kind.colour == Colour::sky, cell["stable"].get<bool>()) << name << i;
      EXPECT_EQ(kind.dotted, cell["stable"] != cell["theory"]) << name << i;
    }
    EXPECT_EQ(picture.cells.x_edges.size(), 4U);
    EXPECT_EQ(picture.cells.y_edges.size(), 4U);
    EXPECT_EQ(picture.x_range.begin, picture.cells.x_edges.front());
    EXPECT_EQ(picture.y_range.end, picture.cells.y_edges.back());
  }
}

TEST(MapPictures, PutWallsUprightAndLawsAcross) {
  const ordered_json walls = older("older_wall.json");
  const Chart wall = map_picture(walls).value();
  EXPECT_TRUE(wall.cells.upwards);
  EXPECT_EQ(wall.y_range.end, walls["cells"][2]["K"]);
  EXPECT_EQ(wall.horizontal.at(0).at, walls["abbott_okamura"]);
  EXPECT_EQ(wall.vertical.at(0).label, "the device's own damping: 0.2 N·s/m");
  const Chart law = map_picture(older("older_law.json")).value();
  EXPECT_FALSE(law.cells.upwards);
  EXPECT_THAT(law.cells.x_edges, ElementsAre(testing::DoubleEq(20), testing::DoubleEq(30),
                                             testing::DoubleEq(50), testing::DoubleEq(60)));
  EXPECT_EQ(law.vertical.at(0).label, "asked for: 30 mm");
}

/// A page draws what the file beside the picture tells: the same figure but for the line that a page adds.
void expect_one_figure(const Findings& findings) {
  Chart of_json = map_picture(ordered_json::parse(findings.json.dump())).value();
  of_json.vertical.clear();
  EXPECT_EQ(chart_to_json(of_json), chart_to_json(findings.figures.at(0).chart));
}

TEST(MapPictures, AreTheSameOfAStudyAndOfItsFile) {
  StudyOptions options{.cells = 5};
  expect_one_figure(study_walls(options));
  options.range.depth_m = 0.02;
  const std::string law = std::string(KERF_SOURCE_DIR) + "/examples/exponential.law.toml";
  expect_one_figure(study_law(read_law_file(law), law, options).findings);
}

TEST(MapPictures, AreNoneWithoutCells) {
  StudyOptions options{.cells = 3};
  options.map.with_cells = false;
  EXPECT_FALSE(map_picture(study_walls(options).json));
  EXPECT_FALSE(map_picture({{"study", "cases"}}));
}

TEST(MapPictures, RefuseCellsThatAreNoGrid) {
  ordered_json study = older("older_wall.json");
  study["cells"].erase(study["cells"].size() - 1);
  EXPECT_THROW((void)map_picture(study), std::invalid_argument);
  study["cells"][0].erase("K");
  EXPECT_THROW((void)map_picture(study), nlohmann::json::exception);
}

}  // namespace
}  // namespace kerf::bench
