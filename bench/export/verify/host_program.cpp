#include "verify/host_program.h"

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <type_traits>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/processes/helper.h>

namespace kerf::bench {
namespace {

static_assert(std::is_trivially_copyable_v<HostSample> && sizeof(HostSample) == 3 * sizeof(double));

/// A file in memory, which a child takes as one of its standard streams: no pipe that fills up while nobody
/// reads.
processes::Descriptor file_in_memory() {
  processes::Descriptor file(memfd_create("kerf-host", MFD_CLOEXEC));
  if (file.number() < 0) throw std::system_error(errno, std::generic_category(), "a file in memory");
  return file;
}

void write_all(int file, std::span<const HostSample> samples) {
  const auto bytes = std::as_bytes(samples);
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = write(file, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category(), "samples");
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  if (lseek(file, 0, SEEK_SET) < 0) throw std::system_error(errno, std::generic_category(), "samples");
}

std::string read_all(int file) {
  std::string content;
  content.resize(static_cast<std::size_t>(std::max<off_t>(lseek(file, 0, SEEK_END), 0)));
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t count = pread(file, content.data() + done, content.size() - done, static_cast<off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  content.resize(done);
  return content;
}

std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

/// @returns an error number; 0: it ran, with that status
int run(std::vector<std::string>& words, const std::filesystem::path& folder, int in, int out, int err,
        int& status) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err, STDERR_FILENO);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  const int error = posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error == 0) {
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
  }
  return error;
}

}  // namespace

std::vector<double> forces_of_program(std::vector<std::string> words, const std::filesystem::path& folder,
                                      std::span<const HostSample> samples, const std::string& package) {
  const processes::Descriptor in = file_in_memory();
  const processes::Descriptor out = file_in_memory();
  const processes::Descriptor err = file_in_memory();
  write_all(in.number(), samples);
  int status = 0;
  if (const int error = run(words, folder, in.number(), out.number(), err.number(), status); error != 0)
    throw std::system_error(error, std::generic_category(),
                            fmt::format("{} (Debian's package {})", words[0], package));
  const std::string said = read_all(out.number());
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error(fmt::format("{} failed: {}", words[0], last_line(read_all(err.number()))));
  if (said.size() != samples.size() * sizeof(double))
    throw std::runtime_error(fmt::format("{} gave {} forces for {} samples", words[0],
                                         said.size() / sizeof(double), samples.size()));
  std::vector<double> forces(samples.size());
  std::copy(said.begin(), said.end(), reinterpret_cast<char*>(forces.data()));
  return forces;
}

}  // namespace kerf::bench
