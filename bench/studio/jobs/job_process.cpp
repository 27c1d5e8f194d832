#include "jobs/job_process.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sched.h>
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

/// What the new process needs, made ready before there is one: until it is the program no memory is taken.
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
    Descriptor copy(fcntl(one.number(), F_DUPFD_CLOEXEC, processes::first_descriptor + 1));
    if (copy.number() < 0) throw std::system_error(errno, std::generic_category(), "a stream of a program");
    return copy;
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

/// What the new process is to become, and why it could not: it runs in the studio's memory until it has.
struct Becoming {
  const ProgramCall& command;
  const ProgramStreams& streams;
  pid_t studio;
  int error = 0;
};

/// Handlers are the studio's code: none may run in its memory for a signal of the new process.
void forget_handlers() {
  for (int signal = 1; signal < NSIG; ++signal) {
    struct sigaction action {};
    if (sigaction(signal, nullptr, &action) != 0) continue;
    const bool is_left_alone = action.sa_handler == SIG_DFL || action.sa_handler == SIG_IGN;
    if (is_left_alone && signal != SIGPIPE) continue;
    action.sa_handler = SIG_DFL;
    (void)sigaction(signal, &action, nullptr);
  }
}

/// In the new process. Returns only if it cannot become the program; errno says why.
void become(const ProgramCall& command, const ProgramStreams& streams, pid_t studio) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != studio) _exit(127);  // it has ended meanwhile
  setpgid(0, 0);
  forget_handlers();
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  if (chdir(command.folder.c_str()) != 0) return;
  if (!put(streams.input.number(), STDIN_FILENO) || !put(streams.output.number(), STDOUT_FILENO)) return;
  if (!put(streams.errors.number(), STDERR_FILENO)) return;
  if (!put(streams.steps.number(), processes::first_descriptor)) return;
  // What the studio itself was started with is none of the job's.
  if (close_range(processes::first_descriptor + 1, ~0U, CLOSE_RANGE_CLOEXEC) != 0) return;
  execve(command.program.c_str(), command.words.data(), command.variables.data());
}

int become_or_say_why(void* given) {
  Becoming& its = *static_cast<Becoming*>(given);
  become(its.command, its.streams, its.studio);
  its.error = errno;
  return 127;
}

/// The studio's memory is not copied, as fork() does page by page where somebody writes: a loop that runs in
/// it would wait a tenth of a second for that. This thread alone waits, until the new process is the program.
pid_t start_process(const JobProcess& process, const PipeEnds& log, const PipeEnds& progress) {
  const ProgramCall command(process);
  const ProgramStreams streams(process, log, progress);
  Becoming becoming{.command = command, .streams = streams, .studio = getpid()};
  constexpr std::size_t stack_bytes = std::size_t{64} << 10U;
  std::vector<std::max_align_t> stack(stack_bytes / sizeof(std::max_align_t));
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t child =
      clone(become_or_say_why, stack.data() + stack.size(), CLONE_VM | CLONE_VFORK | SIGCHLD, &becoming);
  const int error = child < 0 ? errno : becoming.error;
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (error == 0) return child;
  if (child >= 0) (void)processes::wait_for(child);
  throw std::system_error(error, std::generic_category(), process.program.string());
}

/// What is there to be read now, no more than keeps whoever wants to stop it waiting; false at the end.
bool take_text(const Descriptor& from, std::string& text) {
  constexpr std::size_t most_at_once = std::size_t{1} << 20U;
  std::array<char, 4096> buffer{};
  for (std::size_t before = text.size();;) {
    if (text.size() - before > most_at_once) return true;
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

/// A process that is not left behind, whatever is thrown meanwhile.
class Child {
 public:
  explicit Child(pid_t process) : process_(process) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (has_ended_) return;
    kill(-process_, SIGKILL);
    (void)processes::wait_for(process_);
  }
  /// Looks whether it has, and how.
  bool has_ended() { return has_ended_ = waitpid(process_, &status_, WNOHANG) == process_; }
  [[nodiscard]] int status() const { return status_; }

 private:
  pid_t process_;
  int status_ = 0;
  bool has_ended_ = false;
};

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
  const pid_t number = start_process(process, output, steps);
  Child child(number);
  output.to.reset();
  steps.to.reset();
  Stopping stopping(number);
  std::string steps_text;
  for (bool has_ended = false; !has_ended;) {
    std::array<pollfd, 2> wanted{{{.fd = output.from.number(), .events = POLLIN, .revents = 0},
                                  {.fd = steps.from.number(), .events = POLLIN, .revents = 0}}};
    (void)poll(wanted.data(), wanted.size(), process_look_ms);
    stopping.look(progress.stop);
    has_ended = child.has_ended();  // before the last look at what it has said
    std::string said;
    if (output.from.number() >= 0 && !take_text(output.from, said)) output.from.reset();
    if (steps.from.number() >= 0 && !take_text(steps.from, steps_text)) steps.from.reset();
    if (!said.empty()) progress.log(said);
    take_steps(steps_text, told);
  }
  if (WIFEXITED(child.status())) return WEXITSTATUS(child.status());
  const int signal = WTERMSIG(child.status());
  throw std::runtime_error(fmt::format(
      "its process was ended from outside, by signal {} ({}): by somebody, or by the system where "
      "memory ran out; what it had written so far is removed by the next run",
      signal, strsignal(signal)));
}

}  // namespace kerf::bench
