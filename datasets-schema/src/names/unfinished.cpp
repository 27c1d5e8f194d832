#include <cerrno>
#include <charconv>
#include <csignal>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <kerf/schema/unfinished.h>

#include "names/new_name.h"

namespace kerf::schema {
namespace {

constexpr std::string_view ending = ".writing-";

struct flock whole_file_lock() noexcept {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

/// Who wrote something of that name.
std::optional<pid_t> writer_of(const std::string& name) {
  const auto at = name.rfind(ending);
  if (at == std::string::npos) return std::nullopt;
  const std::string_view digits = std::string_view(name).substr(at + ending.size());
  pid_t writer = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), writer);
  const bool is_number = error == std::errc{} && end == digits.data() + digits.size() && writer > 0;
  return is_number ? std::optional(writer) : std::nullopt;
}

bool is_alive(pid_t process) noexcept { return ::kill(process, 0) == 0 || errno != ESRCH; }

}  // namespace

std::filesystem::path unfinished_name(std::filesystem::path name) {
  name += std::string(ending) + std::to_string(::getpid());
  return name;
}

bool is_unfinished(const std::filesystem::path& place) {
  return writer_of(place.filename().string()).has_value();
}

WriteMark::WriteMark(const std::filesystem::path& place) {
  if (is_folder(place)) {
    descriptor_ = ::open(place.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor_ >= 0) static_cast<void>(::flock(descriptor_, LOCK_EX | LOCK_NB));
    return;
  }
  descriptor_ = ::open(place.c_str(), O_RDWR | O_CLOEXEC);
  // A lock of the open file description: unlike those of a process it survives HDF5 closing the file, and
  // unlike flock() it is none of HDF5's own.
  struct flock lock = whole_file_lock();
  if (descriptor_ >= 0) static_cast<void>(::fcntl(descriptor_, F_OFD_SETLK, &lock));
}

WriteMark::~WriteMark() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool is_marked(const std::filesystem::path& place) {
  const int descriptor = ::open(place.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  struct flock lock = whole_file_lock();
  const bool marked = is_folder(place)
                          ? ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK
                          : ::fcntl(descriptor, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
  ::close(descriptor);
  return marked;
}

std::vector<std::filesystem::path> remove_unfinished(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> left;
  std::error_code ignored;
  for (std::filesystem::directory_iterator entries(folder, ignored), end; !ignored && entries != end;
       entries.increment(ignored)) {
    const auto writer = writer_of(entries->path().filename().string());
    if (writer && !is_alive(*writer) && !is_marked(entries->path())) left.push_back(entries->path());
  }
  std::erase_if(left, [](const std::filesystem::path& place) {
    std::error_code failed;
    std::filesystem::remove_all(place, failed);
    return static_cast<bool>(failed);
  });
  return left;
}

}  // namespace kerf::schema
