#include "jobs/job_process.h"

#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/schema/recording.h>

#include "support/program.h"
#include "support/recordings.h"

namespace kerf::bench {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

/// A shell that does what a verb might.
class JobProcesses : public testing::Test {
 protected:
  JobProcesses() {
    progress_.log = [this](std::string_view text) { said_ += text; };
  }
  [[nodiscard]] JobProcess shell(const std::string& script) const {
    return {.program = "/bin/sh", .words = {"-c", script}, .folder = folder_.path()};
  }

  TemporaryFolder folder_;
  JobProgress progress_;
  std::string said_;
};

TEST_F(JobProcesses, WorkInTheirFolderAndSayWhatTheySay) {
  EXPECT_EQ(run_process(shell("pwd; echo bad >&2; exit 3"), progress_), 3);
  EXPECT_EQ(said_, std::filesystem::canonical(folder_.path()).string() + "\nbad\n");
}

TEST_F(JobProcesses, SayHowFarTheyAre) {
  EXPECT_EQ(run_process(shell("printf '3 40\\n' >&$KERF_PROGRESS_FD; printf '12 40\\nnonsense\\n1' >&3"),
                        progress_),
            0);
  EXPECT_EQ(progress_.done, 12U);
  EXPECT_EQ(progress_.steps, 40U);
}

TEST_F(JobProcesses, OfTheProgramTellTheirStepsToTheLast) {
  schema::write_recording(folder_ / "punch.h5", test::punch({.seconds = 1.0}));
  const JobProcess chart{.program = KERF_PROGRAM,
                         .words = {"chart", "punch.h5", "--laws", "kelvin", "-o", "chart"},
                         .folder = folder_.path()};
  EXPECT_EQ(run_process(chart, progress_), 0) << said_;
  EXPECT_GT(progress_.steps, 0U);
  EXPECT_EQ(progress_.done, progress_.steps);
}

TEST_F(JobProcesses, HaveNothingElseOfTheStudio) {
  constexpr int of_the_studio = 213;
  ASSERT_EQ(dup2(STDERR_FILENO, of_the_studio), of_the_studio);
  EXPECT_EQ(run_process(shell("cat; ls /proc/$$/fd"), progress_), 0);
  close(of_the_studio);
  EXPECT_THAT(said_, testing::StartsWith("0\n1\n"));
  EXPECT_THAT(said_, testing::Not(HasSubstr("213")));
}

TEST_F(JobProcesses, WriteToFilesAndTellWhoeverIsNamed) {
  JobProcess two = shell("echo out; echo bad >&2; printf '3 4\\n' >&3");
  two.output = folder_ / "out";
  two.errors = folder_ / "errors";
  std::vector<std::size_t> told;
  two.told = [&](std::size_t done, std::size_t of) { told = {done, of}; };
  EXPECT_EQ(run_process(two, progress_), 0);
  EXPECT_EQ(test::read_text(two.output), "out\n");
  EXPECT_EQ(test::read_text(two.errors), "bad\n");
  EXPECT_EQ(said_, "");
  EXPECT_THAT(told, testing::ElementsAre(3U, 4U));
  EXPECT_EQ(progress_.steps, 0U);
}

TEST_F(JobProcesses, AreInterruptedAsByCtrlC) {
  progress_.stop = true;
  EXPECT_EQ(run_process(shell("trap 'echo tidied; exit 7' INT; while :; do sleep 0.05; done"), progress_), 7);
  EXPECT_EQ(said_, "tidied\n");
}

TEST_F(JobProcesses, ThatAreKilledSaySo) {
  try {
    (void)run_process(shell("echo half; kill -9 $$"), progress_);
    ADD_FAILURE() << "it passed";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("ended from outside, by signal 9"));
  }
  EXPECT_EQ(said_, "half\n");
}

TEST_F(JobProcesses, ThatCannotBeStartedSayWhy) {
  try {
    (void)run_process({.program = folder_ / "nothing", .words = {}, .folder = folder_.path()}, progress_);
    ADD_FAILURE() << "it ran";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code().value(), ENOENT);
    EXPECT_THAT(error.what(), HasSubstr("nothing"));
  }
}

TEST_F(JobProcesses, AreNotLeftBehindWhereWhoeverIsToldThrows) {
  JobProcess tells = shell("echo $$ > pid; printf '1 2\n' >&3; exec sleep 60");
  tells.told = [](std::size_t, std::size_t) { throw std::runtime_error("no room"); };
  EXPECT_THROW((void)run_process(tells, progress_), std::runtime_error);
  EXPECT_EQ(kill(std::stoi(test::read_text(folder_ / "pid")), 0), -1) << "it is still there";
}

// A fork of the studio would copy each page that its loop writes.
TEST_F(JobProcesses, CopyNoneOfTheStudiosMemory) {
  std::vector<char> pages(std::size_t{64} << 20U, 1);
  void* const whole_pages = pages.data() + (4096 - reinterpret_cast<std::uintptr_t>(pages.data()) % 4096);
  ASSERT_EQ(madvise(whole_pages, pages.size() - 4096, MADV_NOHUGEPAGE), 0);
  const auto faults = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
  };
  (void)run_process(shell("true"), progress_);
  const long before = faults();
  (void)run_process(shell("true"), progress_);
  for (std::size_t at = 0; at < pages.size(); at += 4096) ++pages[at];
  EXPECT_LT(faults() - before, 4096) << "of 16384 pages";
}

TEST_F(JobProcesses, EndWithTheStudioWhateverEndsIt) {
  const auto pid = folder_ / "pid";
  const pid_t studio = fork();
  if (studio == 0) {
    (void)run_process(shell("echo $$ > new; mv new pid; exec sleep 60"), progress_);
    _exit(0);
  }
  while (!std::filesystem::exists(pid)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const int job = std::stoi(test::read_text(pid));
  kill(studio, SIGKILL);
  waitpid(studio, nullptr, 0);
  // Of another parent now, which may leave it as a zombie; its command line is gone then.
  const auto command = [&] { return test::read_text("/proc/" + std::to_string(job) + "/cmdline"); };
  while (!command().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace
}  // namespace kerf::bench
