#include "files/whole_file.h"

#include <cerrno>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include <fmt/core.h>
#include <unistd.h>

namespace kerf::bench {

std::string read_whole_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  if (!stream || std::filesystem::is_directory(file)) {
    const int reason = stream ? EISDIR : errno;
    throw std::system_error(reason, std::generic_category(), "cannot read " + file.string());
  }
  content << stream.rdbuf();
  return std::move(content).str();
}

void write_whole_file(const std::filesystem::path& file, std::string_view content) {
  std::filesystem::path temporary = file;
  temporary += fmt::format(".{}.tmp", getpid());
  errno = 0;
  std::ofstream stream(temporary, std::ios::binary);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  int reason = stream ? 0 : (errno != 0 ? errno : EIO);
  if (reason == 0) {
    std::error_code renamed;
    std::filesystem::rename(temporary, file, renamed);
    reason = renamed.value();
  }
  if (reason != 0) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw std::system_error(reason, std::generic_category(), "cannot write " + file.string());
  }
}

void require_output(const std::filesystem::path& file, bool replace) {
  if (!replace && std::filesystem::exists(file)) {
    throw std::invalid_argument(fmt::format("{} exists; --force replaces it", file.string()));
  }
  std::filesystem::path folder = file.parent_path();
  std::error_code ignored;
  while (folder.has_relative_path() && !std::filesystem::exists(folder, ignored))
    folder = folder.parent_path();
  if (folder.empty()) folder = ".";
  const int reason = !std::filesystem::is_directory(folder, ignored) ? ENOTDIR
                     : access(folder.c_str(), W_OK | X_OK) != 0      ? errno
                                                                     : 0;
  if (reason != 0) throw std::system_error(reason, std::generic_category(), "cannot write " + file.string());
}

}  // namespace kerf::bench
