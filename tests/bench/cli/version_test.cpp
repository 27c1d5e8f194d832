// Version and commit, in the program and in what it writes.

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>
#include <kerf/version.h>

#include "laws/law_file.h"
#include "support/program.h"
#include "support/recordings.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using test::run_kerf;
using testing::HasSubstr;
using testing::MatchesRegex;

TEST(Version, StandsBesideTheCommit) {
  const auto outcome = run_kerf({"--version"});
  EXPECT_EQ(outcome.exit_status, 0);
  EXPECT_EQ(outcome.output, software() + "\n");
  EXPECT_THAT(software(), MatchesRegex("kerf [0-9]+[.][0-9]+[.][0-9]+ [(][^ ()]+[)]"));
  EXPECT_EQ(software(), "kerf " + std::string(version()) + " (" + std::string(commit()) + ")");
}

TEST(Version, IsInEveryFileThatIsWritten) {
  const test::TemporaryFolder folder;
  const auto at = [&](const char* name) { return (folder / name).string(); };
  ASSERT_EQ(run_kerf({"record", "--virtual", "--seconds", "1", "-o", at("r.h5")}).exit_status, 0);
  EXPECT_EQ(schema::read_recording(at("r.h5")).header.software, software());
  ASSERT_EQ(run_kerf({"prepare", at("r.h5"), "-o", at("p.h5"), "--from", "0.1"}).exit_status, 0);
  EXPECT_THAT(schema::read_recording(at("p.h5")).header.history, HasSubstr(" " + software() + ": "));
  schema::write_recording(at("punch.h5"), test::punch());
  ASSERT_EQ(run_kerf({"fit", at("punch.h5"), "--models", "kelvin", "-o", at("fits")}).exit_status, 0);
  EXPECT_EQ(bench::read_law_file(folder / "fits" / "kelvin.law.toml").fit.software, software());
  EXPECT_THAT(test::read_text(folder / "fits" / "kelvin.law.toml"),
              testing::StartsWith("# " + software() + "\n"));
  EXPECT_EQ(nlohmann::json::parse(test::read_text(folder / "fits" / "fit.json")).at("software"), software());
  ASSERT_EQ(run_kerf({"report", at("punch.h5"), "-o", at("r.html")}).exit_status, 0);
  EXPECT_THAT(test::read_text(at("r.html")),
              HasSubstr("<meta name=\"generator\" content=\"" + software() + "\">"));
  EXPECT_EQ(nlohmann::json::parse(run_kerf({"laws", "--json"}).output).at("software"), software());
}

/// A tree with one file, and what is made of it as the build does.
class DescribedTree : public testing::Test {
 protected:
  DescribedTree() {
    fs::create_directory(tree_);
    test::write_text(tree_ / "file", "as it was\n");
  }
  void git(const std::string& words) const {
    const auto outcome = test::run(
        {"bash", "-c", "git -C \"$1\" -c user.name=a -c user.email=a@b -c init.defaultBranch=main " + words,
         "bash", tree_.string()});
    ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  }
  [[nodiscard]] std::string described() const {
    const fs::path source = KERF_SOURCE_DIR "/datasets-schema/version";
    const fs::path output = folder_ / "described";
    const auto outcome =
        test::run({"cmake", "-DTREE=" + tree_.string(), "-DVERSION=1.2.3", "-DOUTPUT=" + output.string(),
                   "-DTEMPLATE=" + (folder_ / "template").string(), "-P", source / "describe_commit.cmake"});
    EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
    const std::string text = test::read_text(output);
    return text.substr(0, text.find('\n'));
  }
  void SetUp() override { test::write_text(folder_ / "template", "@VERSION@ @COMMIT@"); }

  test::TemporaryFolder folder_;
  fs::path tree_ = folder_ / "tree";
};

TEST_F(DescribedTree, HasNoCommitWithoutAClone) {
  EXPECT_EQ(described(), "1.2.3 unknown");
  git("init -q && git -C \"$1\" rev-parse --git-dir");
  EXPECT_EQ(described(), "1.2.3 unknown") << "nothing was committed";
}

TEST_F(DescribedTree, IsNoPartOfTheCloneAroundIt) {
  const fs::path around = folder_.path();
  ASSERT_EQ(test::run({"git", "-C", around.string(), "init", "-q"}).exit_status, 0);
  ASSERT_EQ(test::run({"git", "-C", around.string(), "-c", "user.name=a", "-c", "user.email=a@b", "commit",
                       "-q", "--allow-empty", "-m", "around"})
                .exit_status,
            0);
  EXPECT_EQ(described(), "1.2.3 unknown");
}

TEST_F(DescribedTree, IsDirtyWhereAFileDiffers) {
  git("init -q");
  git("add file");
  git("commit -q -m first");
  EXPECT_THAT(described(), MatchesRegex("1.2.3 [0-9a-f]+"));
  test::write_text(tree_ / "file", "changed\n");
  EXPECT_THAT(described(), MatchesRegex("1.2.3 [0-9a-f]+-dirty"));
}

TEST_F(DescribedTree, TouchesNothingThatStaysAsItIs) {
  (void)described();
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
  fs::last_write_time(folder_ / "described", long_ago);
  (void)described();
  EXPECT_EQ(fs::last_write_time(folder_ / "described"), long_ago);
}

}  // namespace
}  // namespace kerf
