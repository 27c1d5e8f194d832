// Whoever reads the program's output may leave.

#include <csignal>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/recording.h>

#include "support/program.h"
namespace kerf {
namespace {

using test::Outcome;

constexpr int by_closed_pipe = 128 + SIGPIPE;

/// Runs a line of a shell in a folder, in which "$kerf" is the program.
Outcome in_shell(const std::string& line, const std::filesystem::path& folder) {
  return test::run({"bash", "-c", "cd \"$1\" && kerf=$2 && " + line, "bash", folder.string(), KERF_PROGRAM});
}

/// The same where 4 is a pipe whose reader has left already.
Outcome at_closed_pipe(const std::string& line, const std::filesystem::path& folder) {
  return in_shell("mkfifo pipe && exec 3<>pipe 4>pipe && exec 3>&- && " + line, folder);
}

TEST(ClosedPipe, EndsAVerbQuietlyAsItEndsOthers) {
  const test::TemporaryFolder folder;
  const Outcome outcome = at_closed_pipe("\"$kerf\" laws >&4", folder.path());
  EXPECT_EQ(outcome.exit_status, by_closed_pipe);
  EXPECT_EQ(outcome.errors, "");
}

TEST(ClosedPipe, LosesNoFile) {
  const test::TemporaryFolder folder;
  const Outcome outcome =
      at_closed_pipe("\"$kerf\" regress run " KERF_SOURCE_DIR
                     "/examples/regress/kerf.toml --only kelvin --no-cost --junit r.xml >&4",
                     folder.path());
  EXPECT_EQ(outcome.exit_status, by_closed_pipe);
  EXPECT_EQ(outcome.errors, "");
  EXPECT_TRUE(std::filesystem::exists(folder / "r.xml")) << "which is written after the first words";
}

TEST(ClosedPipe, TakesWarningsToo) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "t.txt", "0,1,2\n1,2,nan\n2,3,4\n");
  const Outcome outcome = at_closed_pipe(
      "\"$kerf\" import t.txt --map 'time=1[s],position=2[mm],force=3[N]' -o r.h5 >&4 2>&4", folder.path());
  EXPECT_EQ(outcome.exit_status, by_closed_pipe);
  EXPECT_TRUE(std::filesystem::exists(folder / "r.h5"));
}

TEST(ClosedPipe, DoesNotHideWhatIsWrong) {
  const test::TemporaryFolder folder;
  const Outcome outcome = at_closed_pipe("\"$kerf\" info none.h5 >&4", folder.path());
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, testing::HasSubstr("none.h5"));
}

TEST(ClosedStandardOutput, IsNoFileOfOurs) {
  const test::TemporaryFolder folder;
  const Outcome outcome = in_shell("\"$kerf\" record --virtual --seconds 1 -o r.h5 >&- 2>&-", folder.path());
  EXPECT_EQ(outcome.exit_status, 0);
  EXPECT_EQ(schema::read_recording(folder / "r.h5").rows(), 1000U);
}

TEST(FullStandardOutput, IsAFailureToWrite) {
  const test::TemporaryFolder folder;
  for (const std::string line :
       {"\"$kerf\" laws > /dev/full", "\"$kerf\" laws --json > /dev/full", "\"$kerf\" --help > /dev/full"}) {
    const Outcome outcome = in_shell(line, folder.path());
    EXPECT_EQ(outcome.exit_status, 4) << line;
    EXPECT_EQ(outcome.errors, "kerf: standard output: cannot write: No space left on device\n") << line;
  }
}

}  // namespace
}  // namespace kerf
