#include "regress/inputs.h"

#include <kerf/version.h>

#include "regress/path.h"

namespace kerf::bench {
namespace {

/// Of a law that is Kerf's own the program says all, unless it was built from sources that no commit has.
std::string unseen_of_law() {
  const std::string_view commit = kerf::commit();
  if (commit == "unknown" || commit.ends_with("-dirty"))
    return "this kerf was built from sources of no commit";
  return {};
}

std::string unseen_of(const OutsideRenderer& renderer) {
  return renderer.command.empty() ? "the file of forces may be another" : "";
}

}  // namespace

CaseInputs inputs_of(const RegressionCase& one, AskedVersions& versions) {
  return {.law_sha256 = checksum(one),
          .trajectory_sha256 = checksum(path_of(one), axes_of(one).size()),
          .made_with = made_with(one, versions),
          .software = one.outside ? "" : software(),
          .unseen = one.outside ? unseen_of(*one.outside) : unseen_of_law()};
}

std::string changed_since(const CaseInputs& now, const schema::StoredForces& stored) {
  if (now.law_sha256 != stored.law_sha256) return "the law or the renderer has changed";
  if (now.trajectory_sha256 != stored.trajectory_sha256) return "the trajectory has changed";
  if (now.made_with != stored.made_with) {
    const std::string otherwise = made_otherwise(stored.made_with, now.made_with);
    return otherwise.empty() ? "it is not known what the forces were made with" : otherwise;
  }
  if (!now.software.empty() && now.software != stored.software)
    return "this is " + now.software + ", and " + stored.software + " stored the forces";
  return now.unseen;
}

}  // namespace kerf::bench
