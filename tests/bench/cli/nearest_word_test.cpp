#include "program/nearest_word.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::Eq;
using testing::Optional;

TEST(NearestWord, KnowsALetterTooManyMissingWrongOrSwapped) {
  const std::vector<std::string> words{"fit", "info", "new", "record", "report"};
  EXPECT_THAT(nearest_word("fitt", words), Optional(Eq("fit")));
  EXPECT_THAT(nearest_word("inf", words), Optional(Eq("info")));
  EXPECT_THAT(nearest_word("recerd", words), Optional(Eq("record")));
  EXPECT_THAT(nearest_word("nwe", words), Optional(Eq("new")));
}

TEST(NearestWord, AllowsOneSlipInThreeLetters) {
  EXPECT_THAT(nearest_word("reqprt", {"report"}), Optional(Eq("report")));
  EXPECT_EQ(nearest_word("rexqxt", {"report"}), std::nullopt);
  EXPECT_EQ(nearest_word("it", {"fit"}), std::nullopt) << "two letters say too little";
  EXPECT_EQ(nearest_word("fit", {}), std::nullopt);
}

TEST(NearestWord, TakesTheNearestOfSeveral) {
  EXPECT_THAT(nearest_word("repore", {"record", "report"}), Optional(Eq("report")));
}

}  // namespace
}  // namespace kerf::bench
