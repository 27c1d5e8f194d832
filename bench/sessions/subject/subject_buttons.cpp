#include "subject/subject_buttons.h"

#include <chrono>
#include <utility>

namespace kerf::bench {
namespace {

using Kind = SubjectAction::Kind;
constexpr double debounce_s = 0.030;
constexpr double long_press_s = 0.8;

}  // namespace

std::optional<std::size_t> buttons_channel(const drivers::DeviceInfo& device) {
  for (std::size_t i = 0; i < device.channels.size(); ++i) {
    if (device.channels[i].name == "buttons") return i;
  }
  return std::nullopt;
}

ButtonSubject::ButtonSubject(std::function<double()> now_s) : now_s_(std::move(now_s)) {}

double ButtonSubject::steady_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void ButtonSubject::sample(double mask) noexcept {
  const bool valid = mask >= 0.0 && mask <= 4294967295.0;  // not for NaN either
  mask_.store(valid ? static_cast<std::uint32_t>(mask) : 0, std::memory_order_relaxed);
}

void ButtonSubject::show(const SubjectView& view) {
  if (is_new_screen(view_, view)) {
    actions_.clear();
    for (Button& button : buttons_) button.spent = true;
  }
  manner_.see(view_, view);
  view_ = view;
}

std::optional<SubjectAction> ButtonSubject::next() {
  const std::uint32_t mask = mask_.load(std::memory_order_relaxed);
  const double now_s = now_s_();
  for (std::size_t index = 0; index < max_buttons; ++index) {
    Button& button = buttons_[index];
    const bool contact = ((mask >> index) & 1U) != 0;
    if (contact != button.contact) {
      button.contact = contact;
      button.contact_s = now_s;
      if (contact && !button.down) button.spent = false;
    }
    if (contact != button.down && now_s - button.contact_s >= debounce_s) {
      button.down = contact;
      button.down_s = button.contact_s;
      contact ? press(index, button) : release(index, button);
    }
    if (button.down && now_s - button.down_s >= long_press_s) hold(index, button);
  }
  if (actions_.empty()) return std::nullopt;
  const SubjectAction action = actions_.front();
  actions_.pop_front();
  return action;
}

void ButtonSubject::act(Button& button, const SubjectAction& action) {
  if (button.spent || !permits(view_, action)) return;
  button.spent = true;
  actions_.push_back(action);
}

void ButtonSubject::press(std::size_t index, Button& button) {
  if (view_.stage == SessionStage::consent) return;
  if (view_.stage != SessionStage::trial) {
    act(button, {.kind = Kind::go_on});
  } else if (!manner_.is_free()) {
    act(button, {.kind = Kind::answer, .slot = index});
  }
}

void ButtonSubject::hold(std::size_t index, Button& button) {
  if (view_.stage == SessionStage::consent) act(button, {.kind = Kind::go_on});
  if (view_.stage == SessionStage::trial && manner_.is_free())
    act(button, {.kind = Kind::answer, .slot = index});
  button.spent = true;
}

void ButtonSubject::release(std::size_t index, Button& button) {
  if (view_.stage == SessionStage::trial && manner_.is_free())
    act(button, {.kind = Kind::play, .slot = index});
}

}  // namespace kerf::bench
