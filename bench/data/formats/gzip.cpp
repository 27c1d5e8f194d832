#include "formats/gzip.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <fmt/core.h>
#include <zlib.h>

namespace kerf::bench {
namespace {

constexpr std::size_t unpacked_at_once = std::size_t{1} << 20U;

/// zlib at work on one member after the other.
class Inflating {
 public:
  Inflating() {
    constexpr int gzip_only = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, gzip_only) != Z_OK) throw std::bad_alloc();
  }
  Inflating(const Inflating&) = delete;
  Inflating& operator=(const Inflating&) = delete;
  ~Inflating() { inflateEnd(&stream_); }

  /// Appends what the member at the begin of `bytes` holds; returns how many bytes it took.
  std::size_t member(std::string_view bytes, const UnpackedLimits& limits, std::string& out) {
    inflateReset(&stream_);
    std::size_t taken = 0;
    while (true) {
      const auto now = static_cast<uInt>(std::min<std::size_t>(bytes.size() - taken, unpacked_at_once));
      stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + taken));  // zlib reads only
      stream_.avail_in = now;
      const std::size_t before = out.size();
      out.resize(before + unpacked_at_once);
      stream_.next_out = reinterpret_cast<Bytef*>(out.data() + before);
      stream_.avail_out = static_cast<uInt>(unpacked_at_once);
      const int status = inflate(&stream_, Z_NO_FLUSH);
      out.resize(before + unpacked_at_once - stream_.avail_out);
      taken += now - stream_.avail_in;
      if (out.size() > limits.at_most)
        throw std::invalid_argument(
            fmt::format("{}: it unpacks to more than {} bytes (--max-bytes)", limits.name, limits.at_most));
      if (status == Z_STREAM_END) return taken;
      const bool is_out = taken == bytes.size() && stream_.avail_out > 0;
      if (is_out || (status == Z_BUF_ERROR && stream_.avail_in == 0 && taken == bytes.size()))
        throw std::invalid_argument(
            fmt::format("{}: what gzip packed is cut short after {} bytes", limits.name, out.size()));
      if (status != Z_OK && status != Z_BUF_ERROR)
        throw std::invalid_argument(fmt::format("{}: what gzip packed is damaged after {} bytes: {}",
                                                limits.name, out.size(),
                                                stream_.msg == nullptr ? "no reason given" : stream_.msg));
    }
  }

 private:
  z_stream stream_{};
};

}  // namespace

bool is_gzip(std::string_view bytes) noexcept { return bytes.starts_with("\x1F\x8B\x08"); }

std::string gunzip(std::string_view bytes, const UnpackedLimits& limits) {
  Inflating inflating;
  std::string out;
  while (is_gzip(bytes)) bytes.remove_prefix(inflating.member(bytes, limits, out));
  if (bytes.find_first_not_of('\0') != std::string_view::npos)
    throw std::invalid_argument(
        fmt::format("{}: {} bytes after what gzip packed are not gzip's", limits.name, bytes.size()));
  return out;
}

}  // namespace kerf::bench
