#pragma once

#include <optional>
#include <string>
#include <vector>

#include <kerf/schema/regression.h>

#include "regress/compare.h"
#include "regress/path.h"
#include "regress/suite.h"

namespace kerf::bench {

/// What came of one case.
struct RegressionOutcome {
  RegressionCase about;
  SampledMotion path;
  RenderedForces got;
  schema::StoredForces stored;
  ForceComparison comparison;
  compare::Diagnosis diagnosis;       ///< what changed, of one that did not pass
  std::string error;                  ///< why nothing could be compared: of the case, not of its forces
  std::string said{};                 ///< last lines of a renderer's standard error, where there is an error
  std::vector<std::string> messages;  ///< why it did not pass, and what the difference looks like
  std::string why;                    ///< law, trajectory or code: what is not as it was when it was stored
  std::optional<double> tick_cost;    ///< measured now
  std::string made_with{};            ///< now: made_with()
  std::string note;                   ///< what could not be compared
  bool left_out = false;              ///< not run, since nothing has changed: `why` says so
  double seconds = 0.0;               ///< that it took

  /// Nothing is wrong with it as far as is known.
  [[nodiscard]] bool passed() const noexcept { return error.empty() && messages.empty(); }
};

struct SuiteOutcome {
  std::vector<RegressionOutcome> cases;
  std::vector<std::string> dropped;  ///< stored, and no longer in the suite
  std::vector<std::string> notes;    ///< of what stands beside the forces
  double seconds = 0.0;

  /// Cases that did not pass, those of errors() and those dropped among them.
  [[nodiscard]] std::size_t failed() const noexcept;
  /// Cases that could not be compared at all.
  [[nodiscard]] std::size_t errors() const noexcept;
  /// Cases that were not run, since nothing of them has changed.
  [[nodiscard]] std::size_t left_out() const noexcept;
};

struct SuiteOptions {
  std::vector<std::string> only;  ///< names of cases; empty: all
  bool tick_costs = true;
  std::size_t jobs = 1;  ///< cases at a time; those whose cost is measured run alone
  /// Of a run: leave out the cases of which nothing has changed since their forces were stored
  /// (changed_since()).
  bool changed = false;
};

/// Renders every case and compares it with its stored forces. A case for which that cannot be done (no stored
/// forces, a trajectory with a gap, a law that cannot be read) has an error, and the others go on.
/// @throws std::invalid_argument for a name that is no case.
[[nodiscard]] SuiteOutcome run_suite(const Suite& suite, const SuiteOptions& options);

/// What storing a case anew would do.
enum class ChangeKind { added, changed, unchanged, removed, impossible };
struct StoredChange {
  std::string name;
  ChangeKind kind = ChangeKind::unchanged;
  std::string what;                          ///< by how much
  std::string why;                           ///< what is behind it
  bool asked = true;                         ///< one of the cases that were named
  bool completes = false;                    ///< its trajectory is added to forces that stay
  schema::StoredForces now;                  ///< as it would stand in the file, without the reason
  std::optional<RegressionOutcome> outcome;  ///< of a case that changes: what would be accepted
};

/// What would change in the stored forces, case by case. What passes, with the same law and trajectory,
/// stays as it is, so that the last digits of a compiler do not come and go; so does what cannot be rendered.
/// @throws as run_suite(); schema::FormatError for a file that holds something else.
[[nodiscard]] std::vector<StoredChange> plan_update(const Suite& suite, const SuiteOptions& options);
/// The cases that change, beside what is stored, as a run would show them.
[[nodiscard]] SuiteOutcome what_changes(const std::vector<StoredChange>& changes);
[[nodiscard]] bool changes_anything(const std::vector<StoredChange>& changes) noexcept;
/// What would be written though no force changes, in words: a summary that is missing, a trajectory that is
/// kept besides; empty: nothing.
[[nodiscard]] std::string completes_anything(const Suite& suite, const std::vector<StoredChange>& changes);

/// Writes what was planned. @throws std::invalid_argument for an empty reason; std::system_error.
void write_update(const Suite& suite, const std::vector<StoredChange>& changes, const std::string& reason);

}  // namespace kerf::bench
