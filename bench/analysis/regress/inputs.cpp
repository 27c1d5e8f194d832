#include "regress/inputs.h"

#include <filesystem>

#include <kerf/version.h>

#include "laws/plugin_mention.h"
#include "regress/path.h"

namespace kerf::bench {
namespace {

/// Of a law that is Kerf's own the program says all, unless it was built from sources that no commit has.
std::string unseen_of_law(const RegressionCase& one) {
  if (!plugin_text(one.law.law).empty()) return "the plug-in may have been built anew";
  const std::string_view commit = kerf::commit();
  if (commit == "unknown" || commit.ends_with("-dirty"))
    return "this kerf was built from sources of no commit";
  return {};
}

/// The checksum of a renderer has what its command names from the suite's folder.
std::string unseen_of(const OutsideRenderer& renderer) {
  if (renderer.command.empty()) return "the file of forces may be another";
  if (!std::filesystem::is_regular_file(renderer.folder / renderer.command.front()))
    return "the program is none of the suite's folder";
  return {};
}

}  // namespace

CaseInputs inputs_of(const RegressionCase& one) {
  return {.law_sha256 = checksum(one),
          .trajectory_sha256 = checksum(path_of(one), axes_of(one).size()),
          .software = one.outside ? "" : software(),
          .unseen = one.outside ? unseen_of(*one.outside) : unseen_of_law(one)};
}

std::string changed_since(const CaseInputs& now, const schema::StoredForces& stored) {
  if (now.law_sha256 != stored.law_sha256) return "the law or the renderer has changed";
  if (now.trajectory_sha256 != stored.trajectory_sha256) return "the trajectory has changed";
  if (!now.software.empty() && now.software != stored.software)
    return "this is " + now.software + ", and " + stored.software + " stored the forces";
  return now.unseen;
}

}  // namespace kerf::bench
