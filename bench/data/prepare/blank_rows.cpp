#include "prepare/blank_rows.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

double stroke_speed(const schema::Recording& recording, const std::vector<double>& position,
                    const schema::PhaseSpan& span) {
  const std::size_t last = span.end - 1;
  if (last <= span.begin) return 0.0;
  return std::abs(position[last] - position[span.begin]) /
         (recording.time[last] - recording.time[span.begin]);
}

}  // namespace

BlankPlaces::BlankPlaces(const schema::Recording& recording, const schema::Cycles& cycles,
                         const std::vector<double>& position, const ToolForce& tool, double speed_factor)
    : places_(recording.rows()), phases_(cycles.phases) {
  std::ranges::sort(phases_, {}, &schema::PhaseSpan::begin);
  std::vector<Cover> covers;
  for (const schema::PhaseSpan& span : phases_) {
    if (span.begin >= span.end || span.end > recording.rows())
      throw std::invalid_argument("its cycles have rows that are not there; run 'kerf segment' again");
    covers.push_back(Cover::yes);
    const bool closing = span.phase == schema::Phase::closing;
    if (!closing && span.phase != schema::Phase::opening) continue;
    const BlankBranch& branch = closing ? tool.closing : tool.opening;
    const double speed = stroke_speed(recording, position, span);
    speeds_[closing ? 1 : 0].push_back(speed);
    if (speed > branch.fastest * speed_factor) covers.back() = Cover::too_fast;
    if (speed < branch.slowest / speed_factor) covers.back() = Cover::too_slow;
  }
  for (std::size_t i = 0; i < phases_.size(); ++i) place(i, covers);
}

double BlankPlaces::median_speed(bool closing) const {
  const auto& speeds = speeds_[closing ? 1 : 0];
  return speeds.empty() ? 0.0 : median(speeds);
}

std::optional<double> BlankPlaces::stroke_at(std::size_t i) const {
  if (i >= phases_.size()) return std::nullopt;
  if (phases_[i].phase == schema::Phase::closing) return 1.0;
  if (phases_[i].phase == schema::Phase::opening) return 0.0;
  return std::nullopt;
}

void BlankPlaces::place(std::size_t i, const std::vector<Cover>& covers) {
  const schema::PhaseSpan& span = phases_[i];
  const auto own = stroke_at(i);
  const auto before = own ? own : i > 0 ? stroke_at(i - 1) : std::nullopt;
  const auto after = own ? own : stroke_at(i + 1);
  if (!before && !after) return;
  Cover cover = covers[i];
  if (!own && before && covers[i - 1] != Cover::yes) cover = covers[i - 1];
  if (!own && after && covers[i + 1] != Cover::yes) cover = covers[i + 1];
  const double from = before ? *before : *after;
  const double to = after ? *after : *before;
  const auto length = static_cast<double>(span.end - span.begin);
  for (std::uint64_t row = span.begin; row < span.end; ++row) {
    const double share = (static_cast<double>(row - span.begin) + 0.5) / length;
    places_[row] = {.closing = std::lerp(from, to, share), .cover = cover};
  }
}

}  // namespace kerf::bench
