#include "floor/force_map.h"

#include <algorithm>
#include <cmath>

namespace kerf::fitting {
namespace {

constexpr double fewest = 3.0;  ///< values that make a mean
constexpr double half_known =
    20.0;  ///< values at which a cell is believed by half: neighbours at 1 kHz say the same

std::size_t cell_of(double x, double least, double width, std::size_t bins) {
  const double place = std::floor((x - least) / width);
  return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(bins - 1)));
}

}  // namespace

BinnedCurve::BinnedCurve(double least, double most, std::size_t bins, bool with_slopes)
    : least_(least),
      width_((most - least) / static_cast<double>(bins)),
      with_slopes_(with_slopes),
      bins_(bins) {}

void BinnedCurve::add(double x, double v, double y) {
  Bin& bin = bins_[cell_of(x, least_, width_, bins_.size())];
  bin.x += x;
  bin.v += v;
  bin.y += y;
  bin.vv += v * v;
  bin.vy += v * y;
  bin.count += 1.0;
}

void BinnedCurve::settle() {
  std::erase_if(bins_, [](const Bin& bin) { return bin.count < fewest; });
  for (Bin& bin : bins_) {
    bin.x /= bin.count;
    bin.v /= bin.count;
    bin.y /= bin.count;
    const double variance = bin.vv / bin.count - bin.v * bin.v;
    if (with_slopes_ && variance > 1e-9 * bin.vv / bin.count)
      bin.slope = (bin.vy / bin.count - bin.v * bin.y) / variance;
  }
}

double BinnedCurve::at(double x, double v) const {
  const auto in = [&](const Bin& bin) { return bin.y + bin.slope * (v - bin.v); };
  if (bins_.empty()) return 0.0;
  const auto after = std::ranges::lower_bound(bins_, x, {}, &Bin::x);
  if (after == bins_.begin()) return in(*after);
  if (after == bins_.end()) return in(bins_.back());
  const Bin& before = *(after - 1);
  return in(before) + (in(*after) - in(before)) * (x - before.x) / (after->x - before.x);
}

BinnedSurface::BinnedSurface(double least, double most, std::size_t bins, std::vector<double> borders)
    : least_(least),
      width_((most - least) / static_cast<double>(bins)),
      bins_(bins),
      borders_(std::move(borders)),
      centre_(borders_.size() + 1, 0.0),
      mean_(bins * (borders_.size() + 1), 0.0),
      count_(mean_.size(), 0.0) {}

void BinnedSurface::add(double x, double v, double y) {
  const auto row = static_cast<std::size_t>(std::ranges::upper_bound(borders_, v) - borders_.begin());
  const std::size_t cell = row * bins_ + cell_of(x, least_, width_, bins_);
  centre_[row] += v;
  mean_[cell] += y;
  count_[cell] += 1.0;
}

void BinnedSurface::settle() {
  for (std::size_t row = 0; row < centre_.size(); ++row) {
    double values = 0.0;
    for (std::size_t bin = 0; bin < bins_; ++bin) values += count_[row * bins_ + bin];
    if (values > 0.0) {
      centre_[row] /= values;
    } else {  // between its borders: there are at least two rows
      centre_[row] = borders_[std::min(row, borders_.size() - 1)];
    }
  }
  for (std::size_t cell = 0; cell < mean_.size(); ++cell) mean_[cell] /= count_[cell] + half_known;
}

double BinnedSurface::in_row(std::size_t row, double place) const {
  const auto before = static_cast<std::size_t>(place);
  const std::size_t after = std::min(before + 1, bins_ - 1);
  const double share = place - static_cast<double>(before);
  return (1.0 - share) * mean_[row * bins_ + before] + share * mean_[row * bins_ + after];
}

double BinnedSurface::at(double x, double v) const {
  const double place = std::clamp((x - least_) / width_ - 0.5, 0.0, static_cast<double>(bins_ - 1));
  const auto after = static_cast<std::size_t>(std::ranges::lower_bound(centre_, v) - centre_.begin());
  if (after == 0) return in_row(0, place);
  if (after == centre_.size()) return in_row(after - 1, place);
  const double apart = centre_[after] - centre_[after - 1];
  const double share = apart > 0.0 ? (v - centre_[after - 1]) / apart : 0.0;
  return (1.0 - share) * in_row(after - 1, place) + share * in_row(after, place);
}

}  // namespace kerf::fitting
