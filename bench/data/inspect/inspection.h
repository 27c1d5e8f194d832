#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <kerf/schema/recorded_rows.h>

#include "inspect/clipping.h"
#include "inspect/cycle_flags.h"
#include "inspect/drift.h"
#include "inspect/lag.h"
#include "inspect/sampling.h"
#include "inspect/signal_facts.h"
#include "inspect/velocity_match.h"
#include "recordings/contact_rows.h"

namespace kerf::bench {

struct InspectOptions {
  std::size_t axis = 0;  ///< along which contact is told
  double felt = 0.05;    ///< beyond which a force is felt there, in its unit
};

/// One column of a recording and what it is worth.
struct InspectedSignal {
  std::string name;  ///< as `kerf info` has it: "position", "force_measured.theta", a channel's
  std::string unit;
  bool is_force = false;
  bool tells_contact = false;  ///< the force along the axis that is asked for
  SignalFacts facts;
  EndsOfRange ends;
  std::optional<double> noise_idle;     ///< of the force by which contact is told; unknown in a dead zone
  std::optional<double> noise_contact;  ///< of the same
  std::optional<Drift> drift;           ///< of forces; unknown in a dead zone

  [[nodiscard]] bool is_blind_at_zero() const { return is_force && facts.is_blind_at_zero(); }
};

/// A velocity that was recorded; of those that were derived from the position there is nothing to ask.
struct InspectedVelocity {
  std::string name;  ///< "velocity", "velocity.theta"
  std::string position_unit;
  std::optional<VelocityMatch> match;  ///< unknown at rest
};

/// The cycles of the axis.
struct InspectedCycles {
  bool are_stored = false;  ///< in the recording; else found now, as `kerf segment` does
  std::string why_none;     ///< empty where there are any
  std::vector<FlaggedCycle> cycles;
};

/// What a recording is worth, before any law is fitted to it.
struct Inspection {
  InspectOptions options;
  std::string recording;  ///< its uuid
  std::string axis;
  std::string force_unit;
  std::string position_unit;
  Sampling sampling;
  std::vector<InspectedSignal> signals;  ///< positions, forces (measured where there is a sensor), channels
  std::vector<InspectedVelocity> velocities;
  std::optional<ContactRows> contact;  ///< unknown without a force
  std::optional<Lag> lag;              ///< of the force after the position
  InspectedCycles cycles;
};

/// Goes through all rows several times, some at a time. @throws std::invalid_argument if there is no such
/// axis.
[[nodiscard]] Inspection inspect(const schema::RecordedRows& rows, const InspectOptions& options);

/// What ought to be known before the recording is used, a sentence each, the worst first.
[[nodiscard]] std::vector<std::string> warnings_of(const Inspection& inspection);

}  // namespace kerf::bench
