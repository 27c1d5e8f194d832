#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emulated_device.h"

namespace kerf::emulators {

/// One thing that goes wrong, so many seconds after the device was attached, for so many answers.
struct Fault {
  enum class Kind : std::uint8_t { drop, split, corrupt, stall, unplug };
  Kind kind = Kind::drop;
  double at_s = 0.0;
  std::uint64_t count = 1;
};

/// Reads "drop@2.0,split@3:10,unplug@8": KIND@SECONDS[:COUNT].
/// @throws std::invalid_argument with what was expected.
[[nodiscard]] std::vector<Fault> parse_faults(std::string_view text);

/// The faults of one run, as they come due.
class FaultPlan {
 public:
  FaultPlan() = default;
  explicit FaultPlan(std::vector<Fault> faults) : faults_(std::move(faults)) {}

  /// What disturbs the next answer at this time, if anything.
  [[nodiscard]] Disturbance due(double time_s) const noexcept;
  /// One answer was disturbed so.
  void done(Disturbance disturbance, double time_s) noexcept;
  /// Whether the next transfer on a data endpoint stalls; counts it.
  [[nodiscard]] bool stalls(double time_s) noexcept;
  /// When the device is unplugged, if ever.
  [[nodiscard]] std::optional<double> unplugged_at_s() const noexcept;

 private:
  [[nodiscard]] const Fault* find(Fault::Kind kind, double time_s) const noexcept;
  void count(Fault::Kind kind, double time_s) noexcept;

  std::vector<Fault> faults_;
};

}  // namespace kerf::emulators
