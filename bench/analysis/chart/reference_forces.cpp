#include "chart/reference_forces.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr double scene_runaway = 10.0;  // times the largest force of the reference

}  // namespace

ReferenceForces::ReferenceForces(const Fidelity& reference, const ScriptedPath& path,
                                 std::vector<std::size_t> axes, const fitting::Jnd& jnd)
    : axes_(std::move(axes)), jnd_(jnd), rate_hz_(reference.rate_hz) {
  RenderedMotion forces = render(reference.law, axes_, path.at(rate_hz_));
  if (forces.faults > 0) {
    throw std::invalid_argument(
        fmt::format("the reference itself ({} of law '{}') fails on this path: its force is not finite",
                    reference.label, reference.law.law.model()));
  }
  reference_ = std::move(forces.force);
  std::size_t count = 0;
  for (std::size_t i = 0; i < reference_.size(); ++i) {
    if (pushes(static_cast<double>(i) / rate_hz_)) ++count;
  }
  if (count == 0) throw std::invalid_argument("the tool never meets the tissue on this path");
  for (const std::size_t axis : axes_) {
    const drivers::AxisInfo& info = path.device.axes.at(axis);
    Axis about{.name = info.name, .axis = axis, .lever_m = fitting::felt_lever(info.force_unit, info.lever)};
    double squares = 0.0;
    for (const drivers::Axes& force : reference_) {
      const double newtons = force[axis] / about.lever_m;
      squares += newtons * newtons;
      peak_n_ = std::max(peak_n_, std::abs(newtons));
    }
    about.jnd_n = jnd.at(std::sqrt(squares / static_cast<double>(count)));
    about_.push_back(about);
  }
}

bool ReferenceForces::pushes(double time_s) const {
  const auto at = static_cast<std::size_t>(std::lround(time_s * rate_hz_));
  const drivers::Axes& force = reference_[std::min(at, reference_.size() - 1)];
  return std::any_of(axes_.begin(), axes_.end(), [&](std::size_t axis) { return force[axis] != 0.0; });
}

double ReferenceForces::force_n(std::size_t place, double time_s) const {
  const Axis& about = about_[place];
  const double at = std::min(time_s * rate_hz_, static_cast<double>(reference_.size() - 1));
  const auto before = static_cast<std::size_t>(at + 1e-6);
  const auto after = std::min(before + 1, reference_.size() - 1);
  const double share = std::max(0.0, at - static_cast<double>(before));
  const double from = reference_[before][about.axis];
  return (from + share * (reference_[after][about.axis] - from)) / about.lever_m;
}

double ReferenceForces::jnd_of(const std::string& axis) const {
  for (const Axis& about : about_) {
    if (about.name == axis) return about.jnd_n;
  }
  return about_.front().jnd_n;
}

void ReferenceForces::compare(const RenderedMotion& forces, ChartPoint& point) const {
  double largest_n = 0.0;
  point.error_jnd = -1.0;
  point.jnd_fraction = 0.0;
  for (std::size_t place = 0; place < about_.size(); ++place) {
    double squares = 0.0;
    double worst = 0.0;
    std::size_t felt = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < forces.force.size(); ++i) {
      const double time_s = static_cast<double>(i) / point.rate_hz;
      const double newtons = forces.force[i][about_[place].axis] / about_[place].lever_m;
      largest_n = std::max(largest_n, std::abs(newtons));
      if (!pushes(time_s)) continue;
      const double wanted = force_n(place, time_s);
      const double error = newtons - wanted;
      if (!(std::abs(error) <= jnd_.at(wanted))) ++felt;
      squares += error * error;
      worst = std::max(worst, std::abs(error));
      ++count;
    }
    const double error_n = count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0.0;
    if (count > 0)
      point.jnd_fraction =
          std::max(point.jnd_fraction, static_cast<double>(felt) / static_cast<double>(count));
    if (error_n / about_[place].jnd_n <= point.error_jnd) continue;
    point.error_n = error_n;
    point.error_jnd = error_n / about_[place].jnd_n;
    point.worst_n = worst;
    point.axis = about_[place].name;
  }
  if (forces.faults > 0) {
    point.stability = not_stable("its force is not finite");
  } else if (largest_n > scene_runaway * peak_n_) {
    point.stability =
        not_stable(fmt::format("its force reaches {:.3g} N, the reference {:.3g} N", largest_n, peak_n_));
  }
}

}  // namespace kerf::bench
