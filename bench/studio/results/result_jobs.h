#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "choose/candidates.h"
#include "fits/asked_fit.h"
#include "jobs/jobs.h"
#include "stability/study.h"
#include "workspace/workspace.h"

namespace kerf::bench {

// What the program's own verbs do with a recording or a device, as jobs of a studio. Each writes what the
// verb writes into a new folder of the workspace, which appears when all of it is there. Recordings are
// fitted and charted by as many threads as there are processors beside the loop's. The workspace must outlive
// the jobs.

/// `kerf fit`: NAME.fit.
struct FitRequest {
  WorkspaceEntry recording;
  AskedFit asked;  ///< models empty: models_of()
};
[[nodiscard]] JobOrder fit_job(Workspace& workspace, FitRequest request);

/// `kerf chart`: NAME.chart.
struct ChartRequest {
  WorkspaceEntry recording;
  std::string axis;                 ///< empty: that of the cycles, or the first
  std::vector<std::string> models;  ///< empty: as fit_plans()
};
[[nodiscard]] JobOrder chart_job(Workspace& workspace, ChartRequest request);

/// `kerf choose`, but by stability in virtual time and without runs by the wall clock: a loop that a hand may
/// be on has the machine. NAME.choice.
struct ChoiceRequest {
  WorkspaceEntry recording;
  std::string axis;  ///< empty: that of the cycles, or the first
  double rate_hz = 1000.0;
  std::size_t max_segments = CandidateOptions{}.max_segments;  ///< of the piecewise law, 1 to 16
};
[[nodiscard]] JobOrder choice_job(Workspace& workspace, ChoiceRequest request);

/// `kerf stability` of walls, or of a law: NAME.stability.
struct StabilityRequest {
  std::optional<WorkspaceEntry> law;
  StudyOptions study;
};
[[nodiscard]] JobOrder stability_job(Workspace& workspace, StabilityRequest request);

}  // namespace kerf::bench
