#include "tables/csv.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

TEST(CsvText, IsQuotedOnlyWhereItMustBe) {
  EXPECT_EQ(csv_text("liver"), "liver");
  EXPECT_EQ(csv_text("soft; then firm"), "soft; then firm");
  EXPECT_EQ(csv_text("liver, raw"), "\"liver, raw\"");
  EXPECT_EQ(csv_text("#1"), "\"#1\"");
  EXPECT_EQ(csv_text("5\" foam"), "\"5\"\" foam\"");
  EXPECT_EQ(csv_quoted("theta"), "\"theta\"");
}

TEST(CsvText, StaysInOneLine) { EXPECT_EQ(csv_text("two\nlines"), "\"two lines\""); }

TEST(CsvText, IsReadAgain) {
  const std::string text = R"(a "cold", "raw" one)";
  const std::string cell = csv_text(text);
  EXPECT_EQ(csv_unquoted(std::string_view(cell).substr(1, cell.size() - 2)), text);
}

TEST(CsvNumber, IsTheDoubleToItsLastDigitOrNothing) {
  EXPECT_EQ(csv_number(0.1), "0.1");
  EXPECT_EQ(csv_number(1.0 / 3.0), "0.3333333333333333");
  EXPECT_EQ(csv_number(1.0 / 3.0, 6), "0.333333");
  EXPECT_EQ(csv_number(std::nan("")), "");
  EXPECT_EQ(csv_number(INFINITY, 6), "");
}

}  // namespace
}  // namespace kerf::bench
