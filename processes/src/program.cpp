#include "kerf/processes/program.h"

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <system_error>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kerf::processes {
namespace {

class SpawnActions {
 public:
  explicit SpawnActions(const Program& program) {
    posix_spawn_file_actions_init(&actions_);
    if (program.input < 0) {
      add(posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0));
    } else {
      add(posix_spawn_file_actions_adddup2(&actions_, program.input, STDIN_FILENO));
    }
    if (program.output >= 0) add(posix_spawn_file_actions_adddup2(&actions_, program.output, STDOUT_FILENO));
    if (program.errors >= 0) add(posix_spawn_file_actions_adddup2(&actions_, program.errors, STDERR_FILENO));
    if (!program.folder.empty()) add(posix_spawn_file_actions_addchdir_np(&actions_, program.folder.c_str()));
    add(posix_spawn_file_actions_addclosefrom_np(&actions_, first_descriptor));
  }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }
  /// Why one of them could not be added; 0: all are there.
  [[nodiscard]] int error() const { return error_; }

 private:
  void add(int result) {
    if (error_ == 0) error_ = result;
  }

  posix_spawn_file_actions_t actions_{};
  int error_ = 0;
};

class SpawnAttributes {
 public:
  explicit SpawnAttributes(const Program& program) {
    posix_spawnattr_init(&attributes_);
    sigset_t signals;
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes_, &signals);
    sigaddset(&signals, SIGPIPE);  // which this program may ignore
    posix_spawnattr_setsigdefault(&attributes_, &signals);
    short flags = POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF;
    if (program.has_group) {
      posix_spawnattr_setpgroup(&attributes_, 0);
      flags |= POSIX_SPAWN_SETPGROUP;
    }
    posix_spawnattr_setflags(&attributes_, flags);
  }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;
  ~SpawnAttributes() { posix_spawnattr_destroy(&attributes_); }
  [[nodiscard]] const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_{};
};

}  // namespace

int start(const Program& program, pid_t& process) {
  const SpawnActions actions(program);
  if (actions.error() != 0) return actions.error();
  const SpawnAttributes attributes(program);
  std::vector<std::string> words = program.words;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  return posix_spawnp(&process, arguments[0], actions.get(), attributes.get(), arguments.data(), environ);
}

Descriptor file_in_memory() {
  Descriptor file(memfd_create("kerf", MFD_CLOEXEC));
  if (file.number() < 0) throw std::system_error(errno, std::generic_category(), "a file in memory");
  return file;
}

std::string content_of(const Descriptor& file) {
  std::string content;
  struct stat about {};
  if (fstat(file.number(), &about) != 0) return content;
  content.resize(static_cast<std::size_t>(about.st_size));
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t count =
        pread(file.number(), content.data() + done, content.size() - done, static_cast<off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  content.resize(done);
  return content;
}

}  // namespace kerf::processes
