#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "verbs/sweep_verb.h"

// What a worker tells of cells and a shard's file keeps: records in frames, one after the other.
//
//     frame    length of the record (uint32), its CRC-32 (uint32), the record
//     record   kind (one byte), then
//              'H'  JSON: what shard of which plan this is
//              'L'  number of a layout (uint64), JSON: its table and columns
//              'C'  cell (uint64), seconds that it took (float64), layout (uint64), its numbers (float64)
//              'F'  cell (uint64), seconds (float64), Failure (one byte), why in words
//
// in little-endian byte order. Frames are whole or not there: what a crash left of the last one is cut off.

namespace kerf::bench {

enum class Failure : std::uint8_t {
  no_answer,  ///< the verb says why
  crashed,    ///< its worker died of it, twice
  too_long,   ///< it took longer than a cell may
  no_memory,  ///< it took more memory than a worker may
};
[[nodiscard]] std::string_view in_words(Failure failure);

/// Tables and columns of cells; equal ones have one number in every process.
struct CellLayout {
  std::string table;
  std::vector<CellColumn> columns;

  [[nodiscard]] std::string as_text() const;
  [[nodiscard]] static std::uint64_t number_of(std::string_view text);
  /// @throws std::invalid_argument
  [[nodiscard]] static CellLayout from_text(std::string_view text);
};

struct ComputedCell {
  std::uint64_t cell = 0;
  double seconds = 0.0;
  std::uint64_t layout = 0;
  std::string_view numbers;  ///< float64 each, not aligned

  [[nodiscard]] std::vector<double> values() const;
};

struct FailedCell {
  std::uint64_t cell = 0;
  double seconds = 0.0;
  Failure failure = Failure::no_answer;
  std::string_view why;
};

struct LayoutRecord {
  std::uint64_t layout = 0;
  std::string_view text;
};

struct HeadRecord {
  std::string_view json;
};

using CellRecord = std::variant<HeadRecord, LayoutRecord, ComputedCell, FailedCell>;

// Frames are appended to a text.
void add_head(std::string& to, std::string_view json);
void add_layout(std::string& to, std::uint64_t layout, std::string_view text);
void add_computed(std::string& to, std::uint64_t cell, double seconds, std::uint64_t layout,
                  std::span<const double> values);
void add_failed(std::string& to, const FailedCell& failed);

/// A frame at the beginning of `bytes`: where it ends, and its record, which looks into them.
struct Frame {
  std::size_t size = 0;
  CellRecord record;
};
/// None: it is not whole, or damaged.
[[nodiscard]] std::optional<Frame> first_frame(std::string_view bytes);
/// The record of a frame that was found whole before; its CRC is not looked at again.
[[nodiscard]] CellRecord record_of_frame(std::string_view bytes);
/// Whether more bytes may yet make it whole.
[[nodiscard]] bool may_become_frame(std::string_view bytes);

}  // namespace kerf::bench
