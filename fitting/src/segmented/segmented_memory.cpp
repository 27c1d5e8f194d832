#include "segmented/segmented_memory.h"

#include <algorithm>

#include "kerf/fitting/fit.h"

namespace kerf::fitting {

SegmentedMemory::Entry::Entry(const Curve& points, Polish by)
    : position(points.position.begin(), points.position.end()),
      force(points.force.begin(), points.force.end()),
      weight(points.weight.begin(), points.weight.end()),
      branch(points.branch.begin(), points.branch.end()),
      polish(by) {}

bool SegmentedMemory::Entry::is_of(const Curve& points, Polish asked) const {
  return polish == asked && std::ranges::equal(weight, points.weight) &&
         std::ranges::equal(branch, points.branch) && std::ranges::equal(force, points.force) &&
         std::ranges::equal(position, points.position);
}

SegmentedMemory::Entry& SegmentedMemory::entry_of(const Curve& points, Polish polish) {
  const std::scoped_lock lock(mutex_);
  const auto found =
      std::ranges::find_if(entries_, [&](const Entry& one) { return one.is_of(points, polish); });
  return found != entries_.end() ? *found : entries_.emplace_back(points, polish);
}

std::vector<SegmentedCurve> SegmentedMemory::curves(const Curve& points, Polish polish) {
  Entry& entry = entry_of(points, polish);
  std::call_once(entry.once, [&] {
    entry.curves = fit_segments(
        points, {.max_segments = max_segments_, .fewest_points = fewest_points_, .polish = polish});
  });
  return entry.curves;
}

std::shared_ptr<SegmentedMemory> remember_segments(std::size_t max_segments, std::size_t points_per_segment) {
  return std::make_shared<SegmentedMemory>(max_segments, points_per_segment);
}

}  // namespace kerf::fitting
