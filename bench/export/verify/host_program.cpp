#include "verify/host_program.h"

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <type_traits>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/processes/program.h>

namespace kerf::bench {
namespace {

static_assert(std::is_trivially_copyable_v<HostSample> && sizeof(HostSample) == 3 * sizeof(double));

void write_all(int file, std::span<const HostSample> samples) {
  const auto bytes = std::as_bytes(samples);
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = write(file, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category(), "samples");
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  if (lseek(file, 0, SEEK_SET) < 0) throw std::system_error(errno, std::generic_category(), "samples");
}

std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

std::vector<double> forces_of_program(const std::vector<std::string>& words,
                                      const std::filesystem::path& folder,
                                      std::span<const HostSample> samples, const std::string& package) {
  const processes::Descriptor in = processes::file_in_memory();
  const processes::Descriptor out = processes::file_in_memory();
  const processes::Descriptor err = processes::file_in_memory();
  write_all(in.number(), samples);
  pid_t process = 0;
  const int error = processes::start({.words = words,
                                      .folder = folder,
                                      .input = in.number(),
                                      .output = out.number(),
                                      .errors = err.number()},
                                     process);
  if (error != 0)
    throw std::system_error(error, std::generic_category(),
                            fmt::format("{} (Debian's package {})", words[0], package));
  const int status = processes::wait_for(process);
  const std::string said = processes::content_of(out);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error(fmt::format("{} failed: {}", words[0], last_line(processes::content_of(err))));
  if (said.size() != samples.size() * sizeof(double))
    throw std::runtime_error(fmt::format("{} gave {} forces for {} samples", words[0],
                                         said.size() / sizeof(double), samples.size()));
  std::vector<double> forces(samples.size());
  std::copy(said.begin(), said.end(), reinterpret_cast<char*>(forces.data()));
  return forces;
}

}  // namespace kerf::bench
