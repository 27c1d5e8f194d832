#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>

#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/processes/helper.h>

#include "kerf/plugins/load.h"

namespace kerf::plugins {
namespace {

/// What kerf-law-trial says, line by line.
class Told {
 public:
  Told(int descriptor, std::chrono::milliseconds patience) : descriptor_(descriptor), patience_(patience) {}

  enum class Next { line, end, silence };
  Next next(std::string& line) {
    for (;;) {
      if (const auto at = text_.find('\n'); at != std::string::npos) {
        line = text_.substr(0, at);
        text_.erase(0, at + 1);
        return Next::line;
      }
      if (!processes::becomes_readable(descriptor_, static_cast<int>(patience_.count())))
        return Next::silence;
      std::array<char, 4096> buffer{};
      const ssize_t count = recv(descriptor_, buffer.data(), buffer.size(), 0);
      if (count <= 0) return Next::end;
      text_.append(buffer.data(), static_cast<std::size_t>(count));
    }
  }

 private:
  int descriptor_;
  std::chrono::milliseconds patience_;
  std::string text_;
};

std::string end_in_words(int status) {
  if (WIFEXITED(status)) return "called exit(" + std::to_string(WEXITSTATUS(status)) + ")";
  const char* const name = sigabbrev_np(WTERMSIG(status));
  return std::string("crashed: SIG") + (name == nullptr ? "?" : name);
}

Trial read_report(const std::string& line) {
  std::istringstream words(line);
  Trial trial;
  std::string allocations;
  words >> trial.step_s >> trial.steps >> allocations;
  if (allocations != "?") trial.allocations = static_cast<std::size_t>(std::stoul(allocations));
  return trial;
}

/// A process that is ended with its scope.
class TrialProcess {
 public:
  explicit TrialProcess(pid_t process) : process_(process) {}
  TrialProcess(const TrialProcess&) = delete;
  TrialProcess& operator=(const TrialProcess&) = delete;
  ~TrialProcess() {
    if (process_ > 0) (void)end();
  }
  /// @returns its status, of the end that it had found by itself if it had.
  int end() {
    if (!has_ended()) kill(process_, SIGKILL);
    const int status = processes::wait_for(process_);
    process_ = 0;
    return status;
  }

 private:
  /// Within a while: who closes the connection is about to end.
  [[nodiscard]] bool has_ended() const {
    for (int i = 0; i < 100; ++i) {
      siginfo_t info{};
      if (waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
          info.si_pid != 0)
        return true;
      if (!closed) return false;
      usleep(10'000);
    }
    return false;
  }

  pid_t process_;

 public:
  bool closed = false;  ///< its end of the connection
};

}  // namespace

Trial try_law(const std::filesystem::path& file, std::chrono::milliseconds patience) {
  const auto refuse = [&](const std::string& why) -> Trial {
    throw std::invalid_argument(file.string() + ": " + why);
  };
  processes::Connection connection = processes::connection(SOCK_STREAM);
  const auto program = processes::helper_program("kerf-law-trial");
  pid_t started = 0;
  const std::array descriptors{connection.theirs.number()};
  if (const int error = processes::start(program, descriptors, started); error != 0)
    throw std::system_error(error, std::generic_category(), program.string());
  TrialProcess process(started);
  connection.theirs.reset();
  const std::string path = std::filesystem::absolute(file).string() + '\n';
  (void)send(connection.ours.number(), path.data(), path.size(), MSG_NOSIGNAL);
  Told told(connection.ours.number(), patience);
  std::string stage = "it was opened";
  for (std::string line;;) {
    switch (told.next(line)) {
      case Told::Next::silence:
        return refuse("it gave no sign for " + std::to_string(patience.count()) + " ms while " + stage);
      case Told::Next::end:
        process.closed = true;
        return refuse("it " + end_in_words(process.end()) + " while " + stage);
      case Told::Next::line:
        break;
    }
    if (line.starts_with("at ")) stage = line.substr(3);
    if (line.starts_with("refused ")) return refuse(line.substr(8));
    if (line.starts_with("done ")) return read_report(line.substr(5));
  }
}

}  // namespace kerf::plugins
