#include "files/json_number.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

const std::vector<double> some{1.0, std::nan(""), 1.0 / 3.0, -INFINITY};

TEST(JsonNumber, IsNullWhereThereIsNone) {
  EXPECT_EQ(json_number(2.5), 2.5);
  EXPECT_TRUE(json_number(INFINITY).is_null());
  EXPECT_TRUE(json_number(std::optional<double>()).is_null());
  EXPECT_EQ(json_numbers(some).dump(), "[1.0,null,0.3333333333333333,null]");
  EXPECT_EQ(json_numbers(std::vector<double>()).dump(), "[]");
}

TEST(JsonNumber, IsWrittenIntoATextWithSixDigits) {
  std::string text = "x:";
  append_json_numbers(text, some);
  append_json_numbers(text, {});
  EXPECT_EQ(text, "x:[1,null,0.333333,null][]");
}

}  // namespace
}  // namespace kerf::bench
