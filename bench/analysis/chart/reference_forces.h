#pragma once

#include <string>
#include <vector>

#include <kerf/fitting/fit.h>

#include "chart/fidelities.h"
#include "chart/speed_accuracy.h"
#include "laws/render.h"

namespace kerf::bench {

/// The reference that points of a scene are judged by.
class ReferenceForces {
 public:
  /// @throws std::invalid_argument if the reference fails, or never pushes.
  ReferenceForces(const Fidelity& reference, const ScriptedPath& path, std::vector<std::size_t> axes,
                  const fitting::Jnd& jnd);

  /// Fills the point's errors and its stability from the forces of its law at its rate.
  void compare(const RenderedMotion& forces, ChartPoint& point) const;

  [[nodiscard]] const std::vector<std::size_t>& axes() const noexcept { return axes_; }
  [[nodiscard]] double jnd_n(std::size_t place) const { return about_.at(place).jnd_n; }
  /// Force of the reference at a time, linear between its ticks.
  [[nodiscard]] double force_n(std::size_t place, double time_s) const;
  /// The JND of the axis that a point was judged by.
  [[nodiscard]] double jnd_of(const std::string& axis) const;

 private:
  /// An axis of the law, its forces as forces at the hand.
  struct Axis {
    std::string name;
    std::size_t axis = 0;
    double lever_m = 1.0;  ///< 1 where the device has a force in N
    double jnd_n = 0.0;
  };
  [[nodiscard]] bool pushes(double time_s) const;

  std::vector<Axis> about_;
  std::vector<std::size_t> axes_;
  std::vector<drivers::Axes> reference_;
  fitting::Jnd jnd_;
  double rate_hz_ = 0.0;
  double peak_n_ = 0.0;
};

}  // namespace kerf::bench
