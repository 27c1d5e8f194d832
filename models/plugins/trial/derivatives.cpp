#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include "trial/guarded_state.h"
#include "trial/report.h"
#include "trial/steps.h"

namespace kerf::law_trial {
namespace {

constexpr double same_force = 1e-9;       // relative
constexpr double same_derivative = 1e-3;  // of the largest; the median over the ticks
constexpr double relative_change = 1e-5;

/// The forces that a law gives with one parameter changed; empty where that makes no law.
std::vector<double> forces_with(const models::ForeignLaw& law, std::size_t parameter, double value,
                                const std::vector<TrialTick>& ticks, std::size_t count) {
  std::vector<double> values = law.initial();
  values[parameter] = value;
  std::vector<double> all(count);
  try {
    models::ForeignState state(law, models::SteppedFor::forces, values);
    for (std::size_t i = 0; i < count; ++i)
      law.step(values.data(), state, ticks[i].position.data(), ticks[i].velocity.data(), ticks[i].period_s,
               &all[i]);
  } catch (const std::invalid_argument&) {
    return {};
  }
  return all;
}

void compare(const models::ForeignLaw& law, std::size_t parameter, const std::vector<double>& told,
             const std::vector<TrialTick>& ticks) {
  const models::ParameterInfo& info = law.parameters()[parameter];
  const double middle = law.initial()[parameter];
  const double change =
      relative_change * (middle != 0.0 ? std::abs(middle) : std::min(1.0, info.upper - info.lower));
  const double below = std::max(info.lower, middle - change);
  const double above = std::min(info.upper, middle + change);
  const std::vector<double> less = forces_with(law, parameter, below, ticks, told.size());
  const std::vector<double> more = forces_with(law, parameter, above, ticks, told.size());
  if (less.empty() || more.empty()) return;
  std::vector<double> deviation;
  double largest = 0.0;
  for (std::size_t i = 0; i < told.size(); ++i) {
    const double found = (more[i] - less[i]) / (above - below);
    largest = std::max({largest, std::abs(found), std::abs(told[i])});
    deviation.push_back(std::abs(found - told[i]));
  }
  const auto half = deviation.begin() + static_cast<std::ptrdiff_t>(deviation.size() / 2);
  std::nth_element(deviation.begin(), half, deviation.end());
  if (*half <= same_derivative * largest) return;
  refuse("its derivative by '" + info.name + "' is off by " + std::to_string(*half) + " of " +
         std::to_string(largest) +
         ", in half of the steps of its trial, from what a small change of it gives");
}

}  // namespace

void try_derivatives(const models::ForeignLaw& law, const std::vector<double>& force) {
  const kerf_law_v1& description = law.description();
  const std::size_t size = description.derivatives_state_size;
  const std::string of_state = "its state for derivatives of " + std::to_string(size) + " bytes";
  const std::size_t count = law.parameters().size();
  const GuardedBlock state(size, description.derivatives_state_alignment, of_state);
  const GuardedBlock derivatives(count * sizeof(double), alignof(double),
                                 "the " + std::to_string(count) + " derivatives that it is asked for");
  const double* const values = law.initial().data();
  report("at its state for derivatives was made (init_derivatives)");
  if (description.init_derivatives != nullptr && description.init_derivatives(values, state.bytes()) != 0)
    refuse("its init_derivatives() refuses its own initial parameters");
  report("at it was stepped with derivatives");
  const std::vector<TrialTick> ticks = trial_ticks(law);
  std::vector<std::vector<double>> told(count);
  for (std::size_t i = 0; i < force.size(); ++i) {
    double same = 0.0;
    description.step_derivatives(values, state.bytes(), ticks[i].position.data(), ticks[i].velocity.data(),
                                 ticks[i].period_s, &same, static_cast<double*>(derivatives.bytes()));
    if (state.is_damaged()) refuse("it writes beside " + of_state);
    if (derivatives.is_damaged()) refuse("it writes beside its derivatives");
    if (!(std::abs(same - force[i]) <= same_force * std::max(1.0, std::abs(force[i])))) {
      refuse("step_derivatives() gives a force of " + std::to_string(same) + " where step() gives " +
             std::to_string(force[i]) + ", in step " + std::to_string(i) + " of its trial");
    }
    for (std::size_t k = 0; k < count; ++k) {
      const double one = static_cast<const double*>(derivatives.bytes())[k];
      if (!std::isfinite(one))
        refuse("its derivative by '" + law.parameters()[k].name + "' is not finite in step " +
               std::to_string(i) + " of its trial");
      told[k].push_back(one);
    }
  }
  for (std::size_t k = 0; k < count; ++k) compare(law, k, told[k], ticks);
}

}  // namespace kerf::law_trial
