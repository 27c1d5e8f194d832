#include "kerf/plugins/load.h"

#include "crash.h"
#include "kerf/plugins/open.h"

namespace kerf::plugins {

Plugin load(const std::filesystem::path& file, const std::string& sha256) {
  const Trial trial = try_law(file);
  const models::ForeignLaw& registered = open(file, sha256);
  blame_crashes();
  return {.law = &registered, .trial = trial};
}

}  // namespace kerf::plugins
