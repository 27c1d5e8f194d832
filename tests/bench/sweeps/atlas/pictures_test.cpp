// Pictures of a sweep, as a file asks for them and as `kerf report` draws them.

#include <algorithm>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "atlas/pictures/atlas_picture.h"
#include "atlas/pictures/draw_picture.h"
#include "bench/sweeps/atlas/merged_walls.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

class SweepPictures : public test::MergedWalls {
 protected:
  [[nodiscard]] std::filesystem::path usual() const {
    return merged(first(18), [](std::size_t cell) {
      return Numbers{.energy = static_cast<double>(cell), .lower = 0.0, .upper = static_cast<double>(cell)};
    });
  }
  [[nodiscard]] std::string refusal(const std::string& toml) const {
    test::write_text(file("p.toml"), toml);
    try {
      (void)read_pictures(file("p.toml"));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "nothing";
  }
  static std::size_t count(const std::string& text, const std::string& what) {
    std::size_t found = 0;
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
    return found;
  }
};

TEST_F(SweepPictures, AreDrawnAsAFileSays) {
  const auto folder = usual();
  fail(19);
  test::write_text(file("p.toml"), R"(version = 1
[[picture]]
name = "map"
title = "Energies"
table = "walls"
x = "stiffness"
y = "mass"
of = "energy"
steps = [0, 5, 10, 20]

[[picture]]
name = "line"
kind = "lines"
title = "Shares"
table = "walls"
x = "stiffness"
by = "mass"
share = "upper >= 5"
nominal = 0.5
where = { stiffness = { from = 200 } }

[[picture]]
name = "shares"
kind = "shares"
title = "Two"
table = "walls"
[[picture.shares]]
name = "light"
at = "all"
share = "upper >= 5"
where = { mass = 0.05 }
[[picture.shares]]
name = "heavy"
at = "all"
share = "upper >= 5"
where = { mass = [0.1] }

[[picture]]
name = "parallel"
kind = "parallel"
title = "Lines"
table = "walls"
columns = ["mass", "stiffness", "energy"]
of = "energy"
)");
  const auto page = file("w.html");
  const test::Outcome outcome =
      test::run_kerf({"report", folder.string(), "--pictures", file("p.toml").string(), "--figures",
                      file("figures").string(), "-o", page.string(), "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto said = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(said.at("pictures").at(0).at("caption"),
            "20 cells, 1 behind each tile; 1 failed; 1 are missing.");
  EXPECT_THAT(said.at("pictures").at(2).at("caption").get<std::string>(),
              HasSubstr("20 cells, 10 behind each point; 1 failed; 1 are missing."));
  const std::string html = test::read_text(page);
  EXPECT_THAT(html, HasSubstr("Of 20 cells some failed or are missing"));
  EXPECT_EQ(count(html, "<svg"), 4U);
  const std::string map = test::read_text(file("figures/map.svg"));
  EXPECT_THAT(map, HasSubstr("mean energy [J]"));
  EXPECT_THAT(map, HasSubstr("× cells failed"));
  EXPECT_THAT(map, HasSubstr("○ cells are missing"));
  EXPECT_THAT(map, HasSubstr("stiffness [N/m]"));
  EXPECT_THAT(test::read_text(file("figures/parallel.svg")), HasSubstr("no number"));
}

TEST_F(SweepPictures, AreUsualOnesWhereNobodySaysWhich) {
  const auto folder = usual();
  SweepAtlas atlas(folder);
  const auto pictures = usual_pictures(atlas);
  ASSERT_FALSE(pictures.empty());
  EXPECT_EQ(pictures.front().question.by, (std::vector<std::string>{"stiffness", "mass"}));
  EXPECT_EQ(pictures.back().kind, AtlasPicture::Kind::parallel);
  const test::Outcome outcome = test::run_kerf({"report", folder.string(), "-o", file("w.html").string()});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(test::read_text(file("w.html")), Not(HasSubstr("<script")));
}

TEST_F(SweepPictures, AreRefusedWithFileAndLine) {
  EXPECT_THAT(refusal("version = 1\n"), HasSubstr("expected [[picture]]"));
  const std::string head = "version = 1\n[[picture]]\ntable = \"walls\"\n";
  EXPECT_THAT(refusal(head + "x = \"mass\"\nof = \"energy\"\n"), HasSubstr("p.toml:2: a map needs 'y'"));
  EXPECT_THAT(refusal(head + "x = \"mass\"\ny = \"mass\"\n"), HasSubstr("either 'of', a column, or 'share'"));
  EXPECT_THAT(refusal(head + "x = \"mass\"\ny = \"mass\"\nshare = \"energy\"\n"),
              HasSubstr("p.toml:6: 'energy' is no condition"));
  EXPECT_THAT(refusal(head + "kind = \"pie\"\n"),
              HasSubstr("p.toml:4: 'kind' is map, lines, shares or parallel"));
  EXPECT_THAT(refusal(head + "x = \"mass\"\ny = \"mass\"\nof = \"energy\"\nsteps = [2, 1]\n"),
              HasSubstr("p.toml:7: 'steps' increase"));
  EXPECT_THAT(refusal(head + "colour = 1\n"), HasSubstr("colour"));
}

TEST_F(SweepPictures, AreOfASweepAndResultsOfARecording) {
  const auto folder = usual();
  const test::Outcome beside =
      test::run_kerf({"report", folder.string(), folder.string(), "-o", file("w.html").string()});
  EXPECT_EQ(beside.exit_status, 2);
  EXPECT_THAT(beside.errors, HasSubstr("a sweep takes no results"));
  schema::write_recording(file("r.h5"), test::punch({.seconds = 1.0}));
  const test::Outcome recording = test::run_kerf(
      {"report", file("r.h5").string(), "--figures", file("f").string(), "-o", file("w.html").string()});
  EXPECT_EQ(recording.exit_status, 2);
  EXPECT_THAT(recording.errors, HasSubstr("--pictures and --figures are for a sweep"));
}

}  // namespace
}  // namespace kerf::bench
