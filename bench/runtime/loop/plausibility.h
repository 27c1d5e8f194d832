#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <kerf/drivers/device.h>

namespace kerf::bench {

/// What may be made of a reading.
enum class Trust : std::uint8_t {
  believed,  ///< the tool is there
  jumped,    ///< it cannot have got there: from now on doubted
  doubted,   ///< after a jump, until two more reports have said where the tool is
  slipped    ///< and they did not say that it is where it was: nobody knows, until somebody confirms
};

/// Whether hand and mechanism can have brought the tool to where a report says that it is.
///
/// On each axis, with the limits v_l of speed and a of acceleration, the time t since the report before (t'
/// of that one since the one before it, with the way dx') and what a stamp may be wrong by, which is added to
/// t,
///
///     |dx| <= min(v_l t, v t + a t^2 / 2) + 2 encoder steps,   v = |dx'| / t' + a t' / 2
///
/// v is the fastest that the tool can have been. Speed may end at once, as at a stop, but not come from
/// nowhere. A limit that is not known (0) limits nothing. After a report that breaks this two more decide: if
/// both can follow from the place before and lie nearer to it than to the jump, a bit was turned on the way,
/// and the tool is believed again; else the place is in doubt for good (an encoder slipped), until confirm().
/// A tick without a new report decides nothing: it is one with the same position, whose age has grown with
/// the loop's time.
class Plausibility {
 public:
  explicit Plausibility(const drivers::DeviceInfo& device) noexcept
      : count_(device.axes.size()), jitter_s_(device.report_jitter_s) {
    for (std::size_t axis = 0; axis < count_; ++axis) {
      speed_limit_[axis] = device.axes[axis].speed_limit;
      acceleration_limit_[axis] = device.axes[axis].acceleration_limit;
      slack_[axis] = 2.0 * device.axes[axis].resolution;
    }
  }

  /// Time has passed without an answer that could be read.
  void pass(double elapsed_s) noexcept { now_s_ += elapsed_s; }

  /// A reading with finite numbers, `elapsed_s` after the last call, which is known to `within_s`.
  [[nodiscard]] Trust judge(const drivers::Sample& sample, double elapsed_s, double within_s = 0.0) noexcept {
    pass(elapsed_s);
    within_s_ = std::max(within_s, within_s_ - elapsed_s);
    const bool is_repeated =
        started_ && sample.position == last_.position && sample.age_s - age_s_ >= 0.5 * elapsed_s;
    age_s_ = sample.age_s;
    if (is_repeated) return trust_ == Trust::jumped ? trust_ = Trust::doubted : trust_;
    const Place here{.position = sample.position, .taken_s = now_s_ - sample.age_s};
    if (!started_) {
      started_ = true;
      move_to(here, false);
    } else if (trust_ == Trust::jumped || trust_ == Trust::doubted) {
      decide(here);
    } else if (trust_ == Trust::believed && !can_follow(here, last_)) {
      trust_ = Trust::jumped;
      before_ = last_;
      to_come_ = 2;
      agreeing_ = 0;
      move_to(here, false);
    } else {
      move_to(here, true);
    }
    return trust_;
  }

  /// Somebody says that the tool is where it seems to be.
  void confirm() noexcept { trust_ = Trust::believed; }

 private:
  static constexpr double unlimited = std::numeric_limits<double>::infinity();

  struct Place {
    drivers::Axes position{};
    drivers::Axes speed{};         ///< the fastest that it can have been there
    drivers::Axes speed_before{};  ///< and at the report before
    double taken_s = 0.0;
  };

  [[nodiscard]] bool can_follow(const Place& here, const Place& from) const noexcept {
    const double time_s = std::max(here.taken_s - from.taken_s, 0.0) + jitter_s_ + within_s_;
    for (std::size_t axis = 0; axis < count_; ++axis) {
      double farthest = unlimited;
      if (speed_limit_[axis] > 0.0) farthest = speed_limit_[axis] * time_s;
      if (const double a = acceleration_limit_[axis]; a > 0.0) {
        const double speed = std::max(from.speed[axis], from.speed_before[axis]);
        farthest = std::min(farthest, (speed + 0.5 * a * time_s) * time_s);
      }
      if (std::abs(here.position[axis] - from.position[axis]) > farthest + slack_[axis]) return false;
    }
    return true;
  }

  /// On the axes that jumped: nearer to the place before than to the jump.
  [[nodiscard]] bool is_back(const Place& here) const noexcept {
    for (std::size_t axis = 0; axis < count_; ++axis) {
      const double jump = last_.position[axis] - before_.position[axis];
      const double came = here.position[axis] - before_.position[axis];
      if (std::abs(jump) > slack_[axis] && std::abs(came) > std::abs(came - jump)) return false;
    }
    return true;
  }

  void decide(const Place& here) noexcept {
    if (is_back(here) && can_follow(here, before_)) ++agreeing_;
    trust_ = Trust::doubted;
    if (--to_come_ > 0) return;
    trust_ = agreeing_ == 2 ? Trust::believed : Trust::slipped;
    if (trust_ == Trust::believed) last_ = before_;
    move_to(here, trust_ == Trust::believed);
  }

  /// `was_moved`: by the hand, so that the way says how fast it can be.
  void move_to(const Place& here, bool was_moved) noexcept {
    // A stamp that is late makes the next time too short: no shorter than half of what it may be wrong by.
    const double time_s = std::max(here.taken_s - last_.taken_s - jitter_s_, 0.5 * jitter_s_);
    last_.speed_before = last_.speed;
    for (std::size_t axis = 0; axis < count_; ++axis) {
      const double way = std::abs(here.position[axis] - last_.position[axis]);
      last_.speed[axis] =
          was_moved && time_s > 0.0 ? way / time_s + 0.5 * acceleration_limit_[axis] * time_s : unlimited;
    }
    last_.position = here.position;
    last_.taken_s = here.taken_s;
  }

  std::size_t count_;
  double jitter_s_;
  drivers::Axes speed_limit_{};
  drivers::Axes acceleration_limit_{};
  drivers::Axes slack_{};
  Place last_;
  Place before_;  ///< the jump
  double now_s_ = 0.0;
  double within_s_ = 0.0;
  double age_s_ = 0.0;
  int to_come_ = 0;
  int agreeing_ = 0;
  Trust trust_ = Trust::believed;
  bool started_ = false;
};

}  // namespace kerf::bench
