#include "import/decimal.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

/// What is read, and how many characters of it.
struct Read {
  double value = -7.0;
  std::size_t length = 0;
};

Read read(const std::string& text, char point = '.') {
  Read result;
  const char* end = parse_decimal(text.data(), text.data() + text.size(), point, result.value);
  result.length = static_cast<std::size_t>(end - text.data());
  return result;
}

TEST(Decimal, IsTheNearestDoubleBitForBit) {
  std::mt19937_64 random(11);
  std::uniform_int_distribution<int> digits(1, 19);
  std::uniform_int_distribution<int> few_digits(0, 15);
  std::uniform_int_distribution<int> exponent(-30, 30);
  std::uniform_real_distribution<double> mantissa(-10.0, 10.0);
  for (int i = 0; i < 100'000; ++i) {
    char text[64];
    const double value = mantissa(random);
    if (i % 3 == 2) {
      std::snprintf(text, sizeof text, "%.*e", few_digits(random), value * std::pow(10.0, exponent(random)));
    } else if (i % 3 == 0) {
      std::snprintf(text, sizeof text, "%.*e", digits(random), value * std::pow(10.0, exponent(random)));
    } else {
      std::snprintf(text, sizeof text, "%.*f", digits(random) % 17,
                    value * std::pow(10.0, digits(random) % 8));
    }
    const Read result = read(text);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(result.value),
              std::bit_cast<std::uint64_t>(std::strtod(text, nullptr)))
        << text;
    ASSERT_EQ(result.length, std::string(text).size()) << text;
  }
}

TEST(Decimal, TakesWhatInstrumentsWrite) {
  EXPECT_EQ(read("+1.5").value, 1.5);
  EXPECT_EQ(read(".5").value, 0.5);
  EXPECT_EQ(read("5.").value, 5.0);
  EXPECT_EQ(read("-0").value, 0.0);
  EXPECT_TRUE(std::signbit(read("-0").value));
  EXPECT_EQ(read("1e3").value, 1000.0);
  EXPECT_EQ(read("1.25E-2").value, 0.0125);
  EXPECT_EQ(read("-3,25", ',').value, -3.25);
  EXPECT_EQ(read("3,25e1", ',').value, 32.5);
  EXPECT_TRUE(std::isnan(read("NaN").value));
  EXPECT_EQ(read("-inf").value, -INFINITY);
  EXPECT_EQ(read("1e00005").value, 1e5);
  EXPECT_EQ(read("00000000000000000000001.5").value, 1.5);
}

TEST(Decimal, BeyondTheRangeOfADoubleIsInfinityOrZero) {
  EXPECT_EQ(read("1e400").value, INFINITY);
  EXPECT_EQ(read("-1e400").value, -INFINITY);
  EXPECT_EQ(read("1e99999999999999999999").value, INFINITY);
  EXPECT_EQ(read("1e-400").value, 0.0);
  EXPECT_EQ(read("1e-400").length, 6U);
  EXPECT_EQ(read("4.9e-324").value, 4.9e-324);
  EXPECT_EQ(read("3,5e-400", ',').length, 8U);
}

TEST(Decimal, StopsWhereTheNumberEnds) {
  EXPECT_EQ(read("12;7").length, 2U);
  EXPECT_EQ(read("1.5.2").length, 3U);
  EXPECT_EQ(read("1,5", '.').length, 1U);
  EXPECT_EQ(read("1.5", ',').length, 1U);
  EXPECT_EQ(read("12345678901234567890,5", '.').length, 20U);
  EXPECT_EQ(read("12345678901234567890.5", ',').length, 20U);
  EXPECT_EQ(read("1e").length, 1U);
  EXPECT_EQ(read("1e+").length, 1U);
}

TEST(Decimal, TakesNothingFromWhatIsNoNumber) {
  for (const auto* text : {"", "-", "+", ".", "abc", "e5", "--1", "+-1", "-+1", "++1", " 1"}) {
    EXPECT_EQ(read(text).length, 0U) << text;
    EXPECT_EQ(read(text).value, -7.0) << text;
  }
}

}  // namespace
}  // namespace kerf::bench
