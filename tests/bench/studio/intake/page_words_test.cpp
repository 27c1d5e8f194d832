#include "intake/page_words.h"

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "import/import.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

/// What the import says of a file, as a page has it.
std::string refused(const std::string& text, ImportOptions options, const std::string& map) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "t.txt", text);
  try {
    options.map = parse_map(map);
    (void)import_text(folder / "t.txt", options);
  } catch (const std::invalid_argument& error) {
    return in_page_words(error.what());
  }
  return "";
}

constexpr auto three_columns = "0\t1\t2\n1\t2\t3\n2\t3\t4\n3\t4\t5\n";

TEST(PageWords, SayWhereToClick) {
  EXPECT_THAT(refused(three_columns, {}, "position=2[mm],force=3[N]"),
              HasSubstr("choose 'time' above one, or fill in 'Rate, without a time column [Hz]'"));
  EXPECT_THAT(refused(three_columns, {}, "time=1[s],force=3[N]"),
              HasSubstr("no column is the position: choose 'position' above one"));
  EXPECT_THAT(
      refused(three_columns, {}, "time=1[s],position=2,force=3[N]"),
      testing::EndsWith("column '2' for position has no unit in the file: choose one below its name"));
  EXPECT_THAT(refused(three_columns, {.rate_hz = 100.0}, "time=1[s],position=2[mm]"),
              HasSubstr("'Rate, without a time column [Hz]' is filled in: empty that field"));
  EXPECT_THAT(refused(three_columns, {}, "time=1[s],position=2[mm],force=3[kg]"),
              HasSubstr("The mapping: force_measured in 'kg' is not a unit of force_measured"));
  std::string twice;
  for (int row = 0; row < 400; ++row) twice += std::to_string(row % 200) + "\t1\n";
  EXPECT_THAT(
      refused(twice, {}, "time=1[s],position=2[mm]"),
      HasSubstr("take, under 'More', one of its 2 stretches as 'Stretch, where the clock starts anew'"));
  EXPECT_EQ(in_page_words("4 lines are not data: 4, 6"), "4 lines are not data: 4, 6");
}

/// Options that the sources of the import name in what they say.
TEST(PageWords, KnowEveryOptionThatTheImportNames) {
  static const std::regex option("--[a-z]+(-[a-z]+)*( HZ)?");
  for (const char* const folder : {"bench/data/import", "bench/data/formats"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(KERF_SOURCE_DIR) / folder)) {
      const std::string name = entry.path().filename().string();
      if (entry.path().extension() != ".cpp" || name.starts_with("join") || name.starts_with("trials") ||
          name.starts_with("import_many") || name == "suggested_map.cpp" || name == "preview.cpp")
        continue;  // nothing of those is said to a page
      std::ifstream source(entry.path());
      for (std::string line; std::getline(source, line);) {
        if (line.find('"') == std::string::npos) continue;  // what counts down is no option
        for (std::sregex_iterator it(line.begin(), line.end(), option), end; it != end; ++it) {
          const std::string here = it->str() == "--max-bytes" ? " (--max-bytes)" : it->str();
          EXPECT_THAT(in_page_words("so " + here), Not(HasSubstr("--"))) << name;
        }
      }
    }
  }
}

TEST(PageWords, NameFieldsAsThePageLabelsThem) {
  const std::string form = test::read_text(KERF_SOURCE_DIR "/bench/studio/page/src/intake/options_form.ts");
  for (const char* const name : {"--rate", "--resample", "--velocity-window", "--stretch", "--sheet",
                                 "--origin", "--point", "--sensor-rotation", "--strict"}) {
    std::string label = in_page_words(name);
    ASSERT_GT(label.size(), 2U);
    label = label.substr(1, label.size() - 2);  // its quotes
    EXPECT_THAT(form, HasSubstr('"' + label + '"'));
  }
}

}  // namespace
}  // namespace kerf::bench
