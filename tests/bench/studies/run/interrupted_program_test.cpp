#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/studies/rubbed.h"
#include "bench/studies/study_folder.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::run_kerf;

bool is_half_written(const fs::path& path) {
  return path.filename().string().find(".writing-") != std::string::npos;
}

/// A study that was run to its end, of which two recordings and all results are missing again.
class InterruptedStudy : public test::StudyFolder {
 protected:
  InterruptedStudy() {
    for (unsigned specimen = 1; specimen <= 4; ++specimen)
      test::write_text(
          drawer() / fmt::format("liver_s{}.txt", specimen),
          test::as_text(test::punch(
              {.parallel_stiffness = 200.0 + 10.0 * specimen, .seconds = 3.0, .seed = specimen})));
    const Outcome looked =
        run_kerf({"study", "new", drawer().string(), "--laws", "kelvin", "-o", study().string()});
    EXPECT_EQ(looked.exit_status, 0) << looked.errors;
    EXPECT_EQ(run_it({"-j", "1"}).exit_status, 0);
    whole_ = test::read_text(study() / "study.json");
    for (const char* missing : {"recordings/liver_s3", "recordings/liver_s4", "held_out", "study.json",
                                "report.html", "ro-crate-metadata.json", "tables"})
      fs::remove_all(study() / missing);
    for (const char* kept : {"liver_s1", "liver_s2"}) made_[kept] = made(kept);
  }
  [[nodiscard]] fs::path recording(const std::string& name) const { return study() / "recordings" / name; }
  [[nodiscard]] fs::file_time_type made(const std::string& name) const {
    return fs::last_write_time(recording(name) / "result.json");
  }

  /// Whether a recording is computed but has not its name yet.
  [[nodiscard]] bool waits_for_its_name(const std::string& name) const {
    return std::ranges::any_of(fs::directory_iterator(study() / "recordings"), [&](const auto& entry) {
      return entry.path().filename().string().starts_with(name + ".writing-") &&
             fs::exists(entry.path() / "result.json");
    });
  }

  /// Sends a signal to a run that has computed liver_s3 and waits for its turn to name it, which is held here
  /// meanwhile; returns how the run ended.
  int interrupt(int signal) const {
    const int turn = ::open((study() / "recordings").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (::flock(turn, LOCK_EX) != 0) throw std::runtime_error("no lock");
    std::vector<std::string> command{KERF_PROGRAM, "study", "run", (study() / "study.toml").string(),
                                     "-j",         "1"};
    std::vector<char*> arguments;
    for (std::string& word : command) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t silent;
    posix_spawn_file_actions_init(&silent);
    posix_spawn_file_actions_addopen(&silent, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&silent, 2, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const int failed = posix_spawn(&child, arguments[0], &silent, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&silent);
    if (failed != 0) throw std::runtime_error("cannot run kerf");
    int status = 0;
    while (!waits_for_its_name("liver_s3")) {
      if (::waitpid(child, &status, WNOHANG) != 0) throw std::runtime_error("it did not wait for its turn");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ::kill(child, signal);
    if (signal == SIGKILL) ::waitpid(child, &status, 0);  // before its turn comes
    ::close(turn);
    if (signal != SIGKILL) ::waitpid(child, &status, 0);
    return status;
  }

  void expect_only_whole_recordings() const {
    EXPECT_FALSE(fs::exists(study() / "study.json"));
    EXPECT_FALSE(fs::exists(study() / "report.html"));
    for (const auto& entry : fs::directory_iterator(study() / "recordings")) {
      if (is_half_written(entry.path())) continue;
      EXPECT_TRUE(nlohmann::json::accept(test::read_text(entry.path() / "result.json"))) << entry.path();
      EXPECT_EQ(run_kerf({"validate", (entry.path() / "recording.h5").string()}).exit_status, 0);
    }
  }

  void expect_goes_on() const {
    const Outcome again = run_it({"-j", "1"});
    ASSERT_EQ(again.exit_status, 0) << again.errors;
    for (const auto& [name, time] : made_) EXPECT_EQ(made(name), time) << name << " was made again";
    EXPECT_EQ(test::read_text(study() / "study.json"), whole_);
    for (const auto& entry : fs::recursive_directory_iterator(study()))
      EXPECT_FALSE(is_half_written(entry.path())) << entry.path();
  }

  std::string whole_;
  std::map<std::string, fs::file_time_type> made_;
};

TEST_F(InterruptedStudy, EndsWithWhatIsUnderwayAndGoesOnFromThere) {
  const int status = interrupt(SIGINT);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_NE(WEXITSTATUS(status), 0);
  EXPECT_TRUE(fs::exists(recording("liver_s3"))) << "it was underway, and is kept";
  EXPECT_FALSE(fs::exists(recording("liver_s4")));
  expect_only_whole_recordings();
  made_["liver_s3"] = made("liver_s3");
  expect_goes_on();
}

TEST_F(InterruptedStudy, GoesOnAfterItWasKilled) {
  const int status = interrupt(SIGKILL);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_FALSE(fs::exists(recording("liver_s3"))) << "half-written";
  expect_only_whole_recordings();
  test::write_text(study() / "inputs/liver_s4.txt.writing-999999999", "half");
  expect_goes_on();
}

}  // namespace
}  // namespace kerf::bench
