#pragma once

#include <vector>

#include <kerf/models/foreign.h>

namespace kerf::law_trial {

/// A tick of the trial: a slow sine on every axis, half of it before contact, with a stall of a minute in it.
struct TrialTick {
  models::AxisValues position;
  models::AxisValues velocity;
  double period_s;
};
[[nodiscard]] std::vector<TrialTick> trial_ticks(const models::ForeignLaw& law);

/// What its steps came to.
struct TrialSteps {
  std::vector<double> force;  ///< on the first axis, tick by tick
  double step_s = 0.0;
  std::size_t allocations = 0;
};

/// Steps a law with its initial parameters: a state that is guarded and a copy of it in turns, which have to
/// give the same forces. Refuses what writes where it may not, gives no number, or remembers more than its
/// state holds.
[[nodiscard]] TrialSteps try_steps(const models::ForeignLaw& law);

/// The same of its steps with derivatives: the force has to be that of step(), the derivatives what a small
/// change of each parameter gives, in most of the ticks.
void try_derivatives(const models::ForeignLaw& law, const std::vector<double>& force);

}  // namespace kerf::law_trial
