#include "replay/path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include <kerf/drivers/hand.h>

namespace kerf::bench {
namespace {

constexpr double peak_of_minimum_jerk = 1.875;  // speed over mean speed

std::size_t axis_on(const drivers::DeviceInfo& device, const schema::Axis& axis, bool alone) {
  const auto fits = [&](const drivers::AxisInfo& info) {
    return info.position_unit == axis.position_unit && info.force_unit == axis.force_unit;
  };
  for (std::size_t at = 0; at < device.axes.size(); ++at) {
    if (device.axes[at].name == axis.name && fits(device.axes[at])) return at;
  }
  for (std::size_t at = 0; at < device.axes.size() && alone; ++at) {
    if (fits(device.axes[at])) return at;
  }
  throw std::invalid_argument(fmt::format("the recording moves axis '{}' ({} over {}), and {} has none such",
                                          axis.name, axis.force_unit, axis.position_unit, device.model));
}

/// Refuses a row that the device cannot be at, or be brought to in time.
void check_row(const Source& source, std::size_t row, const Path& path, const drivers::DeviceInfo& device,
               const PathOptions& options) {
  const schema::Recording& recording = source.recording;
  const std::size_t axes = recording.dimensions();
  const auto after_gap = [&] {
    return std::ranges::any_of(source.gaps, [&](const Gap& gap) { return gap.after + 1 == row; });
  };
  for (std::size_t axis = 0; axis < axes; ++axis) {
    const drivers::AxisInfo& info = device.axes[path.axes[axis]];
    const double position = recording.position[row * axes + axis];
    const double slack = 2.0 * info.resolution;
    if (position < info.lower - slack || position > info.upper + slack) {
      throw std::invalid_argument(
          fmt::format("row {} at {:g} s: {} = {:g} {} is out of the device's range, {:g} to {:g}; replay "
                      "other rows (--from, --to)",
                      source.row[row], recording.time[row], info.name, position, info.position_unit,
                      info.lower, info.upper));
    }
    if (row == 0 || !(info.speed_limit > 0.0)) continue;
    const double step_s = (recording.time[row] - recording.time[row - 1]) / options.speed;
    const double step = std::abs(position - recording.position[(row - 1) * axes + axis]);
    if (step <= info.speed_limit * step_s + slack || (!options.bridge && after_gap())) continue;
    throw std::invalid_argument(fmt::format(
        "row {} at {:g} s: {} would move at {:.3g} {}/s, and the device's limit is {:g}; replay other rows, "
        "or slower (--speed)",
        source.row[row], recording.time[row], info.name, step / step_s, info.position_unit,
        info.speed_limit));
  }
}

Path::Piece piece_of(const SampledMotion& motion, std::size_t begin, std::size_t end, const Path& path,
                     double speed) {
  Path::Piece piece;
  for (std::size_t row = begin; row < end; ++row) {
    piece.time_s.push_back((motion.time_s[row] - motion.time_s[begin]) / speed);
    models::SpatialMotion& sample = piece.sample.emplace_back();
    for (std::size_t axis = 0; axis < path.axes.size(); ++axis) {
      sample.position[path.axes[axis]] = motion.sample[row].position[axis];
      sample.velocity[path.axes[axis]] = speed * motion.sample[row].velocity[axis];
    }
  }
  // A duration that is whole in ticks stays so, however it was rounded.
  piece.ticks = static_cast<std::uint64_t>(std::ceil(piece.time_s.back() / path.period_s - 1e-6));
  return piece;
}

std::uint64_t ticks_of_move(const Path& path, const drivers::Axes& from, const drivers::Axes& to) noexcept {
  double seconds = 0.0;
  for (const std::size_t axis : path.axes) {
    seconds =
        std::max(seconds, peak_of_minimum_jerk * std::abs(to[axis] - from[axis]) / path.move_limit[axis]);
  }
  return static_cast<std::uint64_t>(std::ceil(seconds / path.period_s));
}

void find_longest_pass(Path& path, const drivers::DeviceInfo& device) {
  drivers::Axes lower{};
  drivers::Axes upper{};
  for (const std::size_t axis : path.axes) {
    // A device may begin beyond its own range, and a tick that is not rendered delays the rest.
    lower[axis] = 2.0 * device.axes[axis].lower - device.axes[axis].upper;
    upper[axis] = device.axes[axis].upper;
  }
  for (const Path::Piece& piece : path.pieces)
    path.max_ticks += piece.ticks + piece.wait_ticks + ticks_of_move(path, lower, upper) + 2;
}

}  // namespace

Path make_path(const Source& source, const drivers::DeviceInfo& device, double period_s,
               const PathOptions& options) {
  if (!(options.speed >= 0.1 && options.speed <= 10.0)) {
    throw std::invalid_argument(fmt::format("a speed of {} is not between 0.1 and 10", options.speed));
  }
  const schema::Recording& recording = source.recording;
  Path path{.period_s = period_s, .loop = options.loop, .axes = {}, .pieces = {}};
  for (const schema::Axis& axis : recording.axes)
    path.axes.push_back(axis_on(device, axis, recording.dimensions() == 1));
  for (const std::size_t axis : path.axes) {
    const drivers::AxisInfo& info = device.axes[axis];
    if (!(info.upper > info.lower)) {
      throw std::invalid_argument(fmt::format(
          "axis '{}' of {} says nothing of its range, so that nothing can be moved along it safely",
          info.name, device.model));
    }
    path.move_limit[axis] = options.move_share_per_s * (info.upper - info.lower);
    if (info.speed_limit > 0.0) path.move_limit[axis] = std::min(path.move_limit[axis], info.speed_limit);
  }
  for (std::size_t row = 0; row < recording.rows(); ++row) check_row(source, row, path, device, options);
  const SampledMotion motion = motion_of(source);
  std::size_t begin = 0;
  for (const Gap& gap : source.gaps) {
    if (options.bridge) break;
    path.pieces.push_back(piece_of(motion, begin, gap.after + 1, path, options.speed));
    path.pieces.back().wait_ticks =
        static_cast<std::uint64_t>(std::llround((gap.end_s - gap.begin_s) / options.speed / period_s));
    begin = gap.after + 1;
  }
  path.pieces.push_back(piece_of(motion, begin, recording.rows(), path, options.speed));
  find_longest_pass(path, device);
  return path;
}

Reference PathPlayer::step(std::uint64_t ticks, const drivers::Axes& position) noexcept {
  if (part_ == Part::begin) {
    for (const std::size_t axis : path_->axes) reference_.position[axis] = position[axis];
    begin_move();
  } else {
    at_ += ticks;
  }
  while (part_ != Part::end && at_ > length_) next();
  reference_.playing = part_ == Part::play;
  reference_.finished = part_ == Part::end;
  reference_.velocity = {};
  if (part_ == Part::move) move_on();
  if (part_ == Part::play) play_on();
  return reference_;
}

void PathPlayer::enter(Part part, std::uint64_t ticks) noexcept {
  at_ -= length_;
  part_ = part;
  length_ = ticks;
}

/// A part that is over leaves the reference at its end, from where the next one goes on.
void PathPlayer::next() noexcept {
  const Path::Piece& piece = path_->pieces[piece_];
  if (part_ == Part::move) {
    reference_.position = piece.sample.front().position;
    row_ = 0;
    return enter(Part::play, piece.ticks);
  }
  if (part_ == Part::play) {
    reference_.position = piece.sample.back().position;
    return enter(Part::wait, piece.wait_ticks);
  }
  if (piece_ + 1 == path_->pieces.size() && !path_->loop) return enter(Part::end, 0);
  piece_ = (piece_ + 1) % path_->pieces.size();
  begin_move();
}

void PathPlayer::begin_move() noexcept {
  from_ = reference_.position;
  enter(Part::move, ticks_of_move(*path_, from_, path_->pieces[piece_].sample.front().position));
}

void PathPlayer::move_on() noexcept {
  const drivers::Axes& to = path_->pieces[piece_].sample.front().position;
  const double seconds = static_cast<double>(length_) * path_->period_s;
  const drivers::MinimumJerk stroke =
      length_ > 0 ? drivers::MinimumJerk::at(static_cast<double>(at_) / static_cast<double>(length_))
                  : drivers::MinimumJerk{.position = 1.0};
  for (const std::size_t axis : path_->axes) {
    reference_.position[axis] = from_[axis] + stroke.position * (to[axis] - from_[axis]);
    if (length_ > 0) reference_.velocity[axis] = stroke.speed * (to[axis] - from_[axis]) / seconds;
  }
}

void PathPlayer::play_on() noexcept {
  const Path::Piece& piece = path_->pieces[piece_];
  const double now_s = static_cast<double>(at_) * path_->period_s;
  while (row_ + 2 < piece.time_s.size() && piece.time_s[row_ + 1] <= now_s) ++row_;
  const std::size_t after = std::min(row_ + 1, piece.time_s.size() - 1);
  const double length_s = piece.time_s[after] - piece.time_s[row_];
  const double share = length_s > 0.0 ? std::clamp((now_s - piece.time_s[row_]) / length_s, 0.0, 1.0) : 1.0;
  for (const std::size_t axis : path_->axes) {
    const auto& [position, velocity] = piece.sample[row_];
    reference_.position[axis] =
        position[axis] + share * (piece.sample[after].position[axis] - position[axis]);
    reference_.velocity[axis] =
        velocity[axis] + share * (piece.sample[after].velocity[axis] - velocity[axis]);
  }
}

}  // namespace kerf::bench
