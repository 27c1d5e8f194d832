#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

namespace kerf::bench {

/// What a result keeps of the recording that it is of, so that whoever shows it later can tell whether the
/// recording is still the same.
struct KeptState {
  std::string axis;
  std::string content_sha256;  ///< content_sha256_of()
  std::string cycles_sha256;   ///< cycles_sha256_of(); empty without cycles along the axis
};
[[nodiscard]] KeptState kept_state(const schema::Recording& recording, std::size_t axis);
/// The keys `axis`, `content_sha256` and `cycles_sha256`, null of what there is none.
[[nodiscard]] nlohmann::ordered_json as_json(const KeptState& kept);

/// Of which state of a recording a result is.
enum class ResultState : std::uint8_t {
  unknown,        ///< it does not say
  current,        ///< as the recording is now
  before_cycles,  ///< from before cycles were saved
  other_cycles,   ///< of cycles that are others now, or count otherwise
  other_samples   ///< of rows that are others now
};
[[nodiscard]] constexpr bool is_outdated(ResultState state) noexcept { return state > ResultState::current; }

/// By the keys that as_json() writes, in the whole of a result or in what a fit says of one of its
/// recordings. `content` is the recording's content_sha256_of(); empty: samples are not asked about.
[[nodiscard]] ResultState state_of(const nlohmann::ordered_json& kept, const schema::Recording& about,
                                   const std::string& content = {});

}  // namespace kerf::bench
