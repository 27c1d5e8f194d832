#pragma once

#include <cstddef>
#include <cstdint>

namespace kerf::models {

class ForeignLaw;

/// What a thread does in plug-ins, as others see it.
struct ForeignCall {
  const ForeignLaw* law = nullptr;  ///< whose code runs; nothing outside of any
  std::uint64_t begun = 0;          ///< calls that have begun
  bool operator==(const ForeignCall&) const = default;
};
/// As many threads are told apart; of more, some share their calls.
inline constexpr std::size_t watched_threads = 256;
[[nodiscard]] ForeignCall foreign_call(std::size_t thread) noexcept;

}  // namespace kerf::models
