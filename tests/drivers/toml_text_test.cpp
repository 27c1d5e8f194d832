#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <kerf/drivers/toml_text.h>

namespace kerf::drivers {
namespace {

TEST(TomlText, IsReadAsItWasWritten) {
  for (const std::string text : {"", "a", "\nbegins a line", "two\nlines", "\r\n", "ends\n",
                                 "it's \"quoted\"", "back\\slash", "tab\t", "N·m", "'''", "\x7f"}) {
    const std::string written = toml_text(text);
    EXPECT_EQ(written.find('\n'), std::string::npos) << written;
    EXPECT_EQ(toml::parse("key = " + written)["key"].value<std::string>(), text) << written;
  }
}

TEST(TomlNumber, IsReadAsTheSameBits) {
  for (const double number :
       {0.0, -0.0, 1.0, -1.0, 0.1, 1.0 / 3.0, 1e16, -1e300, 5e-324, 123456789012345678.0,
        std::numeric_limits<double>::max(), std::numeric_limits<double>::infinity()}) {
    const auto read = toml::parse("key = " + toml_number(number))["key"].value<double>();
    ASSERT_TRUE(read.has_value()) << toml_number(number);
    EXPECT_EQ(*read, number);
    EXPECT_EQ(std::signbit(*read), std::signbit(number)) << toml_number(number);
  }
}

}  // namespace
}  // namespace kerf::drivers
