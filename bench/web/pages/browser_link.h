#pragma once

#include <filesystem>
#include <string>

namespace kerf::bench {

/// Opens an address in the browser of whoever is at this machine, by a page in a file that only they can read
/// and that leads there: as an argument of a program everybody could read the token. The file goes with this.
class BrowserLink {
 public:
  /// @throws std::system_error: the file cannot be written, or there is no xdg-open.
  explicit BrowserLink(const std::string& url);
  BrowserLink(const BrowserLink&) = delete;
  BrowserLink& operator=(const BrowserLink&) = delete;
  ~BrowserLink();

  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }

 private:
  std::filesystem::path file_;
};

}  // namespace kerf::bench
