#include "kerf/drivers/streamed_force.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "age_limits.h"
#include "kerf/drivers/usb/io_thread.h"

namespace kerf::drivers {

StreamedForce::StreamedForce(std::size_t extras) noexcept
    : extras_(std::min(extras, max_extras)), opened_ns_(usb::now_ns()) {}

void StreamedForce::resample(Rule rule, double delay_s) noexcept {
  rule_ = rule;
  delay_ns_ = std::llround(1e9 * delay_s);
}

void StreamedForce::put(const Reading& reading) noexcept {
  window_.last[window_.count++ % kept] = reading;
  shared_.put(window_);
}

StreamedForce::Reading StreamedForce::at(std::int64_t wanted_ns) const noexcept {
  const Reading& newest = seen_.before(0);
  if (rule_ == Rule::latest || newest.taken_ns <= wanted_ns) return newest;
  const std::size_t most = std::min(seen_.count, kept);
  for (std::size_t back = 1; back < most; ++back) {
    const Reading& before = seen_.before(back);
    if (before.taken_ns > wanted_ns) continue;
    Reading between = seen_.before(back - 1);
    const auto span = static_cast<double>(between.taken_ns - before.taken_ns);
    const double share = static_cast<double>(wanted_ns - before.taken_ns) / span;
    for (std::size_t i = 0; i < max_axes; ++i)
      between.wrench[i] = before.wrench[i] + share * (between.wrench[i] - before.wrench[i]);
    between.sound = between.sound && before.sound;
    between.taken_ns = wanted_ns;
    return between;
  }
  return seen_.before(most - 1);
}

Status StreamedForce::read(double now_s, Sample& sample) noexcept {
  if (lost()) return Status::lost;
  shared_.take(seen_);
  const std::int64_t now = usb::now_ns();
  // The loop's zero on this clock: no tick is woken early, and the least late one tells it.
  const auto loop_ns = static_cast<std::int64_t>(std::llround(1e9 * now_s));
  loop_start_ns_ = std::min(loop_start_ns_, now - loop_ns);
  const std::int64_t tick_ns = loop_start_ns_ + loop_ns;
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  sample.position = sample.velocity = {};
  sample.force_measured.fill(nothing);
  if (seen_.count == 0) {
    std::fill_n(sample.channels.begin(), 2 + extras_, nothing);
    return now - opened_ns_ > max_silence_ns ? Status::lost : Status::fault;
  }
  const std::int64_t newest_age_ns = now - seen_.before(0).taken_ns;
  const Reading reading = at(tick_ns - delay_ns_);
  const bool fresh = newest_age_ns <= max_reading_age_ns;
  if (fresh && reading.sound) sample.force_measured = reading.wrench;
  sample.channels[0] = 1e-9 * static_cast<double>(tick_ns - reading.taken_ns);
  sample.channels[1] = static_cast<double>(reading.number);
  for (std::size_t i = 0; i < extras_; ++i) sample.channels[2 + i] = fresh ? reading.extras[i] : nothing;
  if (newest_age_ns > max_silence_ns) lose();
  if (lost()) return Status::lost;
  return fresh && reading.sound ? Status::ok : Status::fault;
}

Status StreamedForce::write(const Axes& force) const noexcept {
  for (const double one : force) {
    if (!std::isfinite(one)) return Status::fault;
  }
  return lost() ? Status::lost : Status::ok;
}

std::vector<AxisInfo> sensor_axes() {
  std::vector<AxisInfo> axes;
  for (const char* name : {"x", "y", "z", "rx", "ry", "rz"}) {
    const bool turns = name[0] == 'r';
    axes.push_back({.name = name, .position_unit = turns ? "rad" : "m", .force_unit = turns ? "N·m" : "N"});
  }
  return axes;
}

}  // namespace kerf::drivers
