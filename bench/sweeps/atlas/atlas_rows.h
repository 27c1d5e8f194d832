#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "atlas/atlas_answer.h"

namespace kerf::bench {

/// Which cells of a table count: 1 or 0 for each. A cell without a number of a column that is filtered by
/// does not.
[[nodiscard]] std::vector<std::uint8_t> rows_that_count(SweepAtlas& atlas, std::size_t table,
                                                        const std::vector<AtlasFilter>& filters);

/// The part that each cell of a table is in. An axis has no part for a value that filters keep out.
inline constexpr std::uint32_t in_no_part = 0xffffffffU;
struct PartedRows {
  AtlasAxis axis;
  std::vector<std::uint32_t> part;  ///< of each cell; in_no_part: its number is not known
};
[[nodiscard]] PartedRows parted_rows(SweepAtlas& atlas, std::size_t table, const std::string& column,
                                     const AtlasQuestion& question);

/// The number of each computed cell that a question is about: of a share 1 or 0. NaN is not known.
[[nodiscard]] std::vector<double> asked_numbers(SweepAtlas& atlas, std::size_t table,
                                                const AtlasQuestion& question);

}  // namespace kerf::bench
