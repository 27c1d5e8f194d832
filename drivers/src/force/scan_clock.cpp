#include "kerf/drivers/scan_clock.h"

#include <algorithm>
#include <cmath>

namespace kerf::drivers {
namespace {

constexpr double block_s = 0.25;
constexpr std::size_t least_blocks = 4;  // before, a packet that came late would turn the line too far

}  // namespace

ScanClock::ScanClock(double nominal_period_s, double most_drift) noexcept
    : period_s_(nominal_period_s),
      most_drift_(most_drift),
      block_scans_(static_cast<std::uint64_t>(std::max(1.0, std::round(block_s / nominal_period_s)))) {}

ScanClock::Point ScanClock::point_of(std::uint64_t scan, std::int64_t arrived_ns) const noexcept {
  const double nominal_s = static_cast<double>(scan - first_scan_) * period_s_;
  return {.nominal_s = nominal_s, .late_s = 1e-9 * static_cast<double>(arrived_ns - first_ns_) - nominal_s};
}

void ScanClock::add(std::uint64_t scan, std::int64_t arrived_ns) noexcept {
  if (!started_) {
    started_ = true;
    first_scan_ = scan;
    first_ns_ = arrived_ns;
    block_ = 0;
  }
  const std::uint64_t block = (scan - first_scan_) / block_scans_;
  if (block != block_) end_block();
  block_ = block;
  const Point point = point_of(scan, arrived_ns);
  if (!has_least_ || above_line(point) < above_line(least_)) least_ = point;
  has_least_ = true;
  // No scan was taken after it arrived.
  offset_s_ = std::min(offset_s_, point.late_s - slope_ * point.nominal_s);
}

void ScanClock::restart() noexcept {
  started_ = has_least_ = false;
  block_count_ = 0;
  offset_s_ = 0.0;
}

std::int64_t ScanClock::time_ns(std::uint64_t scan) const noexcept {
  const double nominal_s = static_cast<double>(scan - first_scan_) * period_s_;
  return first_ns_ + std::llround(1e9 * (nominal_s + offset_s_ + slope_ * nominal_s));
}

void ScanClock::end_block() noexcept {
  if (!has_least_) return;
  if (block_count_ == max_blocks) {
    first_block_ = (first_block_ + 1) % max_blocks;
    --block_count_;
  }
  blocks_[(first_block_ + block_count_) % max_blocks] = least_;
  ++block_count_;
  has_least_ = false;
  if (block_count_ >= least_blocks) fit_line();
}

void ScanClock::fit_line() noexcept {
  std::array<Point, max_blocks> hull{};
  std::size_t corners = 0;
  double mean_s = 0.0;
  for (std::size_t at = 0; at < block_count_; ++at) {
    const Point& next = kept(at);
    mean_s += next.nominal_s / static_cast<double>(block_count_);
    const auto turns_right = [&] {
      const Point& before = hull[corners - 2];
      const Point& last = hull[corners - 1];
      return (last.late_s - before.late_s) * (next.nominal_s - before.nominal_s) >=
             (next.late_s - before.late_s) * (last.nominal_s - before.nominal_s);
    };
    while (corners >= 2 && turns_right()) --corners;
    hull[corners++] = next;
  }
  std::size_t edge = 0;
  while (edge + 2 < corners && hull[edge + 1].nominal_s < mean_s) ++edge;
  const Point& from = hull[edge];
  const Point& to = hull[edge + 1];
  slope_ = std::clamp((to.late_s - from.late_s) / (to.nominal_s - from.nominal_s), -most_drift_, most_drift_);
  offset_s_ = from.late_s - slope_ * from.nominal_s;
  for (std::size_t at = 0; at < block_count_; ++at) offset_s_ += std::min(0.0, above_line(kept(at)));
  std::array<double, max_blocks> above{};
  for (std::size_t at = 0; at < block_count_; ++at) above[at] = above_line(kept(at));
  // Two lie on the line because it was laid through them: they say nothing of how well.
  const auto median = above.begin() + static_cast<std::ptrdiff_t>(2 + (block_count_ - 2) / 2);
  std::nth_element(above.begin(), median, above.begin() + static_cast<std::ptrdiff_t>(block_count_));
  const double span_s = kept(block_count_ - 1).nominal_s - kept(0).nominal_s;
  slope_error_ = 2.0 * *median / span_s;
}

}  // namespace kerf::drivers
