#pragma once

#include "laws/sampled_motion.h"
#include "regress/forces.h"
#include "regress/renderers/outside_renderer.h"

namespace kerf::bench {

inline constexpr int lockstep_version = 1;

/// The forces of a renderer that is started once and asked tick by tick, over its standard streams or, where
/// a file for it is named, over a socket of UNIX. It is killed with its group in any case. docs/regress.md
/// has the lines.
/// @throws std::invalid_argument in one line, with the last that it said: another version, sign, frame, rate,
/// seed or other columns in its hello, an answer that is late, of another tick, before it was asked, of too
/// few values or of no number, an end before the last tick; std::system_error.
[[nodiscard]] RenderedForces render_in_lockstep(const OutsideRenderer& renderer, const SampledMotion& motion,
                                                const std::vector<std::string>& command,
                                                const std::filesystem::path& socket);

}  // namespace kerf::bench
