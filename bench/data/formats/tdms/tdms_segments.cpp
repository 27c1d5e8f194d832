#include "formats/tdms/tdms_segments.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "formats/tdms/tdms_cursor.h"

namespace kerf::bench {
namespace {

using namespace tdms;

constexpr std::string_view tag = "TDSm";
constexpr std::size_t lead_in = 28;
constexpr std::uint64_t not_closed = std::numeric_limits<std::uint64_t>::max();

enum Toc : std::uint32_t {
  has_metadata = 2,
  has_new_list = 4,
  has_raw_data = 8,
  is_interleaved = 32,
  is_big_endian = 64,
  is_daqmx = 128
};

bool is_whole(std::uint32_t type) { return type == type_i64 || type == type_u64; }

/// What a segment holds of a channel in each of its chunks.
struct RawIndex {
  std::uint32_t type = 0;
  std::uint64_t count = 0;
  std::uint64_t bytes = 0;
};

struct Object {
  TdmsChannel channel;
  RawIndex index;
  bool has_index = false;
  bool is_listed = false;
  bool holds_data = false;  ///< in the segments that go by the list as it is
};

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  TdmsFile read() {
    for (std::size_t at = 0; at < bytes_.size();) at = take_segment(at);
    TdmsFile file{.channels = {}, .notes = std::move(notes_)};
    for (Object& object : objects_) {
      const TdmsChannel& channel = object.channel;
      if (!channel.values.empty() || !channel.moments.empty() || !channel.unread.empty())
        file.channels.push_back(std::move(object.channel));
    }
    return file;
  }

 private:
  /// Returns where the next one begins.
  std::size_t take_segment(std::size_t at) {
    const std::size_t left = bytes_.size() - at;
    if (left < lead_in) return leave_out(left);
    if (bytes_.substr(at, tag.size()) != tag)
      Cursor(bytes_, at, bytes_.size(), false, name_).refuse("has no segment");
    Cursor head(bytes_, at + tag.size(), at + lead_in, false, name_);
    const auto toc = head.take<std::uint32_t>();
    Cursor rest(bytes_, at + 8, at + lead_in, (toc & is_big_endian) != 0, name_);
    const auto version = rest.take<std::uint32_t>();
    if (version != 4712 && version != 4713)
      rest.refuse(fmt::format("has version {}; expected 4712 or 4713", version));
    const auto next = rest.take<std::uint64_t>();
    const auto raw = rest.take<std::uint64_t>();
    if ((toc & is_daqmx) != 0) refuse_daqmx("");
    const std::size_t begin = at + lead_in;
    const bool is_cut = next > bytes_.size() - begin;  // not_closed is
    const std::size_t end = is_cut ? bytes_.size() : begin + next;
    if (is_cut && next != not_closed)
      notes_.push_back(
          fmt::format("it is cut short: its last segment has {} bytes of {}", end - begin, next));
    if (next == not_closed) notes_.emplace_back("its last segment was not closed");
    if (raw > end - begin) {
      if (!is_cut) rest.refuse("says that raw data begin behind their segment");
      return bytes_.size();
    }
    if ((toc & has_metadata) != 0) take_metadata(toc, begin, begin + raw);
    if ((toc & has_raw_data) != 0) take_raw(toc, begin + raw, end);
    return end;
  }

  std::size_t leave_out(std::size_t bytes) {
    if (bytes > 0) notes_.push_back(fmt::format("it is cut short: {} bytes at its end are left out", bytes));
    return bytes_.size();
  }

  [[noreturn]] void refuse_daqmx(const std::string& path) const {
    throw std::invalid_argument(fmt::format(
        "{}: a TDMS file of DAQmx's raw counts{}, whose scales are NI's own; expected values: write it "
        "anew in LabVIEW by TDMS Write, or export it as CSV",
        name_, path.empty() ? "" : ", " + path));
  }

  void take_metadata(std::uint32_t toc, std::size_t begin, std::size_t end) {
    if ((toc & has_new_list) != 0) {
      for (const std::size_t listed : list_) objects_[listed].is_listed = objects_[listed].holds_data = false;
      list_.clear();
    }
    Cursor cursor(bytes_, begin, end, (toc & is_big_endian) != 0, name_);
    for (auto left = cursor.take<std::uint32_t>(); left > 0; --left) take_object(cursor);
    chunk_bytes_ = 0;
    for (const std::size_t listed : list_) {
      const Object& object = objects_[listed];
      if (!object.holds_data) continue;
      if (object.index.bytes > bytes_.size() - std::min<std::uint64_t>(bytes_.size(), chunk_bytes_))
        chunk_bytes_ = bytes_.size() + 1;  // more than any segment holds
      else
        chunk_bytes_ += object.index.bytes;
    }
  }

  void take_object(Cursor& cursor) {
    const std::string path = cursor.take_text();
    const auto [place, is_new] = places_.try_emplace(path, objects_.size());
    if (is_new) objects_.emplace_back().channel.path = path;
    Object& object = objects_[place->second];
    take_index(cursor, object);
    if (!object.is_listed) list_.push_back(place->second);
    object.is_listed = true;
    for (auto left = cursor.take<std::uint32_t>(); left > 0; --left) {
      std::string property = cursor.take_text();
      object.channel.properties.insert_or_assign(std::move(property), take_value(cursor));
    }
  }

  static TdmsValue take_value(Cursor& cursor) {
    const auto type = cursor.take<std::uint32_t>();
    if (type == type_string) return cursor.take_text();
    if (type == type_time) return cursor.take_moment();
    const std::uint64_t size = size_of(type);
    if (size == 0) cursor.refuse(fmt::format("has a property of type {:#x}, which has no values", type));
    if (size <= 8 && type != type_complex_float) return cursor.take_number(type);
    (void)cursor.take_bytes(size);
    return {};
  }

  void take_index(Cursor& cursor, Object& object) {
    constexpr std::uint32_t none = 0xFFFFFFFF;
    constexpr std::uint32_t daqmx = 0x1269;
    constexpr std::uint32_t daqmx_digital = 0x126A;
    const auto length = cursor.take<std::uint32_t>();
    object.holds_data = length != none;
    if (length == none) return;
    if (length == daqmx || length == daqmx_digital) refuse_daqmx(object.channel.path);
    if (length == 0) {
      if (!object.has_index)
        cursor.refuse(fmt::format("takes over what was never said of {}", object.channel.path));
      object.holds_data = object.index.count > 0;
      return;
    }
    RawIndex index;
    index.type = cursor.take<std::uint32_t>();
    if (cursor.take<std::uint32_t>() != 1) cursor.refuse("has an array of more than one dimension");
    index.count = cursor.take<std::uint64_t>();
    const std::uint64_t size = size_of(index.type);
    if (index.type == type_string) {
      index.bytes = cursor.take<std::uint64_t>();
    } else if (size == 0) {
      cursor.refuse(fmt::format("has a channel of type {:#x}, whose values have no known size", index.type));
    } else {
      // More than the file holds is as much as anything is.
      index.bytes = index.count > bytes_.size() / size ? bytes_.size() + 1 : index.count * size;
    }
    object.index = index;
    object.has_index = true;
    object.holds_data = index.count > 0 && index.bytes > 0;
  }

  void take_raw(std::uint32_t toc, std::size_t begin, std::size_t end) {
    if (chunk_bytes_ == 0) {
      if (end > begin) notes_.push_back(fmt::format("{} bytes of raw data are of no channel", end - begin));
      return;
    }
    std::vector<Object*> held;
    for (const std::size_t listed : list_) {
      if (objects_[listed].holds_data) held.push_back(&objects_[listed]);
    }
    const bool big = (toc & is_big_endian) != 0;
    const bool interleaved = (toc & is_interleaved) != 0;
    if (interleaved) require_interleaved(held, begin);
    std::size_t at = begin;
    while (end - at >= chunk_bytes_) {
      const auto next = at + static_cast<std::size_t>(chunk_bytes_);
      take_chunk(held, interleaved, big, at, next, std::numeric_limits<std::uint64_t>::max());
      at = next;
    }
    if (at == end) return;
    const std::uint64_t rows = whole_rows(held, interleaved, end - at);
    if (rows > 0) take_chunk(held, interleaved, big, at, end, rows);
    notes_.push_back(fmt::format("its raw data end within a chunk: {} whole rows of it are kept", rows));
  }

  void require_interleaved(const std::vector<Object*>& held, std::size_t begin) const {
    for (const Object* object : held) {
      if (object->index.type == type_string || object->index.count != held.front()->index.count)
        Cursor(bytes_, begin, bytes_.size(), false, name_)
            .refuse(fmt::format("has interleaved channels of different lengths, {}", object->channel.path));
    }
  }

  /// Rows that every channel has in a chunk that is not whole.
  static std::uint64_t whole_rows(const std::vector<Object*>& held, bool interleaved, std::uint64_t bytes) {
    std::uint64_t before = 0;
    std::uint64_t row = 0;
    for (const Object* object : held) {
      if (object->index.type == type_string || object->index.count != held.front()->index.count) return 0;
      if (object != held.back()) before += object->index.bytes;
      row += size_of(object->index.type);
    }
    if (interleaved) return bytes / row;
    return bytes > before ? (bytes - before) / size_of(held.back()->index.type) : 0;
  }

  void take_chunk(const std::vector<Object*>& held, bool interleaved, bool big, std::size_t at,
                  std::size_t end, std::uint64_t most_rows) const {
    if (interleaved) {
      Cursor cursor(bytes_, at, end, big, name_);
      const std::uint64_t rows = std::min(held.front()->index.count, most_rows);
      for (std::uint64_t row = 0; row < rows; ++row) {
        for (Object* object : held) take_one(cursor, *object);
      }
      return;
    }
    for (Object* object : held) {
      Cursor cursor(bytes_, at, end, big, name_);
      at += static_cast<std::size_t>(std::min<std::uint64_t>(object->index.bytes, end - at));
      if (object->index.type == type_string) {
        object->channel.unread = "texts";
        continue;
      }
      const std::uint64_t rows = std::min(object->index.count, most_rows);
      for (std::uint64_t row = 0; row < rows; ++row) take_one(cursor, *object);
    }
  }

  static void take_one(Cursor& cursor, Object& object) {
    const std::uint32_t type = object.index.type;
    TdmsChannel& channel = object.channel;
    if (type == type_time) {
      channel.moments.push_back(cursor.take_moment());
      return;
    }
    if (type == type_extended || type == type_complex_float || type == type_complex_double) {
      channel.unread = type == type_extended ? "numbers of 80 bits or more" : "complex numbers";
      (void)cursor.take_bytes(size_of(type));
      return;
    }
    const double value = cursor.take_number(type);
    constexpr double most = 9007199254740992.0;
    channel.is_beyond_double = channel.is_beyond_double || (is_whole(type) && std::abs(value) >= most);
    channel.values.push_back(value);
  }

  std::string_view bytes_;
  const std::string& name_;
  std::vector<Object> objects_;
  std::map<std::string, std::size_t> places_;
  std::vector<std::size_t> list_;  ///< of objects, in the order of their raw data
  std::uint64_t chunk_bytes_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace

bool is_tdms(std::string_view bytes) noexcept { return bytes.starts_with(tag); }

TdmsFile tdms_segments(std::string_view bytes, const std::string& name) { return Reader(bytes, name).read(); }

}  // namespace kerf::bench
