#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "choose/candidate_search.h"
#include "device_model/model_in_use.h"
#include "laws/law_file.h"
#include "stability/device/in_hand.h"
#include "stability/stability_verdict.h"

namespace kerf::bench {

struct LoopCheckOptions {
  std::string device_uri;
  std::string
      device_model;      ///< its file; empty: the one that is kept of the device, if its driver knows less
  double seconds = 2.0;  ///< of a run by the wall clock
  double rate_hz = 1000.0;
  double margin = 0.5;        ///< share of the period that 99.9 % of the ticks may compute for, at most 0.5
  std::string grip = "firm";  ///< of the hand that presses and holds: light, firm, arm
};

/// The device on which a recording was simulated; else the first simulated one with an axis of its units.
/// @throws std::invalid_argument if there is none.
[[nodiscard]] std::string device_for(const schema::Recording& recording, std::size_t axis);

/// Laws in closed loop with a device and the hand that holds it.
///
/// The axis of a recording is seldom that of the device: a law that the hand would hardly meet is placed so
/// that it goes as deep as it did in the recording, or through the whole range of the hand if that is less.
class LoopChecks {
 public:
  /// @throws drivers::DeviceError: no such device.
  LoopChecks(LoopCheckOptions options, const std::atomic<bool>& stop);

  /// Places the laws of a recording. @throws std::invalid_argument: the device has no axis of its units.
  void place(const schema::Recording& recording, std::size_t axis, const models::Contact& contact);

  /// By the wall clock. Where the machine alone was late, up to three times.
  [[nodiscard]] Deadline deadline(const LawFile& law) const;

  /// Stable if a hand that presses and holds feels no limit cycle (stability_in_hand()) and, on a simulated
  /// device in virtual time, fewer than one tick in a thousand hits a limit of force or slew and what the
  /// rendering gives to the hand does not grow from one half of the run to the next. Not judged where the
  /// hand cannot be judged and nothing else speaks against the law.
  [[nodiscard]] StabilityVerdict stability(const LawFile& law) const;

  /// The same under the passivity controller.
  [[nodiscard]] ControlledInHand controlled(const LawFile& law) const;

  [[nodiscard]] const std::string& device_uri() const noexcept { return options_.device_uri; }
  /// Whose numbers the stability rests on, where the driver's were not enough.
  [[nodiscard]] const std::optional<ModelInUse>& model() const noexcept { return model_; }
  [[nodiscard]] bool simulated() const noexcept { return device_.simulated; }
  /// Where a law was moved to, in words; empty if it stands where it was recorded.
  [[nodiscard]] const std::string& placed_in_words() const noexcept { return placed_in_words_; }

 private:
  [[nodiscard]] LawFile placed(LawFile law) const;
  /// What of a run in virtual time speaks against a law; nothing if nothing does.
  [[nodiscard]] std::optional<std::string> misrendered(const LawFile& law, bool passivity_control) const;
  [[nodiscard]] StabilityVerdict judged(StabilityVerdict in_hand, const LawFile& law,
                                        bool passivity_control) const;

  LoopCheckOptions options_;
  const std::atomic<bool>& stop_;
  drivers::DeviceInfo device_;
  std::optional<ModelInUse> model_;
  double deepest_ = 0.0;  ///< penetration that was recorded
  std::optional<models::Contact> placed_at_;
  std::string placed_in_words_;
};

}  // namespace kerf::bench
