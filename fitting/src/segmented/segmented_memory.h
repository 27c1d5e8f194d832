#pragma once

#include <cstdint>
#include <list>
#include <mutex>
#include <vector>

#include "kerf/fitting/segmented.h"

namespace kerf::fitting {

/// Finds curves once for the same points. Several threads may ask at once; those that ask for the same points
/// wait for the one that came first.
class SegmentedMemory {
 public:
  SegmentedMemory(std::size_t max_segments, std::size_t fewest_points)
      : max_segments_(max_segments), fewest_points_(fewest_points) {}

  /// Whether curves that were found so are among those remembered.
  [[nodiscard]] bool covers(const SegmentedOptions& options) const noexcept {
    return options.max_segments <= max_segments_ && options.fewest_points == fewest_points_;
  }
  /// @throws std::invalid_argument as fit_segments() does.
  [[nodiscard]] std::vector<SegmentedCurve> curves(const Curve& points, Polish polish);

 private:
  struct Entry {
    std::vector<double> position;
    std::vector<double> force;
    std::vector<double> weight;
    std::vector<std::uint8_t> branch;
    Polish polish;
    std::once_flag once;
    std::vector<SegmentedCurve> curves;

    Entry(const Curve& points, Polish by);
    [[nodiscard]] bool is_of(const Curve& points, Polish asked) const;
  };
  Entry& entry_of(const Curve& points, Polish polish);

  std::size_t max_segments_;
  std::size_t fewest_points_;
  std::mutex mutex_;
  std::list<Entry> entries_;
};

}  // namespace kerf::fitting
