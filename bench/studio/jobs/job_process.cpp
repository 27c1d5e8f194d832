#include "jobs/job_process.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/processes/helper.h>

namespace kerf::bench {
namespace {

using processes::Descriptor;
using SteadyClock = std::chrono::steady_clock;

constexpr auto stopping_patience = std::chrono::seconds(5);  ///< between being asked to stop and being killed
constexpr int process_look_ms = 100;

struct PipeEnds {
  Descriptor from;
  Descriptor to;
};

PipeEnds make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "a pipe");
  PipeEnds made{.from = Descriptor(ends[0]), .to = Descriptor(ends[1])};
  (void)fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return made;
}

/// What the new process needs, made ready before there is one: between fork() and exec() no memory is taken.
struct ProgramCall {
  explicit ProgramCall(const JobProcess& process) : program(process.program), folder(process.folder) {
    texts.push_back(program);
    texts.insert(texts.end(), process.words.begin(), process.words.end());
    for (char** one = environ; *one != nullptr; ++one) settings.emplace_back(*one);
    settings.push_back(fmt::format("{}={}", progress_variable, processes::first_descriptor));
    for (std::string& one : texts) words.push_back(one.data());
    for (std::string& one : settings) variables.push_back(one.data());
    words.push_back(nullptr);
    variables.push_back(nullptr);
  }

  std::string program;
  std::string folder;
  std::vector<std::string> texts;
  std::vector<std::string> settings;
  std::vector<char*> words;
  std::vector<char*> variables;
};

/// What it finds at its first descriptors. All lie above these, so that none is put over another.
struct ProgramStreams {
  ProgramStreams(const JobProcess& process, const PipeEnds& log, const PipeEnds& progress)
      : input(opened("/dev/null", O_RDONLY)),
        output(process.output.empty() ? above(log.to) : written(process.output)),
        errors(process.errors.empty() ? above(log.to) : written(process.errors)),
        steps(above(progress.to)) {}

  Descriptor input;
  Descriptor output;
  Descriptor errors;
  Descriptor steps;

 private:
  static Descriptor above(const Descriptor& one) {
    return Descriptor(fcntl(one.number(), F_DUPFD_CLOEXEC, processes::first_descriptor + 1));
  }
  static Descriptor opened(const char* file, int flags) {
    const Descriptor one(open(file, flags | O_CLOEXEC, 0644));
    if (one.number() < 0) throw std::system_error(errno, std::generic_category(), file);
    return above(one);
  }
  static Descriptor written(const std::filesystem::path& file) {
    return opened(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  }
};

/// Duplicates to a number that the program is to find it at; what has it already keeps it.
bool put(int descriptor, int number) {
  return descriptor == number ? fcntl(number, F_SETFD, 0) == 0 : dup2(descriptor, number) >= 0;
}

/// In the new process: takes the place of what was copied. Returns only if it cannot; errno says why.
void become(const ProgramCall& command, const ProgramStreams& streams, pid_t studio) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != studio) _exit(127);  // it has ended meanwhile
  setpgid(0, 0);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  std::signal(SIGPIPE, SIG_DFL);
  if (chdir(command.folder.c_str()) != 0) return;
  if (!put(streams.input.number(), STDIN_FILENO) || !put(streams.output.number(), STDOUT_FILENO)) return;
  if (!put(streams.errors.number(), STDERR_FILENO)) return;
  if (!put(streams.steps.number(), processes::first_descriptor)) return;
  // What the studio itself was started with is none of the job's.
  if (close_range(processes::first_descriptor + 1, ~0U, CLOSE_RANGE_CLOEXEC) != 0) return;
  execve(command.program.c_str(), command.words.data(), command.variables.data());
}

pid_t start_process(const JobProcess& process, const PipeEnds& log, const PipeEnds& progress) {
  const ProgramCall command(process);
  const ProgramStreams streams(process, log, progress);
  PipeEnds failed =
      make_pipe();  // carries why it could not become the program; closed by the kernel if it could
  const pid_t studio = getpid();
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), process.program.string());
  if (child == 0) {
    const Descriptor high(fcntl(failed.to.number(), F_DUPFD_CLOEXEC, processes::first_descriptor + 1));
    become(command, streams, studio);
    const int error = errno;
    (void)!write(high.number(), &error, sizeof error);
    _exit(127);
  }
  failed.to.reset();
  (void)fcntl(failed.from.number(), F_SETFL, 0);
  int error = 0;
  if (read(failed.from.number(), &error, sizeof error) == sizeof error) {
    (void)processes::wait_for(child);
    throw std::system_error(error, std::generic_category(), process.program.string());
  }
  return child;
}

/// What is there to be read now; false at the end.
bool take_text(const Descriptor& from, std::string& text) {
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t got = read(from.number(), buffer.data(), buffer.size());
    if (got > 0) text.append(buffer.data(), static_cast<std::size_t>(got));
    if (got == 0) return false;
    if (got < 0 && errno != EINTR) return errno == EAGAIN;
  }
}

/// Takes whole lines "DONE OF" off the front of the text.
void take_steps(std::string& text, const std::function<void(std::size_t, std::size_t)>& told) {
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
    std::size_t done = 0;
    std::size_t of = 0;
    const char* const last = text.data() + end;
    const auto first = std::from_chars(text.data(), last, done);
    if (first.ec == std::errc() && first.ptr < last &&
        std::from_chars(first.ptr + 1, last, of).ec == std::errc())
      told(done, of);
    text.erase(0, end + 1);
  }
}

/// Asks to stop and, in the end, makes it.
class Stopping {
 public:
  explicit Stopping(pid_t process) : process_(process) {}

  void look(bool is_asked_for) {
    if (!is_asked_for) return;
    if (!is_asked_) {
      kill(-process_, SIGINT);
      is_asked_ = true;
      until_ = SteadyClock::now() + stopping_patience;
    } else if (SteadyClock::now() > until_) {
      kill(-process_, SIGKILL);
    }
  }

 private:
  pid_t process_;
  bool is_asked_ = false;
  SteadyClock::time_point until_{};
};

}  // namespace

int run_process(const JobProcess& process, JobProgress& progress) {
  const auto keep = [&progress](std::size_t done, std::size_t of) {
    progress.done = done;
    progress.steps = of;
  };
  const std::function<void(std::size_t, std::size_t)> told = process.told ? process.told : keep;
  PipeEnds output = make_pipe();
  PipeEnds steps = make_pipe();
  const pid_t child = start_process(process, output, steps);
  output.to.reset();
  steps.to.reset();
  Stopping stopping(child);
  std::string steps_text;
  int status = 0;
  for (bool has_ended = false; !has_ended;) {
    std::array<pollfd, 2> wanted{{{.fd = output.from.number(), .events = POLLIN, .revents = 0},
                                  {.fd = steps.from.number(), .events = POLLIN, .revents = 0}}};
    (void)poll(wanted.data(), wanted.size(), process_look_ms);
    stopping.look(progress.stop);
    has_ended = waitpid(child, &status, WNOHANG) == child;  // before the last look at what it has said
    std::string said;
    if (output.from.number() >= 0 && !take_text(output.from, said)) output.from.reset();
    if (steps.from.number() >= 0 && !take_text(steps.from, steps_text)) steps.from.reset();
    if (!said.empty()) progress.log(said);
    take_steps(steps_text, told);
  }
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  const int signal = WTERMSIG(status);
  throw std::runtime_error(fmt::format(
      "its process was ended from outside, by signal {} ({}): by somebody, or by the system where "
      "memory ran out; what it had written so far is removed by the next run",
      signal, strsignal(signal)));
}

}  // namespace kerf::bench
