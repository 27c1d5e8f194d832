#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>

#include "host/histogram.h"

namespace kerf::bench {

/// What there is of force in the hand, in one word: it gives the bar of every page its colour. A further
/// reason to hold the force is an enumerator here, its line in name_of() and force_state(), and its line in
/// page/src/ui/force/force_states.ts.
enum class ForceState : std::uint8_t {
  idle,      ///< no loop runs
  starting,  ///< its device is being opened
  free,      ///< the loop runs and renders nothing
  rendered,  ///< a law is rendered
  zero,      ///< somebody asked for zero force; held until it is let back
  held,      ///< the position jumped, and nobody has confirmed where the tool is
  lost,      ///< the loop ended by a fault, and nobody has started another or dismissed it
  session    ///< a session runs, of whose forces nothing is told
};
[[nodiscard]] std::string_view name_of(ForceState state) noexcept;

/// What a loop that a page watches is doing. After its end: what it did.
struct LiveStatus {
  struct Recording {
    std::string name;  ///< of the file
    std::uint64_t rows = 0;
    double seconds = 0.0;
  };
  bool is_running = false;   ///< from before its first tick until its recording is closed
  bool is_starting = false;  ///< its device is being opened
  std::uint64_t run = 0;     ///< how many loops there were, this one included
  std::string device_uri;
  std::vector<drivers::AxisInfo> axes;
  double rate_hz = 0.0;
  std::string law;           ///< what is rendered, or being blended to; empty: nothing
  bool is_released = false;  ///< zero force was asked for
  bool is_held = false;      ///< zero force after a jump of the position, until it is confirmed
  bool is_blending = false;
  std::optional<Recording> recording;
  std::string warning;            ///< what is to be known of the device of this loop; else empty
  std::string recording_failure;  ///< of the last recording; empty if all is well
  std::uint64_t ticks = 0;        ///< deadlines behind the loop
  std::uint64_t missed = 0;
  std::uint64_t rows_lost = 0;
  Percentiles wake;         ///< of the last ten seconds
  Percentiles cycle;        ///< reading, computing and writing, likewise
  Percentiles whole_wake;   ///< since the loop began
  Percentiles whole_cycle;  ///< likewise
  std::string ended;        ///< the fault that ended the loop, until dismissed; else empty
  bool is_session = false;  ///< a session runs: nothing else of the loop is told
};

[[nodiscard]] ForceState force_state(const LiveStatus& status) noexcept;
/// Why it is so, where a person has to know: the fault of a loop that was lost, or what holds the zero.
[[nodiscard]] std::string_view force_reason(const LiveStatus& status) noexcept;

}  // namespace kerf::bench
