#include <limits>
#include <vector>

#include "any_law.h"
#include "kerf/models/foreign.h"

namespace kerf::models {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

struct AnyForeignState final : AnyState {
  AnyForeignState(Place of, ForeignState first) : AnyState(of), state(std::move(first)) {}
  [[nodiscard]] std::unique_ptr<AnyState> copy() const override {
    return std::make_unique<AnyForeignState>(law, state);
  }
  void assign(const AnyState& other) override {
    state.assign(static_cast<const AnyForeignState&>(other).state);
  }

  ForeignState state;
};

struct AnyForeignLaw final : AnyLaw {
  AnyForeignLaw(const ForeignLaw& of, std::span<const double> given)
      : law(of), values(given.begin(), given.end()) {
    (void)ForeignState(law, SteppedFor::forces, values);  // refuses what makes no law
  }
  /// Unlike that of any law of the registry, which are few.
  [[nodiscard]] Place place() const noexcept { return reinterpret_cast<Place>(&law); }
  [[nodiscard]] std::string_view name() const noexcept override { return law.info().name; }
  [[nodiscard]] std::unique_ptr<AnyState> initial_state() const override {
    return std::make_unique<AnyForeignState>(place(), ForeignState(law, SteppedFor::forces, values));
  }
  [[nodiscard]] double step(AnyState& state, const Motion& motion, double period_s) const noexcept override {
    double force = no_number;
    if (state.law == place() && law.axes().empty()) {
      law.step(values.data(), static_cast<AnyForeignState&>(state).state, &motion.penetration,
               &motion.velocity, period_s, &force);
    }
    return force;
  }
  [[nodiscard]] AxisValues step(AnyState& state, const SpatialMotion& motion,
                                double period_s) const noexcept override {
    AxisValues force{no_number};
    if (state.law == place() && !law.axes().empty()) {
      law.step(values.data(), static_cast<AnyForeignState&>(state).state, motion.position.data(),
               motion.velocity.data(), period_s, force.data());
    }
    return force;
  }
  [[nodiscard]] double stored_energy(const AnyState& state) const noexcept override {
    if (state.law != place()) return no_number;
    return law.stored_energy(values.data(), static_cast<const AnyForeignState&>(state).state);
  }

  const ForeignLaw& law;
  const std::vector<double> values;
};

}  // namespace

std::shared_ptr<const AnyLaw> made_of(const ForeignLaw& law, std::span<const double> values) {
  return std::make_shared<const AnyForeignLaw>(law, values);
}

}  // namespace kerf::models
