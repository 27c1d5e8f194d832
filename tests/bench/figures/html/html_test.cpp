#include "html/html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "html/zoom.h"

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

TEST(Html, LetsRunTheScriptOfThePageAndNoOther) {
  const std::string page = page_with_script("x", "", "alert(1)");
  EXPECT_THAT(page, testing::HasSubstr("<script>alert(1)</script>"));
  // By Python: base64.b64encode(hashlib.sha256(b"alert(1)").digest())
  EXPECT_THAT(
      page,
      testing::HasSubstr(
          "default-src 'none'; script-src 'sha256-bhHHL3z2vDgxUt0W3dWQOrprscmda2Y5pLsLg4GF+pI='; style-src"));
}

TEST(Html, AFigureToZoomHoldsItsNumbersOnceAndAsJson) {
  const Chart chart{.title = "</script> & \"",
                    .x_label = "time [s]",
                    .y_label = "force [N]",
                    .curves = {{.label = "a", .x = {0.0, 0.125}, .y = {1.0, line_break}},
                               {.label = "b", .x = {0.0, 0.125}, .y = {1.0 / 3.0, 2.0}},
                               {.label = "c", .x = {0.5}, .y = {3.0}, .colour = Colour::blue}},
                    .bands = {{.begin = 0.1, .end = 0.2}},
                    .vertical = {{.at = 0.1, .label = "first"}}};
  const std::string html = html_zoom_figure("<svg/>", std::vector{chart});
  const std::string begin = "<figure class=\"zoom\"><svg/><script type=\"application/json\">";
  const std::string end = "</script></figure>\n";
  ASSERT_THAT(html, testing::AllOf(testing::StartsWith(begin), testing::EndsWith(end)));
  const auto data = nlohmann::json::parse(html.substr(begin.size(), html.size() - begin.size() - end.size()));
  EXPECT_EQ(html.find("</script>"), html.size() - end.size()) << "no title ends the data";
  EXPECT_EQ(data.at(0).at("title"), chart.title);
  const auto& curves = data.at(0).at("curves");
  EXPECT_EQ(curves.at(0).at("y"), nlohmann::json({1.0, nullptr}));
  EXPECT_TRUE(curves.at(1).at("x").is_null()) << "those of the curve before";
  EXPECT_EQ(curves.at(1).at("y"), nlohmann::json({0.3333333, 2.0}));
  EXPECT_EQ(curves.at(2).at("x"), nlohmann::json({0.5}));
  EXPECT_EQ(curves.at(2).at("colour"), "#0072B2");
  EXPECT_EQ(data.at(0).at("vertical").at(0).at("at"), 0.1);
}

TEST(Html, ShowsWhatWouldReorderALine) { EXPECT_EQ(escaped("a\u202E\x1b"), "a\\u202e\\u001b"); }

}  // namespace
}  // namespace kerf::bench
