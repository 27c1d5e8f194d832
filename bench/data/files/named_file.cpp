#include "files/named_file.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, std::string_view why) {
  throw std::invalid_argument(fmt::format("{}: {}", file.string(), why));
}

[[noreturn]] void refuse_unreadable(const std::filesystem::path& file) {
  refuse(file, fmt::format("cannot be read: {}", std::strerror(errno)));
}

}  // namespace

NamedFile::NamedFile(const std::filesystem::path& file)
    : descriptor_(open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (descriptor_ < 0 && errno == ENOENT) refuse(file, "no such file");
  if (descriptor_ < 0) refuse_unreadable(file);
  struct stat facts {};
  if (fstat(descriptor_, &facts) == 0 && S_ISDIR(facts.st_mode)) {
    close(descriptor_);
    refuse(file, "a folder; expected a file");
  }
}

NamedFile::~NamedFile() { close(descriptor_); }

std::string read_named_file(const std::filesystem::path& file) {
  const NamedFile named(file);
  std::string content;
  std::array<char, 1 << 16> piece{};
  for (;;) {
    const ssize_t count = read(named.descriptor(), piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw std::system_error(errno, std::generic_category(), "cannot read " + file.string());
    if (count == 0) return content;
    content.append(piece.data(), static_cast<std::size_t>(count));
  }
}

void require_named_folder(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) refuse(folder, "there is no such folder");
  if (access(folder.c_str(), R_OK | X_OK) != 0) refuse_unreadable(folder);
}

}  // namespace kerf::bench
