#pragma once

#include <cstddef>
#include <optional>

namespace kerf::law_trial {

/// How often memory was asked for by this process so far; nothing under sanitizers, whose malloc() is
/// another.
[[nodiscard]] std::optional<std::size_t> allocations() noexcept;

}  // namespace kerf::law_trial
