#include "pages/browser_link.h"

#include <array>
#include <cerrno>
#include <system_error>

#include <fmt/format.h>
#include <spawn.h>
#include <stdlib.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

/// A new file, readable and writable by its owner alone.
fs::path private_file(const std::string& content) {
  std::string name = (fs::temp_directory_path() / "kerf-studio-XXXXXX.html").string();
  const int file = mkstemps(name.data(), 5);
  if (file < 0) throw std::system_error(errno, std::generic_category(), name);
  const ssize_t written = write(file, content.data(), content.size());
  close(file);
  if (written != static_cast<ssize_t>(content.size())) {
    unlink(name.c_str());
    throw std::system_error(ENOSPC, std::generic_category(), name);
  }
  return name;
}

}  // namespace

BrowserLink::BrowserLink(const std::string& url)
    : file_(private_file(fmt::format("<!doctype html><meta charset=\"utf-8\"><title>Kerf studio</title>"
                                     "<meta http-equiv=\"refresh\" content=\"0;url={0}\">"
                                     "<a href=\"{0}\">Kerf studio</a>\n",
                                     url))) {
  std::string program = "xdg-open";
  std::string argument = file_.string();
  const std::array<char*, 3> arguments{program.data(), argument.data(), nullptr};
  pid_t process = 0;
  const int error = posix_spawnp(&process, program.c_str(), nullptr, nullptr, arguments.data(), environ);
  if (error == 0) return;
  std::error_code ignored;
  fs::remove(file_, ignored);
  throw std::system_error(error, std::generic_category(), "xdg-open, which opens the browser");
}

BrowserLink::~BrowserLink() {
  std::error_code ignored;
  fs::remove(file_, ignored);
}

}  // namespace kerf::bench
