#include "session/study_folder.h"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/sealed/sealed_session.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<std::string> names{"S01.h5", "S02.h5"};

class StudyFolderTest : public testing::Test {
 protected:
  static void make(const fs::path& file, const char* plan) {
    SealedEntries::create(file, test::public_part(), test::bytes_of(plan), test::key_of('k'), false);
  }
  void make_study(const char* plan, bool replace) const {
    StudyFolder study(study_, names, replace);
    for (const std::string& name : names) make(study.path() / name, plan);
    study.commit();
  }
  [[nodiscard]] std::vector<std::string> entries(const char* name) const {
    return test::entries_in(study_ / name, test::key_of('k'));
  }
  /// A run that somebody left after one answer.
  void answer_once(const char* name) const {
    SealedEntries run(study_ / name, test::key_of('k'), SealedEntries::For::run, test::ignore);
    run.append("trial", "trial 1", {});
  }

  kerf::test::TemporaryFolder folder_;
  fs::path study_ = folder_ / "study";
};

TEST_F(StudyFolderTest, AppearsWithAllItsSessionsOrNotAtAll) {
  {
    StudyFolder study(study_, names, false);
    make(study.path() / "S01.h5", "one");
  }
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  make_study("both", false);
  EXPECT_THAT(entries("S01.h5"), ElementsAre("plan: : both"));
  EXPECT_EQ(std::distance(fs::directory_iterator(study_), {}), 2);
}

TEST_F(StudyFolderTest, ReplacesSessionsWithTheirAnswersWhenToldTo) {
  make_study("first", false);
  answer_once("S02.h5");
  EXPECT_THAT([&] { make_study("second", false); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("--force replaces it")));
  EXPECT_THAT(entries("S02.h5"), ElementsAre("plan: : first", "trial: trial 1: "));
  make_study("second", true);
  EXPECT_THAT(entries("S02.h5"), ElementsAre("plan: : second"));
  EXPECT_EQ(std::distance(fs::directory_iterator(study_), {}), 2) << "and no journal";
}

TEST_F(StudyFolderTest, LeavesASessionThatRuns) {
  make_study("first", false);
  const SealedEntries run(study_ / "S01.h5", test::key_of('k'), SealedEntries::For::run, test::ignore);
  EXPECT_THAT([&] { make_study("second", true); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("is being run by another process")));
}

TEST_F(StudyFolderTest, KeepsTheAnswersOfALostSession) {
  make_study("first", false);
  answer_once("S01.h5");
  for (const std::string& name : names) fs::remove(study_ / name);
  EXPECT_THAT([&] { make_study("second", false); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("the answers of an earlier session")));
  EXPECT_TRUE(fs::exists(study_ / "S01.h5.journal"));
}

TEST_F(StudyFolderTest, JoinsWhatStandsThere) {
  fs::create_directory(study_);
  kerf::test::write_text(study_ / "notes.txt", "theirs");
  {
    const StudyFolder begun(study_, names, false);
    EXPECT_EQ(std::distance(fs::directory_iterator(study_), {}), 1) << "what a killed process would leave";
  }
  make_study("ours", false);
  EXPECT_EQ(kerf::test::read_text(study_ / "notes.txt"), "theirs");
  EXPECT_EQ(std::distance(fs::directory_iterator(study_), {}), 3);
}

}  // namespace
}  // namespace kerf::bench
