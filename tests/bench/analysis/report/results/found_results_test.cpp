#include "report/results/found_results.h"

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class FoundResults : public testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    test::write_text(folder_ / name, text);
    return folder_ / name;
  }
  [[nodiscard]] std::string refusal(const fs::path& path) const {
    try {
      (void)find_results({path}, "here");
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  }
  test::TemporaryFolder folder_;
};

TEST_F(FoundResults, AreToldByWhatIsInThemAndStandInTheOrderOfTheVerbs) {
  write("i", R"({"recording": "here", "sampling": {}, "signals": {}, "cycles": null})");
  const std::map<std::string, std::string> others{
      {"a.json", R"({"verdict": "pass", "histograms": {}, "missed": 0, "law_of_recording": "here"})"},
      {"b.json", R"({"mode": "through", "laws": [], "recording_uuid": "here"})"},
      {"c.json", R"({"study": "law", "in_words": [], "law_of_recording": null})"},
      {"d.json", R"({"points": [], "front": []})"},
      {"e.json", R"({"candidates": [], "choice": {}, "uuid": "here", "recording": "cut.h5"})"},
      {"f/fit.json", R"({"fits": [], "choice": {}, "recording": "x", "recordings": [{"uuid": "here"}]})"},
      {"f/other.json", "[1, 2]"},
      {"f/broken.json", "{"}};
  for (const auto& [name, text] : others) write(name, text);
  std::string kinds;
  std::string owners;
  for (const FoundResult& one : find_results({folder_ / "i", folder_.path()}, "here")) {
    kinds += std::string(verb_of(one.kind)).substr(5) + " ";
    owners += one.belongs == Belongs::here ? "h" : one.belongs == Belongs::unknown ? "?" : "e";
  }
  EXPECT_EQ(kinds, "inspect fit choose chart stability replay check ");
  EXPECT_EQ(owners, "hhh??hh");
}

TEST_F(FoundResults, OfAnotherRecordingAreTakenByNameAndNotOutOfAFolder) {
  const std::string of_another = R"({"fits": [], "choice": {}, "recording": "there"})";
  const fs::path file = write("lab/there/fit.json", of_another);
  EXPECT_THAT(refusal(folder_ / "lab"), HasSubstr("lab: holds results of other recordings alone"));
  write("lab/here/fit.json", R"({"fits": [], "choice": {}, "recording": "here"})");
  ASSERT_EQ(find_results({folder_ / "lab"}, "here").size(), 1U);
  const auto named = find_results({file}, "here");
  ASSERT_EQ(named.size(), 1U);
  EXPECT_EQ(named[0].belongs, Belongs::elsewhere);
}

TEST_F(FoundResults, AFolderIsLookedThroughTwoFoldersDown) {
  write("1/2/fit.json", R"({"fits": [], "choice": {}})");
  write("1/2/3/fit.json", R"({"fits": [], "choice": {}})");
  EXPECT_EQ(find_results({folder_.path()}, "here").size(), 1U);
}

TEST_F(FoundResults, SayOfWhichRecordingsTheyAre) {
  const std::string cut = "5cc0d24c-c519-4b93-b5f1-2578576cfeb4";
  const std::string other = "01234567-89ab-4cde-8f01-23456789abcd";
  const auto of = [&](const std::string& text) { return recordings_of(write("result.json", text)); };
  EXPECT_THAT(of(R"({"recording": ")" + cut + R"(", "fits": [{"uuid": ")" + other + R"("}]})"),
              ElementsAre(cut));
  EXPECT_THAT(of(R"({"recording": ")" + cut + R"(", "recordings": [{"uuid": ")" + cut +
                 R"(", "cycles": [{"uuid": "x"}]}, {"uuid": ")" + other + R"("}], "fits": []})"),
              ElementsAre(cut, other));
  EXPECT_THAT(of(R"({"recording": "cut.h5", "uuid": ")" + cut + R"("})"), ElementsAre(cut));
  EXPECT_THAT(of(R"({"points": [{"recording": ")" + other + R"("}], "recording": ")" + cut + R"("})"),
              ElementsAre(cut));
  EXPECT_THAT(of(R"({"recording": ")" + cut + R"(", "fits": [)"), ElementsAre(cut)) << "and reads no further";
  EXPECT_THAT(of(R"({"recording": "cut.h5"})"), ElementsAre());
  EXPECT_THAT(of("{"), ElementsAre());
  EXPECT_THAT(recordings_of(folder_ / "nowhere.json"), ElementsAre());
}

TEST_F(FoundResults, ThatAreNoneAreRefusedByTheirNames) {
  EXPECT_THAT(refusal(write("table.json", R"({"rows": 3})")), HasSubstr("table.json: not the JSON of fit"));
  EXPECT_THAT(refusal(write("broken.json", "{")), HasSubstr("broken.json: not JSON"));
  EXPECT_THAT(refusal(folder_.path()), HasSubstr("holds no JSON of fit"));
  EXPECT_THAT(refusal(folder_ / "nowhere"), HasSubstr("nowhere"));
}

}  // namespace
}  // namespace kerf::bench
