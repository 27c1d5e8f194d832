#pragma once

#include <optional>
#include <string>
#include <vector>

#include <kerf/compare/compare.h>
#include <kerf/compare/series.h>

namespace kerf::compare {

/// How two signals hang together over frequency.
struct BandCoherence {
  double from_hz = 0.0;
  double to_hz = 0.0;
  double coherence = 0.0;  ///< magnitude squared, 0 to 1, weighted by the energy of the expected force
};

/// How one channel of a run follows that of another: got = gain expected + offset, later by a lag. Of the
/// rows in which both are finite; where some are not, latency and coherence are unknown.
struct ChannelAgreement {
  ChannelName channel;
  double gain = 1.0;
  double offset = 0.0;
  double drift = 0.0;  ///< of a straight line through the difference, over the run
  double rms_difference = 0.0;
  double correlation = 0.0;         ///< -1 to 1; 0 where either does not change
  std::optional<double> latency_s;  ///< none where no force changes, one is not finite, or it is longer
  double latency_std_error_s = 0.0;
  std::vector<BandCoherence>
      coherence;  ///< octaves from 5 Hz on; where there are four windows of a second or more
};

/// One a channel; the runs are already beside each other. @throws std::invalid_argument for other channels or
/// another number of rows.
[[nodiscard]] std::vector<ChannelAgreement> agreement(const Series& expected, const Series& got,
                                                      double most_lag_s = 0.5);

}  // namespace kerf::compare
