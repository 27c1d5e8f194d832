#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <kerf/schema/recording.h>

#include "prepare/blank.h"

namespace kerf::bench {

/// Whether a blank may cover a row, by its stroke alone.
enum class Cover : std::uint8_t { yes, of_no_cycle, too_fast, too_slow };

/// How much of the closing branch a row has: 1 in a closing, 0 in an opening, in a turn from the one to the
/// other in proportion to time.
struct BlankPlace {
  double closing = std::numeric_limits<double>::quiet_NaN();
  Cover cover = Cover::of_no_cycle;
};

/// Every row of a recording in the strokes of its cycles, held against the speeds of a blank.
class BlankPlaces {
 public:
  /// @throws std::invalid_argument for phases of rows that are not there.
  BlankPlaces(const schema::Recording& recording, const schema::Cycles& cycles,
              const std::vector<double>& position, const ToolForce& tool, double speed_factor);

  [[nodiscard]] const std::vector<BlankPlace>& rows() const noexcept { return places_; }
  /// Of the strokes' mean speeds; 0 without strokes.
  [[nodiscard]] double median_speed(bool closing) const;

 private:
  [[nodiscard]] std::optional<double> stroke_at(std::size_t phase) const;
  void place(std::size_t phase, const std::vector<Cover>& covers);

  std::vector<BlankPlace> places_;
  std::vector<schema::PhaseSpan> phases_;
  std::array<std::vector<double>, 2> speeds_;  ///< of openings, of closings
};

}  // namespace kerf::bench
