#include "files/for_terminal.h"

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace kerf::bench {
namespace {

const std::string override_and_c1 = "\u202E\u0085";

TEST(ForTerminal, LeavesPlainTextAsItIs) {
  const std::string plain = "a\tb\nN·m µ 位移 \U0001F52A \u202F\u2065\u206A\u00A0~ \\u001b";
  EXPECT_EQ(for_terminal(plain), plain);
  EXPECT_EQ(for_terminal(""), "");
}

TEST(ForTerminal, WritesWhatSteersAsItsNumber) {
  EXPECT_EQ(for_terminal("\x1b[2J\x1b]0;x\x07"), "\\u001b[2J\\u001b]0;x\\u0007");
  EXPECT_EQ(for_terminal(std::string("\0\r\b\x7f", 4)), "\\u0000\\u000d\\u0008\\u007f");
  EXPECT_EQ(for_terminal("\u0080\u009B\u009F"), "\\u0080\\u009b\\u009f");
  EXPECT_EQ(for_terminal("\u202A\u202E\u2066\u2069"), "\\u202a\\u202e\\u2066\\u2069");
}

TEST(ForTerminal, MarksWhatIsNoUtf8) {
  EXPECT_EQ(for_terminal("\x9b[2J"), "\uFFFD[2J") << "CSI of a terminal with eight bits";
  EXPECT_EQ(for_terminal("\xC0\x9B \xE2\x80"), "\uFFFD\uFFFD \uFFFD\uFFFD");
  EXPECT_EQ(for_terminal("\xF4\x8F\xBF"), "\uFFFD\uFFFD\uFFFD");
}

TEST(ForTerminal, LeavesJsonTheSame) {
  const nlohmann::json json{{"a\x1b", override_and_c1}, {"b", "\\u001b \x7f"}};
  EXPECT_EQ(nlohmann::json::parse(for_terminal(json.dump())), json);
  EXPECT_EQ(for_terminal(json.dump()).find_first_of("\x7f\u202E"), std::string::npos);
}

TEST(JsonForPage, ShowsNumbersInStrings) {
  const nlohmann::json json{{"name", override_and_c1 + "\x1b\n\t\"\\"}, {"plain", "\\u001b N·m"}};
  const nlohmann::json shown{{"name", "\\u202e\\u0085\\u001b\n\t\"\\"}, {"plain", "\\u001b N·m"}};
  EXPECT_EQ(nlohmann::json::parse(json_for_page(json.dump())), shown);
  EXPECT_EQ(nlohmann::json::parse(json_for_page(json.dump(-1, ' ', true))), shown) << "in ASCII";
  for (const char* odd : {"\\", "\\u", "\\u00", "\\u001"}) EXPECT_EQ(json_for_page(odd), odd);
}

}  // namespace
}  // namespace kerf::bench
