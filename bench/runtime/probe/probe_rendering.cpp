#include "probe/probe_rendering.h"

#include <algorithm>
#include <cmath>

#include "loop/safety.h"

namespace kerf::bench {
namespace {

constexpr double force_share = 0.1;
constexpr double most_force_n = 1.0;
constexpr double most_torque_n_m = 0.05;

constexpr double ramp_s = 0.03;
constexpr double hold_s = 0.1;
constexpr double push_s = ramp_s + hold_s + ramp_s;
constexpr double counts_from_s = 0.05;
constexpr double counts_until_s = 0.1;
constexpr double least_rest_s = 0.15;
constexpr double patience_s = 1.0;

constexpr double farthest_m = 0.01;
constexpr double farthest_wrong_m = 0.003;
constexpr double still_m_s = 0.005;
constexpr double assumed_lever_m = 0.1;  // which makes a distance of the angle where the force is a torque

// Of Thue and Morse: the sums of +1 and -1 over 8, weighted by 1, k and k^2, are zero.
constexpr std::array order{1.0, -1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0};

bool is_torque(const drivers::AxisInfo& axis) noexcept { return axis.force_unit == "N·m"; }

double smooth(double share) noexcept { return share * share * (3.0 - 2.0 * share); }

/// 0 to 1 and back.
double strength_at(double time_s) noexcept {
  return smooth(std::clamp(std::min(time_s, push_s - time_s) / ramp_s, 0.0, 1.0));
}

}  // namespace

double push_force(const drivers::AxisInfo& axis) noexcept {
  return std::min(force_share * axis.force_limit, is_torque(axis) ? most_torque_n_m : most_force_n);
}

ProbeRendering::ProbeRendering(const drivers::DeviceInfo& device) : device_(device) {
  for (std::size_t axis = 0; axis < device_.axes.size(); ++axis) {
    const double force = push_force(device_.axes[axis]);
    if (force > 0.0) probed_.push_back({.axis = axis, .force = force, .judgement = {}});
  }
  pushes_.reserve(2 * most_push_pairs);
  const std::array<Push, 4> none{};
  (void)judge_pushes(none, device_, 0);  // what it computes once is not for the tick
}

double ProbeRendering::longest_s() const noexcept {
  const auto pushes = static_cast<double>(2 * most_push_pairs * probed_.size());
  return pushes * (patience_s + push_s);
}

void ProbeRendering::begin_rest() noexcept {
  is_pushing_ = false;
  time_s_ = 0.0;
  seen_count_ = 0;
}

double ProbeRendering::lever_of(std::size_t axis) const noexcept {
  const drivers::AxisInfo& about = device_.axes[axis];
  return is_torque(about) ? assumed_lever_m * about.lever : about.lever;
}

/// Least squares over what was seen last; its position is that of now.
ProbeRendering::Line ProbeRendering::fitted_line() const noexcept {
  const auto count = static_cast<double>(line_samples);
  double mean_s = 0.0;
  drivers::Axes mean{};
  for (const Seen& seen : seen_) {
    mean_s += seen.time_s / count;
    for (std::size_t axis = 0; axis < mean.size(); ++axis) mean[axis] += seen.position[axis] / count;
  }
  double squares = 0.0;
  drivers::Axes products{};
  for (const Seen& seen : seen_) {
    const double time_s = seen.time_s - mean_s;
    squares += time_s * time_s;
    for (std::size_t axis = 0; axis < mean.size(); ++axis) {
      products[axis] += time_s * (seen.position[axis] - mean[axis]);
    }
  }
  Line line;
  for (std::size_t axis = 0; axis < mean.size(); ++axis) {
    line.speed[axis] = products[axis] / squares;
    line.position[axis] = mean[axis] + line.speed[axis] * (time_s_ - mean_s);
  }
  return line;
}

bool ProbeRendering::is_still(const Line& line) const noexcept {
  const std::size_t axis = probed_[at_].axis;
  return std::abs(line.speed[axis]) * lever_of(axis) < still_m_s;
}

Command ProbeRendering::step(const drivers::Sample& sample, double elapsed_s) noexcept {
  if (finished()) return {};
  time_s_ += elapsed_s;
  if (is_pushing_) return push(sample);
  rest(sample);
  return {};
}

void ProbeRendering::rest(const drivers::Sample& sample) noexcept {
  seen_[seen_count_++ % line_samples] = {.time_s = time_s_, .position = sample.position};
  if (time_s_ < least_rest_s || seen_count_ < line_samples) return;
  line_ = fitted_line();
  if (time_s_ < patience_s && !is_still(line_)) return;
  is_pushing_ = true;
  time_s_ = 0.0;
  moved_ = moved_last_ = {};
  moved_count_ = 0;
}

Command ProbeRendering::push(const drivers::Sample& sample) noexcept {
  const std::size_t pushed = probed_[at_].axis;
  const double direction = order[pushes_.size() % order.size()];
  bool went_too_far = false;
  for (std::size_t axis = 0; axis < device_.axes.size(); ++axis) {
    moved_last_[axis] = sample.position[axis] - line_.position[axis] - line_.speed[axis] * time_s_;
    const double travel = lever_of(axis) * moved_last_[axis];
    went_too_far |= std::abs(travel) > farthest_m;
    if (axis == pushed) went_too_far |= direction * travel < -farthest_wrong_m;
  }
  if (time_s_ >= counts_from_s && time_s_ <= counts_until_s) {
    for (std::size_t axis = 0; axis < moved_.size(); ++axis) moved_[axis] += moved_last_[axis];
    ++moved_count_;
  }
  if (went_too_far) ++probed_[at_].stopped;
  if (went_too_far || time_s_ >= push_s) {
    end_push();
    return {};
  }
  Command command;
  command.force[pushed] = direction * strength_at(time_s_) * probed_[at_].force;
  return command;
}

void ProbeRendering::end_push() noexcept {
  Push push{.direction = order[pushes_.size() % order.size()], .moved = moved_last_};
  if (moved_count_ > 0) {
    for (std::size_t axis = 0; axis < moved_.size(); ++axis) {
      push.moved[axis] = moved_[axis] / static_cast<double>(moved_count_);
    }
  }
  pushes_.push_back(push);
  begin_rest();
  ProbedAxis& probed = probed_[at_];
  probed.pushes = pushes_.size();
  if (pushes_.size() % 2 != 0) return;
  probed.judgement = judge_pushes(pushes_, device_, probed.axis);
  const bool is_sure = probed.judgement.verdict != PushVerdict::unknown;
  if (!is_sure && pushes_.size() < 2 * most_push_pairs) return;
  pushes_.clear();
  ++at_;
}

void ProbeRendering::see(const schema::Row& row) noexcept {
  // The rows of a soft start say so to its end.
  if ((row.flags & (zero_force_flags | schema::flag_soft_start)) != 0) begin_rest();
}

}  // namespace kerf::bench
