#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>

#include "host/histogram.h"

namespace kerf::bench {

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
  bool is_blending = false;
  std::optional<Recording> recording;
  std::string recording_failure;  ///< of the last recording; empty if all is well
  std::uint64_t ticks = 0;        ///< deadlines behind the loop
  std::uint64_t missed = 0;
  std::uint64_t rows_lost = 0;
  Percentiles wake;         ///< of the last ten seconds
  Percentiles cycle;        ///< reading, computing and writing, likewise
  Percentiles whole_wake;   ///< since the loop began
  Percentiles whole_cycle;  ///< likewise
  std::string ended;        ///< why the loop ended; empty if it was stopped or never started
};

}  // namespace kerf::bench
