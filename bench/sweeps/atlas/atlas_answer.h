#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "atlas/atlas_question.h"
#include "atlas/sweep_atlas.h"

namespace kerf::bench {

/// A column that parts cells, and its parts in order: the values of a listed input, stretches of another one.
struct AtlasAxis {
  std::string column;
  std::string unit;
  std::vector<std::string> names;  ///< of the values; empty: stretches
  std::vector<double> values;      ///< where they are numbers
  std::vector<double> edges;       ///< of stretches: one more than there are
  [[nodiscard]] std::size_t parts() const noexcept { return names.empty() ? edges.size() - 1 : names.size(); }
  /// Numbers each of which is the one before times the same, about, or all above zero over two decades.
  [[nodiscard]] bool is_logarithmic() const;
};

/// What is known of the cells of a part. A cell that failed, is missing, or whose number nobody knows, is in
/// no value.
struct AtlasTile {
  std::uint32_t computed = 0;
  std::uint32_t known = 0;  ///< of these
  std::uint32_t failed = 0;
  std::uint32_t missing = 0;
  double value = std::numeric_limits<double>::quiet_NaN();  ///< NaN: none is known

  [[nodiscard]] std::uint32_t cells() const noexcept { return computed + failed + missing; }
};

struct AtlasAnswer {
  std::vector<AtlasAxis> axes;
  std::vector<AtlasTile> tiles;  ///< of all combinations, the first axis changes fastest
  std::string unit;              ///< of the values
  AtlasTile all;                 ///< of all cells that count
};

/// @throws std::invalid_argument in one line for a question that the sweep does not answer.
[[nodiscard]] AtlasAnswer answer(SweepAtlas& atlas, const AtlasQuestion& question);

/// Some of the cells that count, taken by chance but always the same ones, each with its number and a value
/// of each column: for what draws a line a cell.
struct AtlasSample {
  std::vector<AtlasColumn> columns;
  std::vector<std::vector<double>> values;  ///< of each column; of a listed one places in its list
  std::vector<std::string> state;           ///< "", "failed", "missing"
  std::size_t of = 0;                       ///< so many count
};
[[nodiscard]] AtlasSample sample(SweepAtlas& atlas, const AtlasQuestion& question,
                                 const std::vector<std::string>& columns, std::size_t most);

/// Smallest and largest of what is known of a column; NaN where nothing is.
struct AtlasSpan {
  double smallest = std::numeric_limits<double>::quiet_NaN();
  double largest = std::numeric_limits<double>::quiet_NaN();
  std::size_t known = 0;
};
[[nodiscard]] AtlasSpan span_of(SweepAtlas& atlas, std::size_t table, std::size_t column);

/// "delay [s]"
[[nodiscard]] std::string with_unit(const std::string& name, const std::string& unit);

}  // namespace kerf::bench
