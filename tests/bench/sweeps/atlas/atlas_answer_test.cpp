#include "atlas/atlas_answer.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sweeps/atlas/merged_walls.h"

namespace kerf::bench {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

class Atlas : public test::MergedWalls {
 protected:
  /// 19 cells of 20: the energy is the number of the cell, of cell 4 nobody knows it.
  [[nodiscard]] std::filesystem::path usual() const {
    return merged(first(19), [](std::size_t cell) {
      const auto number = static_cast<double>(cell);
      return Numbers{.energy = cell == 4 ? unknown : number, .lower = number - 1.0, .upper = number + 1.0};
    });
  }
  static AtlasQuestion asked(const json& question) { return question_from_json(question); }
  static std::string refusal(SweepAtlas& atlas, const json& question) {
    try {
      (void)answer(atlas, asked(question));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "nothing";
  }
};

TEST_F(Atlas, CountsWhatIsBehindEachTileAndTakesNoFailedOrMissingCellForAValue) {
  const auto folder =
      merged(first(18), [](std::size_t cell) { return Numbers{.energy = static_cast<double>(cell)}; });
  fail(19);
  SweepAtlas atlas(folder);
  EXPECT_THAT(atlas.tables().at(0).failed, ElementsAre(19U));
  EXPECT_THAT(atlas.tables().at(0).missing, ElementsAre(18U));
  const AtlasAnswer found =
      answer(atlas, asked({{"table", "walls"}, {"by", {"stiffness", "mass"}}, {"of", "energy"}}));
  ASSERT_EQ(found.tiles.size(), 20U);
  EXPECT_EQ(found.axes[0].parts(), 10U);
  EXPECT_EQ(found.axes[1].values, (std::vector<double>{0.05, 0.1}));
  EXPECT_EQ(found.tiles[17].value, 17.0);
  EXPECT_EQ(found.tiles[17].computed, 1U);
  EXPECT_THAT(found.tiles[18].value, IsNan());
  EXPECT_EQ(found.tiles[18].missing, 1U);
  EXPECT_THAT(found.tiles[19].value, IsNan());
  EXPECT_EQ(found.tiles[19].failed, 1U);
  EXPECT_EQ(found.all.computed, 18U);
}

TEST_F(Atlas, KnowsTheStatisticsOfATile) {
  SweepAtlas atlas(usual());
  const auto of_first_mass = [&](const char* statistic) {
    const json question{{"table", "walls"}, {"by", {"mass"}}, {"of", "energy"}, {"statistic", statistic}};
    return answer(atlas, asked(question)).tiles.at(0);
  };
  // 0 to 9 without 4
  EXPECT_EQ(of_first_mass("mean").known, 9U);
  EXPECT_EQ(of_first_mass("mean").computed, 10U);
  EXPECT_NEAR(of_first_mass("mean").value, 41.0 / 9.0, 1e-12);
  EXPECT_EQ(of_first_mass("median").value, 5.0);
  EXPECT_EQ(of_first_mass("smallest").value, 0.0);
  EXPECT_EQ(of_first_mass("largest").value, 9.0);
}

TEST_F(Atlas, TakesTheMiddleOfTwoForAMedianOfAnEvenNumber) {
  SweepAtlas atlas(usual());
  const AtlasAnswer found = answer(
      atlas, asked({{"table", "walls"}, {"by", json::array()}, {"of", "energy"}, {"statistic", "median"}}));
  EXPECT_EQ(found.tiles.at(0).known, 18U);
  EXPECT_EQ(found.tiles.at(0).value, 9.5);
}

TEST_F(Atlas, SharesAreOfCellsWhereAllIsKnown) {
  SweepAtlas atlas(usual());
  const AtlasAnswer found = answer(
      atlas,
      asked({{"table", "walls"}, {"by", {"mass"}}, {"share", "lower <= 3 & upper >= 3 & energy < upper"}}));
  // Cells 2, 3 and 4 hold 3; of 4 the energy is not known.
  EXPECT_EQ(found.tiles[0].known, 9U);
  EXPECT_NEAR(found.tiles[0].value, 2.0 / 9.0, 1e-12);
  EXPECT_EQ(found.tiles[1].value, 0.0);
  EXPECT_EQ(found.unit, "1");
}

TEST_F(Atlas, AnIntervalWithoutALimitHoldsWhatIsBeyond) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  SweepAtlas atlas(
      merged(first(20), [&](std::size_t) { return Numbers{.lower = -infinite, .upper = infinite}; }));
  const AtlasAnswer found =
      answer(atlas, asked({{"table", "walls"}, {"by", json::array()}, {"share", "lower <= 3 & upper >= 3"}}));
  EXPECT_EQ(found.tiles[0].value, 1.0);
  EXPECT_EQ(found.tiles[0].known, 20U);
}

TEST_F(Atlas, FiltersByTextsOfInputsAndByRangesOfResults) {
  const auto folder = usual();
  SweepAtlas atlas(folder);
  const json by_mass{
      {"table", "walls"}, {"by", json::array()}, {"of", "energy"}, {"where", {{"mass", {"0.1"}}}}};
  EXPECT_EQ(answer(atlas, asked(by_mass)).all.computed, 9U);
  EXPECT_EQ(answer(atlas, asked(by_mass)).all.missing, 1U);
  const json by_range{
      {"table", "walls"}, {"by", json::array()}, {"of", "energy"}, {"where", {{"energy", {2.5, nullptr}}}}};
  // A missing cell has no energy to be in the range.
  EXPECT_EQ(answer(atlas, asked(by_range)).all.cells(), 15U);
}

TEST_F(Atlas, HasNoPartForAValueThatAFilterKeepsOut) {
  SweepAtlas atlas(usual());
  const AtlasAnswer found = answer(atlas, asked({{"table", "walls"},
                                                 {"by", {"mass", "stiffness"}},
                                                 {"of", "energy"},
                                                 {"where", {{"mass", {"0.1"}}}}}));
  EXPECT_THAT(found.axes[0].values, ElementsAre(0.1));
  ASSERT_EQ(found.tiles.size(), 10U);
  EXPECT_EQ(found.tiles[0].value, 10.0);
}

TEST_F(Atlas, PartsAResultIntoStretches) {
  SweepAtlas atlas(usual());
  const AtlasAnswer found =
      answer(atlas, asked({{"table", "walls"}, {"by", {"energy"}}, {"of", "energy"}, {"bins", 3}}));
  EXPECT_THAT(found.axes[0].edges, ElementsAre(0.0, 6.0, 12.0, 18.0));
  EXPECT_EQ(found.tiles[0].computed, 5U);  // 0 to 5 without 4
  EXPECT_EQ(found.tiles[2].computed, 7U);  // 12 to 18, both ends
}

TEST_F(Atlas, SaysInALineWhatItDoesNotHave) {
  SweepAtlas atlas(usual());
  EXPECT_THAT(refusal(atlas, {{"table", "fits"}, {"by", {"mass"}}, {"of", "energy"}}),
              HasSubstr("has no table 'fits'; it has walls"));
  EXPECT_THAT(refusal(atlas, {{"table", "walls"}, {"by", {"colour"}}, {"of", "energy"}}),
              HasSubstr("walls has no column 'colour'; it has mass,"));
  EXPECT_THAT(refusal(atlas, {{"table", "walls"}, {"by", {"mass"}}, {"of", "grip"}}),
              HasSubstr("grip is a text"));
  EXPECT_THAT(refusal(atlas, {{"table", "walls"}, {"by", {"mass"}}, {"share", "energy is 3"}}),
              HasSubstr("'energy is 3' is no condition"));
  EXPECT_THAT(refusal(atlas, {{"table", "walls"}, {"by", {"mass"}}}), HasSubstr("'of' or 'share'"));
  EXPECT_THAT(
      refusal(atlas,
              {{"table", "walls"}, {"by", {"mass"}}, {"of", "energy"}, {"where", {{"mass", {"0.3"}}}}}),
      HasSubstr("mass has no value '0.3' in this sweep"));
}

TEST_F(Atlas, SamplesTheSameCellsForEver) {
  SweepAtlas atlas(usual());
  const AtlasQuestion question = asked({{"table", "walls"}, {"by", json::array()}, {"of", "energy"}});
  const AtlasSample all = sample(atlas, question, {"mass", "energy"}, 100);
  EXPECT_EQ(all.of, 20U);
  ASSERT_EQ(all.state.size(), 20U);
  EXPECT_EQ(all.state.back(), "missing");
  EXPECT_EQ(all.columns[0].texts, (std::vector<std::string>{"0.05", "0.1"}));
  EXPECT_EQ(all.values[0].front(), 0.0) << "the place of 0.05";
  EXPECT_EQ(all.values[0].back(), 1.0);
  EXPECT_THAT(all.values[1].back(), IsNan());
  const AtlasSample some = sample(atlas, question, {"energy"}, 10);
  EXPECT_GT(some.state.size(), 3U);
  EXPECT_LT(some.state.size(), 17U);
  EXPECT_EQ(some.state, sample(atlas, question, {"energy"}, 10).state);
}

TEST_F(Atlas, IsRefusedWhereThereIsNoPlan) {
  {
    schema::SweepTablesWriter writer(file("sweep.h5"));
    for (const char* const name : {"plan_sha256", "plan", "software", "cells"}) writer.describe(name, "?");
    writer.commit(schema::Existing::keep);
  }
  EXPECT_THAT([&] { const SweepAtlas atlas(file("sweep.h5")); },
              testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("its plan is none")));
  EXPECT_TRUE(is_merged_sweep(file("sweep.h5")));
}

}  // namespace
}  // namespace kerf::bench
