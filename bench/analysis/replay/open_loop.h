#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "laws/law_file.h"
#include "replay/force_events.h"
#include "replay/source.h"

namespace kerf::bench {

/// A law that a recorded motion is fed to.
struct NamedLaw {
  std::string name;
  LawFile file;
};

/// Reads law files, each named as its file, with a number where two are the same.
/// @throws as read_law_file() does.
[[nodiscard]] std::vector<NamedLaw> read_named_laws(const std::vector<std::string>& files);

struct OpenLoopOptions {
  double contact = 0.0;     ///< of ForceEventOptions
  double window_s = 0.005;  ///< of ForceEventOptions
  double match_s = 0.05;    ///< events farther apart are not the same
  bool realtime = false;    ///< each tick at its deadline by the wall clock; the forces are the same
};

/// Rows whose recorded command went through the loop's safety untouched, and how many of them the law gives
/// again to the last bit.
struct Exactness {
  std::size_t untouched = 0;
  std::size_t identical = 0;
};

/// Rendered against recorded force along one axis, both positive where the tissue resists for a law along an
/// axis, and in the sense of the axis for a law with axes of its own.
struct AxisComparison {
  std::size_t axis = 0;   ///< of the recording
  bool measured = false;  ///< against the measured force; else the commanded one
  std::vector<double> recorded;
  std::vector<double> rendered;
  std::size_t samples = 0;  ///< rows with both
  double force_rms = 0.0;   ///< of the recorded force, and its JND
  double jnd = 0.0;
  double rms = 0.0;  ///< of the difference
  double worst = 0.0;
  double worst_at_s = 0.0;
  double rms_jnd = 0.0;    ///< rms over the JND at the root mean square force
  double worst_jnd = 0.0;  ///< the largest difference over the JND at the recorded force of its moment
  std::vector<ForceEvent> recorded_events;
  std::vector<ForceEvent> rendered_events;
  std::array<EventMatch, 3> events;
  std::optional<Exactness> exact;  ///< where the force was commanded
};

/// What one law gives on the ticks of a recording.
struct LawTrace {
  std::string name;
  LawFile file;
  std::vector<drivers::Axes> force;  ///< as it would be commanded, before any safety
  std::vector<std::uint32_t> flags;
  std::size_t faults = 0;
  std::vector<AxisComparison> axes;
};

/// Lateness of a replay by the wall clock.
struct Punctuality {
  std::size_t late = 0;  ///< ticks that began a period or more after their deadline
  double worst_ms = 0.0;
};

struct OpenLoopResult {
  std::vector<LawTrace> laws;
  std::optional<Punctuality> punctuality;
  std::size_t rows = 0;  ///< replayed; fewer than there are where a signal ended it
};

/// Feeds the rows of a recording to laws, each from a fresh state, by the code of the loop itself: the same
/// rendering of the same position and velocity over the same period. No clock is asked unless `realtime`.
///
/// A law gives again what it gave in the loop, bit for bit, if it sees every tick that it saw then: the
/// recording from its first row, at its own speed and with no row lost, law and contact as they were. The
/// noise of the device does not matter, since the row holds what the law saw. Where the loop passed a row by
/// (a reading that it did not believe) the law is passed by too. The command is compared where no flag says
/// that the loop changed it: not under a ramp, a limit, a blend or passivity control.
/// @throws std::invalid_argument for a recording without the axes of a law, or without any force.
[[nodiscard]] OpenLoopResult run_open_loop(const Source& source, const std::vector<NamedLaw>& laws,
                                           const OpenLoopOptions& options, const std::atomic<bool>& stop);

/// The recording with the force of a law as the commanded one. What it is compared with stays as the channel
/// AXIS_force_recorded; the device's own times go.
[[nodiscard]] schema::Recording recording_of(const Source& source, const LawTrace& trace);

}  // namespace kerf::bench
