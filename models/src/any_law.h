#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string_view>

#include "kerf/models/law.h"

namespace kerf::models {

class ForeignLaw;

/// Place of a law in the registry, those of plug-ins behind it.
using Place = std::size_t;

struct AnyState {
  explicit AnyState(Place of) noexcept : law(of) {}
  AnyState(const AnyState&) = default;
  AnyState& operator=(const AnyState&) = delete;
  virtual ~AnyState() = default;
  [[nodiscard]] virtual std::unique_ptr<AnyState> copy() const = 0;
  /// Only of a state of the same law.
  virtual void assign(const AnyState& other) = 0;

  const Place law;
};

/// Whether a law is asked at all: numbers that are finite, and time that passes.
[[nodiscard]] inline bool is_sound(const Motion& motion, double period_s) noexcept {
  return std::isfinite(motion.penetration) && std::isfinite(motion.velocity) && period_s > 0.0 &&
         std::isfinite(period_s);
}

/// Ticks by a step that gives a number that is not finite where it faults.
template <typename Step>
void step_each(std::span<const Motion> motion, std::span<const double> period_s, std::span<double> force,
               const Step& step) noexcept {
  const bool one_period = period_s.size() == 1;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const double period = period_s[one_period ? 0 : i];
    const double given =
        is_sound(motion[i], period) ? step(motion[i], period) : std::numeric_limits<double>::quiet_NaN();
    force[i] = std::isfinite(given) ? given : std::numeric_limits<double>::quiet_NaN();
  }
}

struct AnyLaw {
  AnyLaw() = default;
  AnyLaw(const AnyLaw&) = delete;
  AnyLaw& operator=(const AnyLaw&) = delete;
  virtual ~AnyLaw() = default;
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;
  [[nodiscard]] virtual std::unique_ptr<AnyState> initial_state() const = 0;
  // Not a number: a fault, also if the state is another law's or the law of the other kind.
  [[nodiscard]] virtual double step(AnyState& state, const Motion& motion,
                                    double period_s) const noexcept = 0;
  [[nodiscard]] virtual AxisValues step(AnyState& state, const SpatialMotion& motion,
                                        double period_s) const noexcept = 0;
  /// As Law::steps().
  virtual void steps(AnyState& state, std::span<const Motion> motion, std::span<const double> period_s,
                     std::span<double> force) const noexcept {
    step_each(motion, period_s, force,
              [&](const Motion& tick, double period) noexcept { return step(state, tick, period); });
  }
  /// Not a number: the law has none, or the state is another law's.
  [[nodiscard]] virtual double stored_energy(const AnyState& state) const noexcept = 0;
};

/// A plug-in's law with its parameters. @throws std::invalid_argument where they make no law.
[[nodiscard]] std::shared_ptr<const AnyLaw> made_of(const ForeignLaw& law, std::span<const double> values);

}  // namespace kerf::models
