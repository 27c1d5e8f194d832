#include "kerf/drivers/force_intake.h"

#include <algorithm>
#include <cmath>

namespace kerf::drivers {
namespace {

constexpr double most_drift =
    0.03;  // a rate is told by a name or a setting, and sensors are off by up to 2 %

}  // namespace

void ForceIntake::begin(double rate_hz) noexcept {
  rate_hz_ = rate_hz;
  clock_.emplace(1.0 / rate_hz, most_drift);
}

void ForceIntake::take_wrong() noexcept {
  ++wrong_;
  ++wrong_in_a_row_;
}

/// False where it is to be dropped.
bool ForceIntake::number(const ForceFrame& frame) noexcept {
  if (frames_ == 0) {
    number_ = 1;
    return true;
  }
  if (frame.begins_anew) {
    const double missed =
        clock_ ? 1e-9 * static_cast<double>(frame.arrived_ns - clock_->time_ns(number_)) * rate_hz_ : 1.0;
    const auto step = static_cast<std::uint64_t>(std::max(1.0, std::round(missed)));
    lost_ += step - 1;
    number_ += step;
    if (clock_) clock_->restart();
    ++restarts_;
    return true;
  }
  if (frame.step <= 0) {
    ++(frame.step == 0 ? duplicates_ : out_of_order_);
    return false;
  }
  lost_ += static_cast<std::uint64_t>(frame.step - 1);
  number_ += static_cast<std::uint64_t>(frame.step);
  return true;
}

void ForceIntake::take(const ForceFrame& frame) noexcept {
  wrong_in_a_row_ = 0;
  last_health_ = frame.health;
  if (!number(frame)) return;
  if (frames_++ == 0) first_ns_ = frame.arrived_ns;
  last_ns_ = frame.arrived_ns;
  if (frame.health == ForceHealth::overload) ++overloads_;
  if (frame.health == ForceHealth::doubted) ++errors_;
  if (frame.stands) ++standing_;
  if (!clock_) return;
  clock_->add(number_, frame.arrived_ns);
  drift_ppm_ = clock_->drift_ppm();
  drift_error_ppm_ = clock_->drift_error_ppm();
  StreamedForce::Reading reading{.wrench = frame.wrench,
                                 .number = number_,
                                 .taken_ns = clock_->time_ns(number_),
                                 .sound = frame.health == ForceHealth::sound && !frame.stands};
  reading.extras[0] = static_cast<double>(lost_);
  std::ranges::copy(frame.extras, reading.extras.begin() + 1);
  force_.put(reading);
}

std::vector<Figure> ForceIntake::figures() const {
  const auto count = [](const Count& value) { return static_cast<double>(value.load()); };
  const double seconds = 1e-9 * static_cast<double>(last_ns_ - first_ns_);
  std::vector<Figure> all{
      {"frame_rate", seconds > 0.0 ? (count(frames_) + count(lost_) - 1.0) / seconds : 0.0, "Hz"},
      {"frames", count(frames_), "1"},
      {"frames_lost", count(lost_), "1"},
      {"duplicates", count(duplicates_), "1"},
      {"out_of_order", count(out_of_order_), "1"},
      {"wrong_frames", count(wrong_), "1"},
      {"overloads", count(overloads_), "1"},
      {"sensor_errors", count(errors_), "1"},
      {"standing_frames", count(standing_), "1"},
      {"restarts", count(restarts_), "1"}};
  if (std::isfinite(drift_error_ppm_.load())) {
    all.push_back({"clock_drift", drift_ppm_, "ppm"});
    all.push_back({"clock_drift_error", drift_error_ppm_, "ppm"});
  }
  return all;
}

}  // namespace kerf::drivers
