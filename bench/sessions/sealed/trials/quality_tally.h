#pragma once

#include <optional>
#include <vector>

#include "sealed/trials/session_quality.h"

namespace kerf::bench {

/// Adds up how the trials of a session go, one after the other as they are answered. For one thread.
class QualityTally {
 public:
  /// With the trials that the session has so far, traces and all. @throws as SessionStore::trial().
  explicit QualityTally(const SessionStore& session);

  /// One more, with its trace. `is_left_out`: void, and it does not come again.
  void add(const RecordedTrial& trial, bool is_left_out);
  /// Of catch trials it tells only once the session is finished.
  [[nodiscard]] SessionQuality quality(bool is_finished) const;

 private:
  void add_felt(const RecordedTrial& trial);

  std::size_t slots_;
  Protocol protocol_;
  SessionQuality sums_;
  CatchTally catches_;
  double playing_s_ = 0.0;
  double contact_s_ = 0.0;
  std::vector<double> times_s_;
};

}  // namespace kerf::bench
