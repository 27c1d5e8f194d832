#include "formats/run_apart.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

constexpr char result_mark = 'r';
constexpr char refusal_mark = 'x';

// The address sanitizer keeps terabytes of addresses to itself.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool limits_addresses = false;
#elif defined(__has_feature)
constexpr bool limits_addresses = !__has_feature(address_sanitizer);
#else
constexpr bool limits_addresses = true;
#endif

/// A file in memory that both processes see.
class SharedAnswer {
 public:
  SharedAnswer() : file_(memfd_create("kerf-apart", MFD_CLOEXEC)) {
    if (file_ < 0) throw std::system_error(errno, std::generic_category(), "no file in memory");
  }
  SharedAnswer(const SharedAnswer&) = delete;
  SharedAnswer& operator=(const SharedAnswer&) = delete;
  ~SharedAnswer() { ::close(file_); }

  [[nodiscard]] bool put(char kind, std::string_view text) const {
    if (::write(file_, &kind, 1) != 1) return false;
    while (!text.empty()) {
      const ssize_t written = ::write(file_, text.data(), text.size());
      if (written <= 0) return false;
      text.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
  }

  [[nodiscard]] std::string take() const {
    struct stat about {};
    if (fstat(file_, &about) != 0) return {};
    std::string text(static_cast<std::size_t>(about.st_size), '\0');
    std::size_t done = 0;
    while (done < text.size()) {
      const ssize_t got = pread(file_, text.data() + done, text.size() - done, static_cast<off_t>(done));
      if (got <= 0) break;
      done += static_cast<std::size_t>(got);
    }
    text.resize(done);
    return text;
  }

 private:
  int file_;
};

void limit(decltype(RLIMIT_AS) what, rlim_t most) {
  const rlimit both{.rlim_cur = most, .rlim_max = most};
  setrlimit(what, &both);
}

/// Libraries tell of a damaged file in many lines of their own, where one of ours is to stand.
void silence_errors() {
#if !defined(__SANITIZE_ADDRESS__)
  const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nothing >= 0) dup2(nothing, STDERR_FILENO);
#endif
}

[[noreturn]] void work_in_child(const UnpackedLimits& limits, const std::function<std::string()>& work,
                                const SharedAnswer& answer) {
  constexpr rlim_t beside = rlim_t{1} << 30U;
  constexpr rlim_t seconds = 120;
  const rlim_t most = std::min<rlim_t>(limits.at_most, RLIM_INFINITY / 2) + beside;
  if (limits_addresses) limit(RLIMIT_AS, most);
  limit(RLIMIT_CPU, seconds);
  limit(RLIMIT_CORE, 0);
  silence_errors();
  bool is_told = false;
  try {
    is_told = answer.put(result_mark, work());
  } catch (const std::invalid_argument& refused) {
    is_told = answer.put(refusal_mark, refused.what());
  } catch (...) {  // which the parent tells as any other end
    is_told = false;
  }
  _exit(is_told ? 0 : 1);
}

}  // namespace

std::string run_apart(const UnpackedLimits& limits, const std::function<std::string()>& work) {
  const SharedAnswer answer;
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "no process to read a file apart");
  if (child == 0) work_in_child(limits, work, answer);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  std::string text = answer.take();
  const bool ended_well = WIFEXITED(status) && WEXITSTATUS(status) == 0 && !text.empty();
  if (!ended_well)
    throw std::invalid_argument(fmt::format(
        "{}: it is damaged, or needs more memory than it may take: its reader fell over it", limits.name));
  const char kind = text.front();
  text.erase(0, 1);
  if (kind == refusal_mark) throw std::invalid_argument(text);
  return text;
}

}  // namespace kerf::bench
