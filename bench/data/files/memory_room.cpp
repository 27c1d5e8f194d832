#include "files/memory_room.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <system_error>

#include <fmt/core.h>
#include <sys/resource.h>
#include <unistd.h>

#include "files/in_gibibytes.h"

namespace kerf::bench {
namespace {

constexpr std::uintmax_t no_limit = std::numeric_limits<std::uintmax_t>::max();
constexpr std::uintmax_t kilobyte = 1024;

std::uintmax_t left_of(std::uintmax_t limit, std::uintmax_t taken) {
  return limit > taken ? limit - taken : 0;
}

/// A file of one number; none where it holds none, such as "max".
std::optional<std::uintmax_t> number_in(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::uintmax_t number = 0;
  if (stream >> number) return number;
  return std::nullopt;
}

std::uintmax_t room_of_process() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return no_limit;
  const auto pages = number_in("/proc/self/statm");
  return pages ? left_of(limit.rlim_cur, *pages * static_cast<std::uintmax_t>(sysconf(_SC_PAGESIZE)))
               : no_limit;
}

std::uintmax_t room_of_machine() {
  std::ifstream stream("/proc/meminfo");
  std::uintmax_t room = 0;
  bool known = false;
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("MemAvailable:") && !line.starts_with("SwapFree:")) continue;
    room += std::strtoull(line.c_str() + line.find(':') + 1, nullptr, 10) * kilobyte;
    known = true;
  }
  return known ? room : no_limit;
}

/// As /proc/self/cgroup names it, "0::/user.slice".
std::string own_group() {
  std::ifstream stream("/proc/self/cgroup");
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("0::")) return line.substr(3);
  }
  return "/";
}

}  // namespace

std::uintmax_t memory_room_of_group(const std::filesystem::path& tree, std::string_view group) {
  std::uintmax_t room = no_limit;
  std::filesystem::path folder = std::filesystem::path("/") / group;
  for (bool is_root = false; !is_root; folder = folder.parent_path()) {
    is_root = folder == folder.parent_path();
    const std::filesystem::path facts = tree / folder.relative_path();
    const auto limit = number_in(facts / "memory.max");
    if (limit) room = std::min(room, left_of(*limit, number_in(facts / "memory.current").value_or(0)));
  }
  return room;
}

std::uintmax_t memory_room() {
  return std::min(
      {room_of_process(), memory_room_of_group("/sys/fs/cgroup", own_group()), room_of_machine()});
}

void require_memory(const std::filesystem::path& file, std::uintmax_t bytes, std::string_view needed_for) {
  const std::uintmax_t room = memory_room();
  if (bytes <= room) return;
  throw std::system_error(ENOMEM, std::generic_category(),
                          fmt::format("{}: needs {} of memory for {}, and {} can be had", file.string(),
                                      in_gibibytes(bytes), needed_for, in_gibibytes(room)));
}

}  // namespace kerf::bench
