#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <kerf/fitting/jnd.h>

#include "plot/plot.h"
#include "stability/device/sampled_loop.h"

namespace kerf::bench {

/// A force over time.
struct CaseTrace {
  std::vector<double> time_s;
  std::vector<double> force_n;

  void add(double time, double force) {
    time_s.push_back(time);
    force_n.push_back(force);
  }
};

/// No device renders more; a run that gets there is over.
inline constexpr double lost_n = 1000.0;

/// Force that a hand feels for certain, the floor of the bench's threshold [N].
inline constexpr double felt_n = fitting::force_jnd.threshold;

/// rms of a force about its mean over the last `share` of a trace [N].
[[nodiscard]] double ripple_n(const CaseTrace& trace, double share = 0.25);

/// A force as a reader wants it: "0.36 N", "below 0.001 N", "beyond 1000 N".
[[nodiscard]] std::string newtons(double force_n);

/// A curve of a trace, thinned for a small picture.
[[nodiscard]] Curve curve_of(const CaseTrace& trace, std::string label, Colour colour);

/// What every picture of a case shares: the run that failed in vermillion, behind it the one that held in
/// blue.
[[nodiscard]] Chart two_traces(std::string title, const CaseTrace& failing, std::string failing_label,
                               const CaseTrace& holding, std::string holding_label);

/// What a hand does to a device: a force on it, and where its spring rests.
struct HandPush {
  double force_n = 0.0;
  double position_m = 0.0;
};

/// The force that a device in a hand renders over `seconds`, positive against the motion into it; `hand(t)`
/// gives the HandPush. Ends early at lost_n.
template <typename Force, typename Hand>
[[nodiscard]] CaseTrace run_loop(const SampledDevice& device, Force force, AxisMotion start, double seconds,
                                 Hand hand) {
  SampledLoop loop(device, std::move(force), start);
  CaseTrace trace;
  const auto ticks = static_cast<std::size_t>(std::lround(seconds / device.period_s));
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    const double time_s = static_cast<double>(tick) * device.period_s;
    const HandPush push = hand(time_s);
    loop.step(push.force_n, push.position_m);
    trace.add(time_s, -loop.held_n());
    if (!(std::abs(loop.held_n()) < lost_n)) break;
  }
  return trace;
}

}  // namespace kerf::bench
