#include "import/preview.h"

#include <stdexcept>
#include <string>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Kind = PreviewLine::Kind;

class Preview : public testing::Test {
 protected:
  ImportHead head_of(const std::string& content, const std::string& name = "data.txt") {
    test::write_text(folder_ / name, content);
    return write_import_head(folder_ / name, head(), {.max_bytes = std::size_t{64} << 20U, .sheet = {}});
  }
  [[nodiscard]] ImportPreview look(const std::string& map, std::size_t most_lines = 40) const {
    ImportOptions options;
    if (!map.empty()) options.map = parse_map(map);
    return preview_import(head(), "data.txt", options, most_lines);
  }
  [[nodiscard]] std::filesystem::path head() const { return folder_ / "head"; }

  test::TemporaryFolder folder_;
};

std::string rows(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += fmt::format("{},{},{}\n", i, 0.5 * i, 2 * i % 7);
  return text;
}

TEST_F(Preview, ShowsWhatIsAboveTheNumbersAndWhichLinesAreNone) {
  (void)head_of(
      "a remark\nTime,Angle,Load\nms,deg,N\n0,1,2\n1,2,3\nbroken\n1,3,4\n2,4,5\n\n3,5,6\n4,6,7\n5,7,8\n");
  const ImportPreview preview = look("time=1,position=2,force=3");
  std::vector<Kind> kinds;
  for (const PreviewLine& line : preview.first) kinds.push_back(line.kind);
  EXPECT_THAT(kinds,
              ElementsAre(Kind::remark, Kind::names, Kind::units, Kind::data, Kind::data, Kind::no_data,
                          Kind::misplaced, Kind::data, Kind::empty, Kind::data, Kind::data, Kind::data));
  EXPECT_EQ(preview.first[5].number, 6U);
  EXPECT_THAT(preview.first[3].fields, ElementsAre("0", "1", "2"));
  EXPECT_EQ(preview.suggested, "time=1[ms],position=2[deg],force=3[N]");
  EXPECT_TRUE(preview.suggests_time);
  ASSERT_TRUE(preview.imported);
  EXPECT_EQ(preview.imported->recording.rows(), 6U);
  EXPECT_EQ(preview.problem, "");
}

TEST_F(Preview, SaysInOneLineWhyAMapDoesNotFit) {
  (void)head_of("t,x,F\n" + rows(20));
  EXPECT_THAT(look("time=1[s],position=2[mm],force=9[N]").problem, HasSubstr("asks for column '9'"));
  EXPECT_THAT(look("time=1[s],position=2").problem, HasSubstr("has no unit in the file"));
  EXPECT_THAT(look("position=2[mm]").problem, HasSubstr("maps no time"));
  EXPECT_FALSE(look("position=2[mm]").imported);
  EXPECT_EQ(look("").problem, "") << "nothing was asked for yet";
}

TEST_F(Preview, ReadsNoMoreOfALongTextThanItsBegin) {
  const std::string line = "0.001,0.002,0.003\n";
  std::string text = "t,x,F\n";
  while (text.size() < 3 * previewed_bytes) text += line;
  EXPECT_FALSE(head_of(text).is_whole);
  const std::string kept = test::read_text(head());
  EXPECT_LE(kept.size(), previewed_bytes);
  EXPECT_GT(kept.size(), previewed_bytes - line.size() - 1);
  EXPECT_EQ(kept.back(), '\n') << "no line is cut";
  EXPECT_EQ(kept, text.substr(0, kept.size()));
}

TEST_F(Preview, KeepsNoMoreLinesThanAreShownButTellsOfIrregularOnes) {
  (void)head_of("t,x,F\n" + rows(100) + "nonsense\n" + "100,1,1\n");
  const ImportPreview preview = look("time=1[s],position=2[mm],force=3[N]", 10);
  EXPECT_EQ(preview.first.size(), 10U);
  ASSERT_EQ(preview.irregular.size(), 1U);
  EXPECT_EQ(preview.irregular[0].number, 102U);
  EXPECT_EQ(preview.irregular[0].kind, Kind::no_data);
  EXPECT_THAT(preview.irregular[0].fields, ElementsAre("nonsense"));
}

TEST_F(Preview, ReadsTextOfTwoBytes) {
  std::string wide;
  for (const char c : "t [s],x [mm],F [N]\n" + rows(20)) wide += std::string{c, '\0'};
  const ImportHead head = head_of("\xFF\xFE" + wide);
  EXPECT_THAT(head.notes, testing::Contains(HasSubstr("UTF-16")));
  const ImportPreview preview = look("time=1,position=2,force=3");
  EXPECT_EQ(preview.layout.columns[1].unit, "mm");
  ASSERT_TRUE(preview.imported);
  EXPECT_EQ(preview.imported->recording.rows(), 20U);
}

TEST_F(Preview, RefusesWhatNobodyCanReadInOneLine) {
  const auto refusal = [&](const std::string& content) -> std::string {
    try {
      (void)head_of(content);
      (void)look("");
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal("\x89PNG\r\n\x1a\n"), HasSubstr("a picture"));
  EXPECT_THAT(refusal(std::string(4000, '\0')), HasSubstr("binary file"));
  EXPECT_THAT(refusal("only words\nand more words\n"), HasSubstr("no line of numbers"));
  EXPECT_THAT(refusal(std::string("PK\x03\x04") + std::string(200, 'x')), testing::Not(testing::IsEmpty()));
}

}  // namespace
}  // namespace kerf::bench
