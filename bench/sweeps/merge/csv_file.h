#pragma once

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace kerf::bench {

/// A table of text that is written line by line. @throws std::system_error that names the file.
class CsvFile {
 public:
  explicit CsvFile(const std::filesystem::path& file)
      : file_(file), stream_(std::fopen(file.c_str(), "wbe")) {
    if (!stream_) fail();
  }

  void field(std::string_view text) {
    separate();
    if (text.find_first_of(",\"\n") == std::string_view::npos) {
      line_ += text;
      return;
    }
    line_ += '"';
    for (const char c : text) line_.append(c == '"' ? 2 : 1, c);
    line_ += '"';
  }
  /// By the fewest digits that give the number back; nothing for NaN.
  void field(double value) {
    separate();
    if (!std::isnan(value)) fmt::format_to(std::back_inserter(line_), "{}", value);
  }
  void field(std::uint64_t value) {
    separate();
    fmt::format_to(std::back_inserter(line_), "{}", value);
  }
  void end_line() {
    line_ += '\n';
    begun_ = false;
    if (line_.size() < 65536) return;
    write();
  }
  void close() {
    write();
    if (std::fclose(stream_.release()) != 0) fail();
  }

 private:
  struct Close {
    void operator()(std::FILE* stream) const noexcept { (void)std::fclose(stream); }
  };

  void separate() {
    if (begun_) line_ += ',';
    begun_ = true;
  }
  void write() {
    if (std::fwrite(line_.data(), 1, line_.size(), stream_.get()) != line_.size()) fail();
    line_.clear();
  }
  [[noreturn]] void fail() const {
    throw std::system_error(errno, std::generic_category(), file_.string() + ": cannot write");
  }

  std::filesystem::path file_;
  std::unique_ptr<std::FILE, Close> stream_;
  std::string line_;
  bool begun_ = false;
};

}  // namespace kerf::bench
