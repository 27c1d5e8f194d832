#pragma once

#include <atomic>

#include <kerf/fitting/fit.h>

#include "choose/candidate_search.h"
#include "scene/scene.h"

namespace kerf::bench {

/// What of a torque a person can feel: the larger of a Weber fraction and an absolute threshold. Source of
/// the fraction: [JanduraSrinivasan1994] (12.7 % at 60 mN·m between two fingers); the threshold is
/// assumed, 0.05 N at a radius of 10 mm.
struct TorqueJnd {
  double weber_fraction = 0.127;
  double threshold_n_m = 5e-4;
  [[nodiscard]] double at(double torque_n_m) const noexcept;
};

struct FidelityOptions {
  double rate_hz = 1000.0;
  fitting::ForceJnd jnd;
  TorqueJnd torque_jnd;
  CandidateSearchOptions search;
};

/// Chooses among the fidelities of a scene's blade along the path of its script: `paper`, whose strips move
/// all with the hand and so know no rotation, `strips`, and `exact`, which is the reference. Their errors are
/// root mean squares of the difference of force and of torque over the ticks in which the reference pushes,
/// in JNDs of each at its root mean square; the larger counts. They have the same parameters, so that the
/// search goes by the cost of a tick.
/// @throws std::invalid_argument if the scene's law is no blade, has no path, or the blade never pushes.
[[nodiscard]] LawChoice choose_fidelity(const Scene& scene, const FidelityOptions& options,
                                        const std::atomic<bool>& stop);

}  // namespace kerf::bench
