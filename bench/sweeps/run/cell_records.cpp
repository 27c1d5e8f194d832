#include "run/cell_records.h"

#include <bit>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include <nlohmann/json.hpp>
#include <zlib.h>

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "records are as they lie in memory");

constexpr std::size_t head_of_frame = 2 * sizeof(std::uint32_t);
constexpr std::size_t largest_record = std::size_t{16} << 20U;

template <typename T>
void add(std::string& to, T value) {
  static_assert(std::is_trivially_copyable_v<T>);
  const std::size_t before = to.size();
  to.resize(before + sizeof value);
  std::memcpy(to.data() + before, &value, sizeof value);
}

/// Takes values off the front of a record.
class Taking {
 public:
  explicit Taking(std::string_view bytes) : bytes_(bytes) {}
  template <typename T>
  T take() {
    if (bytes_.size() < sizeof(T)) throw std::invalid_argument("a record is too short");
    T value;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }
  [[nodiscard]] std::string_view rest() const noexcept { return bytes_; }

 private:
  std::string_view bytes_;
};

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      ::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

/// A frame around what `fill` appends.
template <typename Fill>
void add_frame(std::string& to, char kind, const Fill& fill) {
  const std::size_t begin = to.size();
  to.append(head_of_frame, '\0');
  to.push_back(kind);
  fill();
  const std::string_view record = std::string_view(to).substr(begin + head_of_frame);
  const auto length = static_cast<std::uint32_t>(record.size());
  const std::uint32_t crc = crc_of(record);
  std::memcpy(to.data() + begin, &length, sizeof length);
  std::memcpy(to.data() + begin + sizeof length, &crc, sizeof crc);
}

CellRecord record_in(std::string_view bytes) {
  Taking taking(bytes);
  const char kind = taking.take<char>();
  if (kind == 'H') return HeadRecord{.json = taking.rest()};
  if (kind == 'L') {
    const auto layout = taking.take<std::uint64_t>();
    return LayoutRecord{.layout = layout, .text = taking.rest()};
  }
  const auto cell = taking.take<std::uint64_t>();
  const auto seconds = taking.take<double>();
  if (kind == 'C') {
    const auto layout = taking.take<std::uint64_t>();
    if (taking.rest().size() % sizeof(double) != 0) throw std::invalid_argument("half a number");
    return ComputedCell{.cell = cell, .seconds = seconds, .layout = layout, .numbers = taking.rest()};
  }
  if (kind != 'F') throw std::invalid_argument("a record of no kind");
  const auto failure = taking.take<std::uint8_t>();
  if (failure > static_cast<std::uint8_t>(Failure::no_memory))
    throw std::invalid_argument("a failure of no kind");
  return FailedCell{
      .cell = cell, .seconds = seconds, .failure = static_cast<Failure>(failure), .why = taking.rest()};
}

}  // namespace

std::string_view in_words(Failure failure) {
  switch (failure) {
    case Failure::no_answer:
      return "no answer";
    case Failure::crashed:
      return "crashed";
    case Failure::too_long:
      return "too long";
    case Failure::no_memory:
      return "no memory";
  }
  return "";
}

std::string CellLayout::as_text() const {
  json all = json::array({table});
  for (const CellColumn& column : columns) all.push_back({column.name, column.unit});
  return all.dump();
}

std::uint64_t CellLayout::number_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a, the same everywhere
  for (const char one : text) hash = (hash ^ static_cast<unsigned char>(one)) * 0x100000001b3U;
  return hash;
}

CellLayout CellLayout::from_text(std::string_view text) {
  try {
    const json all = json::parse(text);
    CellLayout layout{.table = all.at(0).get<std::string>(), .columns = {}};
    for (std::size_t i = 1; i < all.size(); ++i)
      layout.columns.push_back(
          {.name = all[i].at(0).get<std::string>(), .unit = all[i].at(1).get<std::string>()});
    return layout;
  } catch (const json::exception&) {
    throw std::invalid_argument("a layout that is none");
  }
}

std::vector<double> ComputedCell::values() const {
  std::vector<double> values(numbers.size() / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), numbers.data(), numbers.size());
  return values;
}

void add_head(std::string& to, std::string_view text) {
  add_frame(to, 'H', [&] { to += text; });
}

void add_layout(std::string& to, std::uint64_t layout, std::string_view text) {
  add_frame(to, 'L', [&] {
    add(to, layout);
    to += text;
  });
}

void add_computed(std::string& to, std::uint64_t cell, double seconds, std::uint64_t layout,
                  std::span<const double> values) {
  add_frame(to, 'C', [&] {
    add(to, cell);
    add(to, seconds);
    add(to, layout);
    for (const double value : values) add(to, value);
  });
}

void add_failed(std::string& to, const FailedCell& failed) {
  add_frame(to, 'F', [&] {
    add(to, failed.cell);
    add(to, failed.seconds);
    add(to, static_cast<std::uint8_t>(failed.failure));
    to += failed.why;
  });
}

std::optional<Frame> first_frame(std::string_view bytes) {
  if (bytes.size() < head_of_frame) return std::nullopt;
  Taking head(bytes);
  const auto length = head.take<std::uint32_t>();
  const auto crc = head.take<std::uint32_t>();
  if (length == 0 || length > largest_record || bytes.size() - head_of_frame < length) return std::nullopt;
  const std::string_view record = bytes.substr(head_of_frame, length);
  if (crc_of(record) != crc) return std::nullopt;
  try {
    return Frame{.size = head_of_frame + length, .record = record_in(record)};
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

CellRecord record_of_frame(std::string_view bytes) {
  const auto length = Taking(bytes).take<std::uint32_t>();
  return record_in(bytes.substr(head_of_frame, length));
}

bool may_become_frame(std::string_view bytes) {
  if (bytes.size() < head_of_frame) return true;
  const auto length = Taking(bytes).take<std::uint32_t>();
  return length > 0 && length <= largest_record && bytes.size() - head_of_frame < length;
}

}  // namespace kerf::bench
