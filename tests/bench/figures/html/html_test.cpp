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

}  // namespace
}  // namespace kerf::bench
