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
  explicit SegmentedMemory(std::size_t max_segments) : max_segments_(max_segments) {}

  [[nodiscard]] std::size_t max_segments() const noexcept { return max_segments_; }
  /// @throws std::invalid_argument as fit_segments() does.
  [[nodiscard]] std::vector<SegmentedCurve> curves(const Curve& points);

 private:
  struct Entry {
    std::vector<double> position;
    std::vector<double> force;
    std::vector<double> weight;
    std::vector<std::uint8_t> branch;
    std::once_flag once;
    std::vector<SegmentedCurve> curves;

    explicit Entry(const Curve& points);
    [[nodiscard]] bool is_of(const Curve& points) const;
  };
  Entry& entry_of(const Curve& points);

  std::size_t max_segments_;
  std::mutex mutex_;
  std::list<Entry> entries_;
};

}  // namespace kerf::fitting
