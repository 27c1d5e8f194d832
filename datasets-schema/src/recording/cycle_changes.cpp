#include "recording/cycle_changes.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <tuple>

#include "recording/build.h"

namespace kerf::schema {
namespace {

constexpr std::array<std::string CycleChange::*, 4> change_texts{&CycleChange::time, &CycleChange::author,
                                                                 &CycleChange::kind, &CycleChange::text};
constexpr std::array<const char*, 4> change_text_names{"time", "author", "kind", "text"};
constexpr std::size_t change_numbers = 5;

auto numbers_of(auto& change) {
  return std::tie(change.edit, change.cycle, change.phase, change.row_before, change.row_after);
}

constexpr std::size_t bytes_of_numbers = 2 * sizeof(std::uint32_t) + 1 + 2 * sizeof(std::int64_t);

}  // namespace

ChangeRoom room_for_changes(std::span<const CycleChange> changes) {
  ChangeRoom room{1, 1, 1, 1};
  for (const CycleChange& change : changes) {
    for (std::size_t i = 0; i < room.size(); ++i)
      room[i] = std::max(room[i], (change.*change_texts[i]).size());
  }
  return room;
}

ChangeRoom room_of_changes(std::span<const std::size_t> field_sizes) {
  ChangeRoom room{};
  for (std::size_t i = 0; i < room.size(); ++i) room[i] = field_sizes[change_numbers + i];
  return room;
}

std::size_t record_size(const ChangeRoom& room) {
  return bytes_of_numbers + room[0] + room[1] + room[2] + room[3];
}

h5::Handle change_type(const ChangeRoom& room) {
  std::vector<h5::Field> fields;
  std::size_t offset = 0;
  const auto add = [&](const char* name, const char* type, std::size_t size) {
    fields.push_back({name, type, size, offset});
    offset += size;
  };
  add("edit", "uint32", sizeof(std::uint32_t));
  add("cycle", "uint32", sizeof(std::uint32_t));
  add("phase", "uint8", sizeof(std::uint8_t));
  add("row_before", "int64", sizeof(std::int64_t));
  add("row_after", "int64", sizeof(std::int64_t));
  for (std::size_t i = 0; i < room.size(); ++i) add(change_text_names[i], "text", room[i]);
  return h5::record_type(fields, offset);
}

std::vector<std::byte> pack_changes(std::span<const CycleChange> changes, const ChangeRoom& room) {
  std::vector<std::byte> records(changes.size() * record_size(room));
  auto* to = records.data();
  for (const CycleChange& change : changes) {
    const auto put = [&](const auto& number) {
      std::memcpy(to, &number, sizeof number);
      to += sizeof number;
    };
    std::apply([&](const auto&... numbers) { (put(numbers), ...); }, numbers_of(change));
    for (std::size_t i = 0; i < room.size(); to += room[i++]) {
      const std::string& text = change.*change_texts[i];
      std::memcpy(to, text.data(), fitting(text, room[i]));
    }
  }
  return records;
}

std::vector<CycleChange> unpack_changes(std::span<const std::byte> records, const ChangeRoom& room) {
  std::vector<CycleChange> changes(records.size() / record_size(room));
  const auto* from = records.data();
  for (CycleChange& change : changes) {
    const auto get = [&](auto& number) {
      std::memcpy(&number, from, sizeof number);
      from += sizeof number;
    };
    std::apply([&](auto&... numbers) { (get(numbers), ...); }, numbers_of(change));
    for (std::size_t i = 0; i < room.size(); from += room[i++])
      change.*change_texts[i] = text_in(from, room[i]);
  }
  return changes;
}

}  // namespace kerf::schema
