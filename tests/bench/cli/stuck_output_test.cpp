// A loop and its recording do not depend on who reads the program's output, or whether anybody can.

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <spawn.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <kerf/schema/recording.h>

#include "support/kelvin_law.h"
#include "support/program.h"

namespace kerf {
namespace {

using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::Not;

/// A terminal whose output can be stopped, as by Ctrl-S.
class Terminal {
 public:
  Terminal() {
    if (openpty(&screen_, &program_side_, nullptr, nullptr, nullptr) != 0)
      throw std::runtime_error("no terminal");
    fcntl(screen_, F_SETFD, FD_CLOEXEC);
    fcntl(screen_, F_SETFL, O_NONBLOCK);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  ~Terminal() {
    close(screen_);
    close(program_side_);
  }

  [[nodiscard]] int program_side() const { return program_side_; }
  void stop() const { ASSERT_EQ(tcflow(program_side_, TCOOFF), 0); }
  void go_on() const { ASSERT_EQ(tcflow(program_side_, TCOON), 0); }
  /// What has come to the screen.
  [[nodiscard]] std::string read() const {
    std::string text;
    std::array<char, 4096> piece{};
    for (ssize_t count = 0; (count = ::read(screen_, piece.data(), piece.size())) > 0;)
      text.append(piece.data(), static_cast<std::size_t>(count));
    return text;
  }

 private:
  int screen_ = -1;
  int program_side_ = -1;
};

pid_t start_at(const Terminal& terminal, std::vector<std::string> command) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  for (const int stream : {1, 2}) posix_spawn_file_actions_adddup2(&actions, terminal.program_side(), stream);
  std::vector<char*> words;
  for (auto& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, words[0], &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return failed == 0 ? child : -1;
}

bool comes(const std::filesystem::path& file) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!std::filesystem::exists(file) && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return std::filesystem::exists(file);
}

/// A run by the wall clock in which there is something to say: the position jumps.
class StuckOutput : public testing::Test {
 protected:
  StuckOutput() { test::write_text(folder_ / "k.law.toml", test::kelvin_law); }

  [[nodiscard]] std::vector<std::string> command() const {
    return {KERF_PROGRAM, "record",         "--device",  "sim:scissors?fault=jump@0.5:20mm",
            "--law",      at("k.law.toml"), "--seconds", "1.5",
            "-o",         at("r.h5")};
  }
  /// Runs it in a shell in which its streams are redirected and 4 is a pipe whose reader has left.
  [[nodiscard]] int status_with(const std::string& redirections) const {
    std::vector<std::string> words{
        "bash", "-c", "mkfifo \"$0\" && exec 3<>\"$0\" 4>\"$0\" && exec 3>&- && exec \"$@\" " + redirections,
        at("pipe")};
    for (const std::string& word : command()) words.push_back(word);
    return test::run(words).exit_status;
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  void expect_whole() const {
    const schema::Recording recording = schema::read_recording(at("r.h5"));
    EXPECT_EQ(recording.header.status, "complete");
    EXPECT_THAT(recording.events, Not(Contains(Field(&schema::Event::kind, "stop")))) << "before its time";
    EXPECT_FALSE(std::filesystem::exists(at("r.h5.partial")));
  }
  void expect_told_in_file() const {
    EXPECT_THAT(
        schema::read_recording(at("r.h5")).events,
        Contains(AllOf(Field(&schema::Event::kind, "output"),
                       Field(&schema::Event::text,
                             testing::StartsWith("could not be printed: warning: the position has")))));
  }

  test::TemporaryFolder folder_;
};

TEST_F(StuckOutput, FullStandardErrorIsToldInTheFile) {
  EXPECT_EQ(status_with("2>/dev/full"), 0);
  expect_whole();
  expect_told_in_file();
}

TEST_F(StuckOutput, StandardErrorWithoutReaderIsToldInTheFile) {
  EXPECT_EQ(status_with("2>&4"), 0);
  expect_whole();
  expect_told_in_file();
}

TEST_F(StuckOutput, FullStandardOutputIsAFailureAfterTheWork) {
  EXPECT_EQ(status_with(">/dev/full 2>/dev/full"), 4);
  expect_whole();
}

TEST_F(StuckOutput, NoStreamAtAllIsNoFailure) {
  EXPECT_EQ(status_with(">&- 2>&- <&-"), 0);
  expect_whole();
}

TEST_F(StuckOutput, OfAStoppedTerminalHoldsUpNothing) {
  const Terminal terminal;
  terminal.stop();
  const pid_t child = start_at(terminal, command());
  ASSERT_GT(child, 0);
  EXPECT_TRUE(comes(at("r.h5"))) << "its output is still stopped";
  expect_whole();
  expect_told_in_file();
  terminal.go_on();
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_THAT(terminal.read(), HasSubstr("samples over"));
}

TEST_F(StuckOutput, OfAStoppedTerminalLetsASignalEndTheProgram) {
  const Terminal terminal;
  terminal.stop();
  const pid_t child = start_at(terminal, command());
  ASSERT_GT(child, 0);
  ASSERT_TRUE(comes(at("r.h5")));
  int status = -1;
  while (waitpid(child, &status, WNOHANG) == 0) {
    kill(child, SIGTERM);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(WIFSIGNALED(status));
  expect_whole();
}

}  // namespace
}  // namespace kerf
