#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

namespace kerf::bench {

/// Whether the closed loop with a law is stable. What nobody judged is not stable, and not unstable either:
/// it may be taken, and whoever takes it is told.
enum class Stable : std::uint8_t { yes, no, not_judged };

struct StabilityVerdict {
  Stable stable = Stable::not_judged;
  std::string why;  ///< it is not stable, or nobody judged it; empty if it is stable
};

[[nodiscard]] inline StabilityVerdict not_stable(std::string why) { return {Stable::no, std::move(why)}; }
[[nodiscard]] inline StabilityVerdict not_judged(std::string why) {
  return {Stable::not_judged, std::move(why)};
}

/// "yes", "no", "not judged".
[[nodiscard]] std::string_view name_of(Stable stable) noexcept;
/// Why nobody judged it; empty if somebody did.
[[nodiscard]] std::string why_not_judged(const StabilityVerdict& verdict);

/// As files have it: true, false, null where nobody judged it.
[[nodiscard]] nlohmann::ordered_json to_json(Stable stable);
[[nodiscard]] Stable stable_from(const nlohmann::ordered_json& value);

}  // namespace kerf::bench
