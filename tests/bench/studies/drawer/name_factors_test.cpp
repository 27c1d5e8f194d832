#include "drawer/name_factors.h"

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

// Names of [Okamura2003], as their files lie.
TEST(NameFactors, AreTheWordsThatAreNoNumbers) {
  const NameFactors tendon = name_factors("14_quadriceps_tendon_fast_1853.txt");
  EXPECT_EQ(tendon.tissue, "quadriceps tendon");
  EXPECT_EQ(tendon.speed, "fast");
  EXPECT_EQ(tendon.specimen, "");
  EXPECT_EQ(tendon.numbers, "14 1853");
  EXPECT_FALSE(tendon.blank);
  const NameFactors blank = name_factors("7_blank_slow_1819.txt");
  EXPECT_TRUE(blank.blank);
  EXPECT_EQ(blank.tissue, "");
  EXPECT_EQ(blank.speed, "slow");
}

TEST(NameFactors, OfFoldersCountToo) {
  const NameFactors liver = name_factors("Liver/donor2/5mms/run03.csv");
  EXPECT_EQ(liver.tissue, "liver");
  EXPECT_EQ(liver.specimen, "donor2");
  EXPECT_EQ(liver.speed, "5mms");
  EXPECT_EQ(liver.numbers, "run03");
}

TEST(NameFactors, NameTheRig) {
  const NameFactors liver = name_factors("rig2/liver_slow.csv");
  EXPECT_EQ(liver.rig, "rig2");
  EXPECT_EQ(liver.tissue, "liver");
}

TEST(NameFactors, TakeASpecimenWordAlone) {
  EXPECT_EQ(name_factors("skin_s3.txt").specimen, "s3");
  EXPECT_EQ(name_factors("skin_s.txt").tissue, "skin s");
}

}  // namespace
}  // namespace kerf::bench
