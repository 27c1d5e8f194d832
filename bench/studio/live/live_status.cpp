#include "live/live_status.h"

namespace kerf::bench {

std::string_view name_of(ForceState state) noexcept {
  switch (state) {
    case ForceState::idle:
      return "idle";
    case ForceState::starting:
      return "starting";
    case ForceState::free:
      return "free";
    case ForceState::rendered:
      return "rendered";
    case ForceState::zero:
      return "zero";
    case ForceState::held:
      return "held";
    case ForceState::lost:
      return "lost";
    case ForceState::session:
      return "session";
  }
  return "";
}

ForceState force_state(const LiveStatus& status) noexcept {
  if (!status.ended.empty()) return ForceState::lost;
  if (status.is_released) return ForceState::zero;  // before a session, which it ends
  if (status.is_session) return ForceState::session;
  if (status.is_starting) return ForceState::starting;
  if (!status.is_running) return ForceState::idle;
  if (status.is_held) return ForceState::held;
  return status.law.empty() ? ForceState::free : ForceState::rendered;
}

std::string_view force_reason(const LiveStatus& status) noexcept {
  switch (force_state(status)) {
    case ForceState::lost:
      return status.ended;
    case ForceState::held:
      return "the position has jumped";
    default:
      return {};
  }
}

}  // namespace kerf::bench
