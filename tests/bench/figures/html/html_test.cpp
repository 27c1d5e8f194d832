#include "html/html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

TEST(Html, EscapesWhatHasAMeaning) {
  EXPECT_EQ(escaped("a<b>&\"c'"), "a&lt;b&gt;&amp;&quot;c&#39;");
  EXPECT_EQ(escaped("N·s/m"), "N·s/m");
}

TEST(Html, TablesEscapeTheirCells) {
  EXPECT_THAT(html_table({{"head"}, {"<td>"}}),
              testing::AllOf(testing::HasSubstr("<th>head</th>"), testing::HasSubstr("<td>&lt;td&gt;</td>")));
}

TEST(Html, APageHasItsTitleAndItsLanguage) {
  EXPECT_THAT(
      html_page("R&D", "<p>x</p>"),
      testing::AllOf(testing::StartsWith("<!DOCTYPE html>"), testing::HasSubstr("<title>R&amp;D</title>"),
                     testing::HasSubstr("lang=\"en\""), testing::HasSubstr("<p>x</p>")));
}

TEST(Html, LetsNothingRunOrBeLoaded) {
  EXPECT_THAT(html_page("x", ""), testing::HasSubstr("<meta http-equiv=\"Content-Security-Policy\" "
                                                     "content=\"default-src 'none'; style-src "
                                                     "'unsafe-inline'; img-src data:\">"));
  EXPECT_THAT(html_page("x", ""), testing::Not(testing::HasSubstr("<script")));
}

TEST(Html, ShowsWhatWouldReorderALine) { EXPECT_EQ(escaped("a\u202E\x1b"), "a\\u202e\\u001b"); }

}  // namespace
}  // namespace kerf::bench
