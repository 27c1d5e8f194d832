#include "kerf/plugins/load.h"

#include "crash.h"
#include "kerf/plugins/open.h"

namespace kerf::plugins {

Plugin load(const std::filesystem::path& file, const std::string& sha256,
            std::chrono::milliseconds patience) {
  const Trial trial = try_law(file);
  const models::ForeignLaw& registered = open(file, sha256);
  blame_crashes();
  blame_hangs(patience);
  return {.law = &registered, .trial = trial};
}

}  // namespace kerf::plugins
