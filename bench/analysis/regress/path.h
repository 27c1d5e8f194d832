#pragma once

#include <string>
#include <vector>

#include <kerf/models/motion.h>

#include "regress/suite.h"

namespace kerf::bench {

/// The path of a tool as a law sees it, tick by tick, on the law's axes in their own frame.
struct RegressionPath {
  std::vector<models::LawAxis> axes;
  std::vector<double> time_s;
  std::vector<double> period_s;
  std::vector<models::AxisValues> position;
  std::vector<models::AxisValues> velocity;

  [[nodiscard]] std::size_t ticks() const noexcept { return time_s.size(); }
};

/// The trajectory of a case. @throws std::invalid_argument: a recording without the law's axes, in other
/// units or with a sample that is not finite; a scene without a script; no tick at all.
[[nodiscard]] RegressionPath path_of(const RegressionCase& one);
/// The same, with messages that do not speak of a case.
[[nodiscard]] RegressionPath trajectory_of(const RegressionCase& one);

/// SHA-256 of a path's numbers, and of what of a law has a bearing on its forces: everything of its file but
/// comments, standard errors and where it comes from.
[[nodiscard]] std::string checksum(const RegressionPath& path);
[[nodiscard]] std::string checksum(const LawFile& law);

}  // namespace kerf::bench
