#pragma once

#include <cstddef>
#include <string>

#include "laws/sampled_motion.h"
#include "regress/suite.h"

namespace kerf::bench {

/// The motion of a case on the axes of its law. @throws std::invalid_argument as sampled(), naming the case;
/// no tick at all.
[[nodiscard]] SampledMotion path_of(const RegressionCase& one);

/// SHA-256 of a motion's numbers on the axes of a law, and of what of a law has a bearing on its forces:
/// everything of its file but comments, standard errors and where it comes from.
[[nodiscard]] std::string checksum(const SampledMotion& motion, std::size_t axes);
[[nodiscard]] std::string checksum(const LawFile& law);
/// Of what renders a case: its law, or another renderer.
[[nodiscard]] std::string checksum(const RegressionCase& one);

}  // namespace kerf::bench
