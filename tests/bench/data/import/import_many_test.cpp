#include "import/import_many.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.h"

// Several files, folders and trials at once, as a user meets them.

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr auto map = "time=1[s],position=2[mm],force=3[N]";

class ManyFiles : public testing::Test {
 protected:
  Outcome import(std::vector<std::string> words) {
    for (std::string& word : words) word = (folder_ / word).string();
    words.insert(words.begin(), "import");
    for (const char* more : {"--map", map, "-o"}) words.emplace_back(more);
    words.push_back(output().string());
    words.insert(words.end(), more_.begin(), more_.end());
    return test::run_kerf(words);
  }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    test::write_text(folder_ / name, text);
  }
  [[nodiscard]] fs::path output() const { return folder_ / "out"; }
  [[nodiscard]] schema::Recording recording(const std::string& name) const {
    return schema::read_recording(output() / name);
  }
  [[nodiscard]] std::vector<std::string> written() const {
    std::vector<std::string> names;
    for (const auto& file : fs::recursive_directory_iterator(output())) {
      if (file.is_regular_file()) names.push_back(file.path().lexically_relative(output()).string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  test::TemporaryFolder folder_;
  std::vector<std::string> more_;
};

TEST_F(ManyFiles, BecomeARecordingEach) {
  write("a.csv", "0,1,2\n1,2,3\n2,3,4\n");
  write("b.csv", "0,1,2\n1,2,3\n");
  write("other/a.txt", "0,1,2\n1,2,3\n2,3,4\n3,4,5\n");
  const Outcome outcome = import({"a.csv", "b.csv", "other/a.txt"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(written(), ElementsAre("a-2.h5", "a.h5", "b.h5"));
  EXPECT_EQ(recording("a.h5").rows(), 3U);
  EXPECT_EQ(recording("a-2.h5").rows(), 4U);
  EXPECT_THAT(recording("b.h5").header.source, testing::StartsWith("b.csv sha256:"));
  EXPECT_THAT(outcome.output, HasSubstr("3 of 3 imported; the recordings are in "));
  EXPECT_EQ(import({"a.csv", "b.csv"}).exit_status, 2) << "what is there is not replaced";
}

TEST_F(ManyFiles, OfAFolderKeepTheirPlacesAndRubbishCostsALine) {
  write("drawer/a.csv", "0,1,2\n1,2,3\n");
  write("drawer/slow/a.csv", "0,1,2\n1,2,3\n2,3,4\n");
  write("drawer/empty.txt", "");
  write("drawer/photo.jpg", "\xFF\xD8\xFF\xE0 JFIF");
  write("drawer/.hidden", "x");
  fs::create_symlink("loop", folder_ / "drawer/loop");
  fs::create_directory_symlink(folder_ / "drawer", folder_ / "drawer/slow/round");
  const Outcome outcome = import({"drawer"});
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_THAT(written(), ElementsAre("a.h5", "slow/a.h5"));
  EXPECT_THAT(outcome.errors, HasSubstr("drawer/empty.txt: the file is empty"));
  EXPECT_THAT(outcome.errors, HasSubstr("drawer/photo.jpg: a picture, not a file of numbers"));
  EXPECT_THAT(outcome.errors, HasSubstr("drawer/loop"));
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 3) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("2 of 5 imported"));
}

TEST_F(ManyFiles, OfWhichNoneIsGoodLeaveNoFolder) {
  write("a.csv", "no numbers\n");
  write("b.csv", "");
  const Outcome outcome = import({"a.csv", "b.csv"});
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_FALSE(fs::exists(output()));
  EXPECT_THAT(outcome.output, HasSubstr("none of 2 imported; nothing is written"));
}

TEST_F(ManyFiles, AreTooFewInAnEmptyFolder) {
  fs::create_directory(folder_ / "drawer");
  const Outcome outcome = import({"drawer"});
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("drawer: a folder without a file"));
}

TEST_F(ManyFiles, AreToldAsJson) {
  write("a.csv", "0,1,2\n1,2,3\n");
  more_ = {"--json"};
  const auto json = nlohmann::json::parse(import({"a.csv", "none.csv"}).output);
  ASSERT_EQ(json.at("recordings").size(), 1U);
  EXPECT_EQ(json.at("recordings").at(0).at("recording"), "a.h5");
  EXPECT_EQ(json.at("recordings").at(0).at("samples"), 2);
  EXPECT_THAT(json.at("failures").at(0).at("reason").get<std::string>(), HasSubstr("none.csv"));
}

TEST_F(ManyFiles, AreNotBegunAfterAStop) {
  write("a.csv", "0,1,2\n1,2,3\n");
  const std::atomic<bool> stop{true};
  std::atomic<std::size_t> done{0};
  const auto entries =
      import_many({{.file = folder_ / "a.csv", .name = "a"}}, {.folder = output()}, stop, done);
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_THAT(entries[0].failure, HasSubstr("not begun"));
}

std::string long_table() {
  std::string text = "time,x,F,specimen\n";
  for (int i = 0; i < 12; ++i) text += std::to_string(i) + "," + std::to_string(i) + ",1,liver/1\n";
  for (int i = 0; i < 11; ++i)
    text += std::to_string(100 + i) + "," + (i == 4 ? "?" : std::to_string(i)) + ",2,\"2\"\n";
  text += "500,1,1,\n501,2,1,liver/1\n";
  return text;
}

TEST_F(ManyFiles, AreMadeOfTheTrialsOfALongTable) {
  write("long.csv", long_table());
  more_ = {"--trial", "specimen"};
  const Outcome outcome = import({"long.csv"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(written(), ElementsAre("long_2.h5", "long_liver_1.h5"));
  EXPECT_EQ(recording("long_liver_1.h5").rows(), 13U);
  EXPECT_EQ(recording("long_liver_1.h5").time.back(), 501.0) << "lines of a trial need not follow each other";
  EXPECT_EQ(recording("long_2.h5").rows(), 10U);
  EXPECT_EQ(recording("long_2.h5").time.front(), 0.0);
  EXPECT_THAT(recording("long_2.h5").header.history, HasSubstr("import: 10 rows of long.csv, trial '2'"));
  EXPECT_THAT(outcome.errors, HasSubstr("trial '2': 1 lines are not data: 18"));
  EXPECT_THAT(outcome.errors, HasSubstr("1 lines name no trial and are left out: 25"));
}

TEST_F(ManyFiles, AreNotMadeOfATrialThatIsBad) {
  std::string text = long_table();
  for (int i = 0; i < 12; ++i) text += std::to_string(i) + ",1,inf,3\n";
  write("long.csv", text);
  more_ = {"--trial", "4"};
  const Outcome outcome = import({"long.csv"});
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_THAT(written(), ElementsAre("long_2.h5", "long_liver_1.h5"));
  EXPECT_THAT(outcome.errors, HasSubstr("trial '3':27: column 3, mapped to force_measured, is infinite"));
}

TEST_F(ManyFiles, AreNotMadeOfAColumnThatIsNone) {
  write("long.csv", long_table());
  more_ = {"--trial", "time"};
  EXPECT_THAT(import({"long.csv"}).errors, HasSubstr("column 1 names 25 trials in 25 lines"));
  more_ = {"--trial", "tissue"};
  const Outcome outcome = import({"long.csv"});
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("--trial asks for column 'tissue', but the file has 4 columns"));
}

}  // namespace
}  // namespace kerf::bench
