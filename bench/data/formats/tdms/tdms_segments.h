#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kerf::bench {

/// A moment of TDMS: 2^-64 s and s since 1904-01-01 of UTC.
struct TdmsMoment {
  std::int64_t seconds = 0;
  std::uint64_t fractions = 0;
};

/// Numbers, texts and moments; of other types nothing is kept.
using TdmsValue = std::variant<std::monostate, double, std::string, TdmsMoment>;

/// One channel: what all segments say of it and hold of it.
struct TdmsChannel {
  std::string path;  ///< as in the file, /'group'/'channel'
  std::map<std::string, TdmsValue> properties;
  std::vector<double> values;       ///< of numbers
  std::vector<TdmsMoment> moments;  ///< of moments
  std::string unread;             ///< what it holds that is not read: "texts", "complex numbers"; else empty
  bool is_beyond_double = false;  ///< a whole number beyond 2^53 was among the values
};

struct TdmsFile {
  std::vector<TdmsChannel> channels;  ///< those that hold data, in the order in which they come
  std::vector<std::string> notes;
};

[[nodiscard]] bool is_tdms(std::string_view bytes) noexcept;

/// Reads a TDMS file by NI's "TDMS File Format Internal Structure": segments with metadata of their own or
/// that of the one before, contiguous or interleaved, of either byte order, in one chunk or several. Of a
/// last segment that was not closed or is cut short the rows that are whole are kept, and the rest is told
/// of.
/// @throws std::invalid_argument that names file and byte for what is damaged, of another version, or DAQmx.
[[nodiscard]] TdmsFile tdms_segments(std::string_view bytes, const std::string& name);

}  // namespace kerf::bench
