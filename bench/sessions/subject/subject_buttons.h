#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>

#include <kerf/drivers/device.h>

#include "subject/subject.h"
#include "subject/subject_rules.h"

namespace kerf::bench {

/// The channel "buttons" of a device, a bit for each; nothing if it has none.
[[nodiscard]] std::optional<std::size_t> buttons_channel(const drivers::DeviceInfo& device);

/// The buttons of the device that the hand holds. Button k, from 0, stands for slot k.
///
/// - Where the subject may switch: a short press feels the slot, one of 0.8 s answers it, as soon as it has
/// lasted so
///   long.
/// - Where each slot comes by itself: a press answers.
/// - Texts and breaks: a press of any button goes on; consent takes 0.8 s.
///
/// Nobody declines or stops by a button. What is pressed while a screen gives way to the next is for neither.
/// A contact counts when it has been the same for 30 ms.
class ButtonSubject final : public Subject {
 public:
  /// `now_s`: a steady clock [s]; another one for tests.
  explicit ButtonSubject(std::function<double()> now_s = steady_s);

  /// The channel's value, from the tick. Anything that is no bit mask is no button.
  void sample(double mask) noexcept;

  void show(const SubjectView& view) override;
  [[nodiscard]] std::optional<SubjectAction> next() override;

 private:
  static double steady_s();
  static constexpr std::size_t max_buttons = 8;
  struct Button {
    bool contact = false;     ///< as it was at the last poll
    double contact_s = -1e9;  ///< since when
    bool down = false;        ///< debounced
    double down_s = 0.0;      ///< since when
    bool spent = false;       ///< pressed on another screen, or has acted already
  };
  void press(std::size_t index, Button& button);
  void hold(std::size_t index, Button& button);
  void release(std::size_t index, Button& button);
  void act(Button& button, const SubjectAction& action);

  std::function<double()> now_s_;
  std::atomic<std::uint32_t> mask_{0};
  std::array<Button, max_buttons> buttons_{};
  std::deque<SubjectAction> actions_;
  SubjectView view_;
  TrialManner manner_;
};

}  // namespace kerf::bench
