#include "drawer.h"

#include <gtest/gtest.h>

// A small part of `scripts/benchmark population`. The bounds are exact 99.9 % intervals of a share of 95 % of
// 300.
namespace kerf::population {
namespace {

constexpr int studies = 300;
constexpr int least = 271;

TEST(DrawerOfKnownTruth, IsHeldByTheIntervals) {
  Drawer drawer;
  drawer.between = {0.3, 0.3, 0.3};
  const Held held = coverage(drawer, studies, 5);
  for (const int count : {held.mean, held.between, held.within, held.next, held.tissues, held.speeds}) {
    EXPECT_GE(count, least);
    EXPECT_LT(count, studies) << "an interval that holds everything says nothing";
  }
}

TEST(DrawerOfKnownTruth, IsHeldWithoutSpreadBetweenThreeSpecimens) {
  Drawer drawer;
  drawer.between = {0.0, 0.0, 0.0};
  drawer.specimens = {3, 3, 3};
  const Held held = coverage(drawer, studies, 6);
  EXPECT_GE(held.mean, least);
  EXPECT_GE(held.between, least);
  EXPECT_GE(held.tissues, least);
}

TEST(DrawerOfKnownTruth, HasFewFalseAlarms) {
  CompareOptions options;
  options.draws = 199;
  options.most_exact = 300;
  const Found nothing = found(Drawer{}, 100, 3, options);
  EXPECT_LE(nothing.any, 13);  // of 100 at 5 %: more with less than one chance in a thousand
  Drawer apart;
  apart.specimens = {8, 8, 8};
  apart.tissues = {0.7, 0.0, 0.0};
  EXPECT_GE(found(apart, 50, 4).told_tissues, 40);
}

TEST(DrawerOfKnownTruth, RaisesFewAlarmsWhereSpecimensReactUnlikeEachOther) {
  CompareOptions options;
  options.draws = 199;
  options.most_exact = 300;
  Drawer reacting;
  reacting.specimens = {8, 8, 8};
  reacting.interaction = 0.2;
  EXPECT_LE(found(reacting, 100, 8, options).speeds, 13)
      << "a mean of differences would alarm twice as often";
}

}  // namespace
}  // namespace kerf::population
