#pragma once

#include <string>
#include <vector>

namespace kerf::bench {

/// One line of a plot over time: a column of a recording or of the running loop.
struct Trace {
  std::string name;   ///< "position theta", "force_commanded x", "wake_latency", a channel's own
  std::string unit;   ///< "rad", "N", "s"; "1" for a number
  std::string group;  ///< "position", "velocity", "force", "timing", "channel": what shares a plot
};

/// A stretch of several traces in columns as wide as a pixel: the smallest and the largest value of each
/// column's rows, so that no spike is lost. Values that are not finite are passed over; a column without any
/// has NaN in both. Rounded to single precision, away from the other end.
struct TraceView {
  struct Extremes {
    std::vector<float> smallest;
    std::vector<float> largest;
  };
  std::vector<double> time_s;    ///< of the first row of each column
  std::vector<Extremes> traces;  ///< in the order asked for, each as long as time_s
  double rows_per_column = 1.0;  ///< 1: every row is there
  double rows_looked_at =
      0.0;  ///< of each column, where its extremes are those of some rows alone; 0: of all
  double prepared =
      1.0;  ///< how much of the recording has been gone through; below 1 it is worth asking again
};

/// For the page: u32 columns, u32 traces, f64 rows a column, f64 of them looked at, f64 prepared, f64 times,
/// then f32 smallest and f32 largest of each trace; little-endian.
[[nodiscard]] std::string bytes_of(const TraceView& view);

}  // namespace kerf::bench
