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
#include "stability/device/in_hand.h"
#include "stability/stability_verdict.h"

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
/// Judges a law with the given hand and device.
using StabilityCheck = std::function<StabilityVerdict(const LawFile&, const schema::Recording&)>;
/// Judges a law that is not stable by itself under the passivity controller.
using ControllerCheck = std::function<ControlledInHand(const LawFile&)>;

struct CandidateSearchOptions {
  DeadlineCheck deadline;                              ///< empty: not checked
  StabilityCheck stability;                            ///< empty: not checked
  ControllerCheck controlled;                          ///< empty: no controller is recommended
  std::function<void(const std::string& law)> begins;  ///< a check in closed loop, which takes its time
};

/// One law of the table.
struct Candidate {
  CandidateLaw law;
  std::optional<LawFile> file;   ///< none if it could not be fitted, or was not
  std::optional<FittedLaw> fit;  ///< none of a law that was known and not fitted
  bool converged = false;
  double error_n =
      std::numeric_limits<double>::infinity();  ///< root mean square, on held-out data, as rendered
  double fitted_n = std::numeric_limits<double>::quiet_NaN();  ///< the same of the law as it was fitted
  double error_jnd = std::numeric_limits<double>::infinity();
  double error_torque_n_m = std::numeric_limits<double>::quiet_NaN();  ///< of a law that gives torques
  double tick_us = 0.0;                                                ///< median
  bool within_jnd = false;                                             ///< and converged
  std::optional<Deadline> deadline;                                    ///< none: not checked
  StabilityVerdict stability = not_judged("it was not tried in closed loop");
  std::string why;  ///< it was passed over; empty for the law that was taken
};

/// A law within the JND that is simpler than the one that was taken, and stable under the passivity
/// controller alone.
struct ControllerAdvice {
  std::size_t candidate = 0;
  double added_n = 0.0;  ///< rms of what the controller adds while a hand presses
};

/// The law that was taken, among those it was taken from.
struct LawChoice {
  double jnd_n = 0.0;  ///< at the root mean square force
  double force_rms_n = 0.0;
  std::string force_unit = "N";
  std::string held_out;               ///< "5 folds of 10 cycles"
  std::vector<Candidate> candidates;  ///< in the order of the search
  std::optional<std::size_t> taken;   ///< the law that serves; where none is within the JND, the best one
  bool serves = false;                ///< within the JND, in time, and stable where that was judged
  bool in_doubt = false;              ///< it would serve, but the machine was too late to tell
  /// Where none is within the JND: the simplest law that leaves out no more than the JND against the best.
  std::optional<std::size_t> as_good;
  std::optional<ControllerAdvice> advice;
  std::string why;
  std::optional<fitting::Floor> floor;  ///< what is possible at all on the recording
  std::string blame;  ///< what is to blame where the law that is named is not within the JND
  std::vector<EffectVerdict> effects;
  std::vector<std::string> warnings;
  RowChoice rows;  ///< as asked for
  std::vector<LeftOutCycle> cycles_left_out;
  models::Contact contact;
  fitting::FitOptions settings;
};

/// What tables say of the law that was taken: "taken", or what speaks against it.
[[nodiscard]] std::string_view taken_in_words(const LawChoice& choice) noexcept;

/// Goes over candidates whose errors are known, from the simplest on, and takes the first that serves. Not
/// the question of fitting::choose_simplest(), which asks what describes a recording: here a law has to hold
/// in the loop too.
///
/// The order is that of the number of parameters; of equal ones that of the cost of a tick in whole
/// microseconds (a thousandth of the period at 1 kHz: finer differences buy nothing and do not repeat), then
/// that of the number of effects that a law knows, then that of the error. A law serves that converged, whose
/// error is within the JND, that holds its deadlines and is stable or was not judged, which is said; the last
/// two are checked only of laws that come up.
class CandidateSearch {
 public:
  /// `recording` is what the stability is judged with.
  CandidateSearch(LawChoice& choice, const CandidateSearchOptions& options,
                  const schema::Recording& recording, const std::atomic<bool>& stop);

  /// The candidates from one place on that have as many parameters as that one.
  [[nodiscard]] std::size_t end_of_group(std::size_t begin) const;
  /// Sorts such a group and goes over it.
  void search_group(std::size_t begin, std::size_t end);
  /// Says what came of it. Where none is within the JND the one with the least error is named, and checked.
  void finish();

  /// @throws std::system_error if the work was stopped.
  void end_if_stopped() const;

 private:
  void consider(std::size_t place);
  [[nodiscard]] bool passes_checks(Candidate& candidate);
  void check_all_the_same(Candidate& candidate);
  void take_the_best();
  void look_for_a_controller();
  void explain();
  void explain_the_best(const std::string& limit);
  void explain_stability(const Candidate& candidate);
  void explain_the_controller();

  LawChoice& choice_;
  const CandidateSearchOptions& options_;
  const schema::Recording& recording_;
  const std::atomic<bool>& stop_;
};

}  // namespace kerf::bench
