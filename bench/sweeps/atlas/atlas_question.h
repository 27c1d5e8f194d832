#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "atlas/sweep_atlas.h"

namespace kerf::bench {

/// What is drawn of the cells behind a tile.
enum class AtlasStatistic : std::uint8_t { mean, median, smallest, largest, share };

/// `damping_lower <= 12`: a column against a number, or against another column.
struct AtlasCondition {
  enum class Relation : std::uint8_t { less, at_most, greater, at_least };
  std::string column;
  Relation relation = Relation::less;
  std::string other;  ///< a column; empty: the number
  double number = 0.0;
};

/// Cells that count: of a listed input those with one of some values, of another column those in a range.
struct AtlasFilter {
  std::string column;
  std::vector<std::string> among{};
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// A way to look at a table of a sweep: up to four columns that part its cells, and what is known of each
/// part.
///
/// As JSON, and in the same words in a file of pictures:
///
///     { "table": "walls", "by": ["delay", "stiffness"], "of": "spectral_radius", "statistic": "median",
///       "where": { "mass": ["0.1"], "spectral_radius": [0.5, null] } }
///
/// or, in place of `of` and `statistic`, "share": "damping_lower <= 12 & damping_upper >= 12".
struct AtlasQuestion {
  static constexpr std::size_t most_parts = 4;
  static constexpr std::size_t usual_bins = 32;
  static constexpr std::size_t most_tiles = 200'000;

  std::string table;
  std::vector<std::string> by;  ///< the first changes fastest
  std::string of;
  AtlasStatistic statistic = AtlasStatistic::mean;
  std::vector<AtlasCondition> share;  ///< all of them hold, where the statistic is that
  std::vector<AtlasFilter> where;
  std::size_t bins = usual_bins;  ///< of a column whose values are not listed

  /// Whether its numbers are a share of cells, with a unit of 1.
  [[nodiscard]] bool is_share() const noexcept { return statistic == AtlasStatistic::share; }
};

/// @throws std::invalid_argument for what is none, in one line; whether there are such columns is told later.
[[nodiscard]] AtlasQuestion question_from_json(const nlohmann::json& json);
[[nodiscard]] AtlasStatistic statistic_called(std::string_view name);
[[nodiscard]] std::string_view name_of(AtlasStatistic statistic) noexcept;
/// "a <= 3 & b > c"
[[nodiscard]] std::vector<AtlasCondition> parse_conditions(std::string_view text);
[[nodiscard]] std::string in_words(const std::vector<AtlasCondition>& conditions);

}  // namespace kerf::bench
