#pragma once

#include <atomic>

#include <kerf/fitting/fit.h>

#include "choose/candidate_search.h"
#include "scene/scene.h"

namespace kerf::bench {

struct FidelityOptions {
  double rate_hz = 1000.0;
  fitting::Jnd jnd = fitting::force_jnd;
  fitting::Jnd torque_jnd = fitting::torque_jnd;
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
