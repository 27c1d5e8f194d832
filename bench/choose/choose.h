#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <kerf/fitting/fit.h>
#include <kerf/schema/recording.h>

#include "choose/candidates.h"
#include "choose/effects.h"
#include "fits/fit_recording.h"

namespace kerf::bench {

/// How a law did in closed loop, by the wall clock.
struct Deadline {
  bool held = true;
  bool machine_late = false;  ///< it did not hold, and by the machine's doing alone: says nothing of the law
  double p999_us = 0.0;       ///< processor time of a tick's computation at 99.9 %
  std::uint64_t missed = 0;
  std::uint64_t ticks = 0;
  std::string why;  ///< in words, if it did not hold
};

/// Runs a law by the wall clock.
using DeadlineCheck = std::function<Deadline(const LawFile&)>;
/// Why a law is not stable with the given hand and device; nothing if it is.
using StabilityCheck = std::function<std::optional<std::string>(const LawFile&, const schema::Recording&)>;

struct ChooseOptions {
  std::size_t axis = 0;
  std::optional<models::Contact> contact;  ///< by default contact_of() the recording
  CandidateOptions candidates;
  fitting::FitOptions fit;   ///< JND and folds
  std::size_t threads = 1;   ///< among which the candidates are shared out; the choice does not depend on it
  bool richer_too = true;    ///< also fit what is richer than the law that serves, for the table
  DeadlineCheck deadline;    ///< empty: not checked
  StabilityCheck stability;  ///< empty: not checked
  std::function<void(const std::string& law)> begins;  ///< a check in closed loop, which takes its time
};

/// One law of the table.
struct Candidate {
  CandidateLaw law;
  std::optional<FittedLaw> fit;                              ///< none if it could not be fitted, or was not
  double error_n = std::numeric_limits<double>::infinity();  ///< root mean square, on held-out data
  double error_jnd = std::numeric_limits<double>::infinity();
  double tick_us = 0.0;  ///< median
  bool within_jnd = false;
  std::optional<Deadline> deadline;  ///< none: not checked
  std::optional<bool> stable;        ///< none: not checked
  std::string why;                   ///< it was passed over; empty for the law that was taken
};

/// The law that was taken, among those it was taken from.
struct LawChoice {
  double jnd_n = 0.0;  ///< at the root mean square force
  double force_rms_n = 0.0;
  std::string held_out;               ///< "5 folds of 10 cycles"
  std::vector<Candidate> candidates;  ///< in the order of the walk
  std::optional<std::size_t> taken;   ///< the law that serves; where none is within the JND, the best one
  bool serves = false;                ///< within the JND, in time and stable
  bool in_doubt = false;              ///< it would serve, but the machine was too late to tell
  /// Where none is within the JND: the simplest law that leaves out no more than the JND against the best.
  std::optional<std::size_t> as_good;
  std::string why;
  std::vector<EffectVerdict> effects;
  std::vector<std::string> warnings;
  models::Contact contact;
  fitting::FitOptions settings;
};

/// Fits every candidate to an axis of a recording and takes the simplest that serves.
///
/// The walk goes by the number of parameters; of equal ones by the cost of a tick in whole microseconds (a
/// thousandth of the period at 1 kHz: finer differences buy nothing and do not repeat), then by the number of
/// effects that a law knows, then by the error on held-out data. The first law is taken that converged, whose
/// error on held-out data is within the JND at the recording's root mean square force, that holds its
/// deadlines and is stable. So a richer law is taken only if the simpler ones leave out more than the JND.
/// The last two are checked only of laws that come up.
///
/// Where none is within the JND the law with the least error is named and checked, and it does not serve.
/// @throws std::invalid_argument for a recording without force, a missing axis, or one that no law can be
/// fitted to.
[[nodiscard]] LawChoice choose_law(const schema::Recording& recording, const ChooseOptions& options,
                                   const std::atomic<bool>& stop);

/// What a simpler law leaves out against a better one, sqrt(e^2 - b^2) [N]; 0 if it is not worse.
[[nodiscard]] double left_out(double error_n, double better_n) noexcept;

}  // namespace kerf::bench
