#pragma once

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/compile.h>
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
      line_.append(text);
      return;
    }
    line_.push_back('"');
    for (const char c : text) {
      if (c == '"') line_.push_back(c);
      line_.push_back(c);
    }
    line_.push_back('"');
  }
  /// By the fewest digits that give the number back; nothing for NaN.
  void field(double value) {
    separate();
    if (!std::isnan(value)) fmt::format_to(fmt::appender(line_), FMT_COMPILE("{}"), value);
  }
  void field(std::uint64_t value) {
    separate();
    fmt::format_to(fmt::appender(line_), FMT_COMPILE("{}"), value);
  }
  void end_line() {
    line_.push_back('\n');
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
    if (begun_) line_.push_back(',');
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
  fmt::memory_buffer line_;  // formats without a copy
  bool begun_ = false;
};

}  // namespace kerf::bench
