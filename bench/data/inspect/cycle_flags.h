#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "inspect/cycle_facts.h"

namespace kerf::bench {

/// Why a cycle may not be taken for one like the others.
enum class CycleFault : std::uint8_t { put_down, under_force, clipped, interrupted, outlier, by_hand };

/// "put_down", as JSON and recordings have it.
[[nodiscard]] std::string_view name_of(CycleFault fault) noexcept;

struct CycleFlag {
  CycleFault fault;
  std::string reason;  ///< with its numbers
};

/// How far a cycle is from the others by one of its quantities.
struct CycleDistance {
  std::string quantity;
  double distance =
      0.0;  ///< signed, in standard deviations of the others' logarithms, by their median and MAD
};

struct FlaggedCycle {
  CycleFacts facts;
  std::vector<CycleFlag> flags{};
  std::optional<CycleDistance>
      farthest{};  ///< of closing time, peak and closing work; unknown among too few cycles
  std::optional<std::string> accepted{};  ///< why a person takes it all the same

  [[nodiscard]] bool is_good() const noexcept { return flags.empty() || accepted.has_value(); }
};

/// Flags each cycle by what is wrong with it, beside the others of its recording:
///
///     put_down      a second and more of its hold, and three times the usual hold, is out of contact: the
///     tool
///                   lies there closed
///     under_force   its peak is not felt, or less than a third of the usual one
///     clipped       rows of it stand at an end of the sensor's range
///     interrupted   rows are missing, or the recording ends before it opens again
///     outlier       its closing time, peak or closing work is farther from the median of the cycles without
///     a flag, in
///                   logarithms, than 3.5 (1 + 6/n) robust standard deviations (1.4826 MAD, at least 5 %)
///
/// Usual is the median of all cycles. With fewer than six cycles without a flag no distance is known. Of
/// cycles that differ at random, normally in logarithms, 1.6 % are beyond by one quantity where there are
/// six, 0.9 % of ten and 0.4 % of twenty (4,000 draws each).
[[nodiscard]] std::vector<FlaggedCycle> flag_cycles(std::span<const CycleFacts> cycles, double least_felt,
                                                    std::string_view force_unit);

/// Why a cycle is flagged, all reasons in one line.
[[nodiscard]] std::string reasons_of(const FlaggedCycle& cycle);

/// "1-4,6": numbers of the cycles without a flag, as `kerf prepare --cycles` takes them.
[[nodiscard]] std::string good_cycles(std::span<const FlaggedCycle> cycles);

}  // namespace kerf::bench
