// kerf-unpack: makes text of a workbook or a MAT-file for the program that started it, which a damaged file
// could bring down (formats/unpacked_apart.h). The file is its first descriptor, its answer goes to the
// second.

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <kerf/processes/helper.h>

#include "files/mapped_file.h"
#include "formats/unpacked_apart.h"

namespace kerf::bench {
namespace {

constexpr int file = processes::first_descriptor;
constexpr int told = processes::first_descriptor + 1;

// The address sanitizer keeps terabytes of addresses to itself.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool limits_addresses = false;
#elif defined(__has_feature)
constexpr bool limits_addresses = !__has_feature(address_sanitizer);
#else
constexpr bool limits_addresses = true;
#endif

void limit(decltype(RLIMIT_AS) what, rlim_t most) {
  const rlimit both{.rlim_cur = most, .rlim_max = most};
  setrlimit(what, &both);
}

void take_no_more_than(std::size_t bytes) {
  constexpr rlim_t beside = rlim_t{1} << 30U;
  constexpr rlim_t seconds = 120;
  if (limits_addresses) limit(RLIMIT_AS, std::min<rlim_t>(bytes, RLIM_INFINITY / 2) + beside);
  limit(RLIMIT_CPU, seconds);
  limit(RLIMIT_CORE, 0);
}

bool tell(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(told, text.data(), text.size());
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// Name, bytes at most, sheet, and the name of a copy, or none.
int run(std::string_view name, std::string_view at_most, const std::string& sheet, const std::string& copy) {
  UnpackedLimits limits{.name = std::string(name)};
  (void)std::from_chars(at_most.data(), at_most.data() + at_most.size(), limits.at_most);
  take_no_more_than(limits.at_most);
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  std::string answer;
  try {
    const MappedFile bytes(path);
    answer = answer_of(unpacked_here(bytes.text(), copy.empty() ? path : copy, sheet, limits));
  } catch (const std::invalid_argument& refused) {
    answer = refusal_of(refused.what());
  }
  return tell(answer) ? 0 : 1;
}

}  // namespace
}  // namespace kerf::bench

int main(int count, char** words) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (count != 5) return 2;
  try {
    return kerf::bench::run(words[1], words[2], words[3], words[4]);
  } catch (const std::exception&) {  // which the other process tells as any other end
    return 1;
  }
}
