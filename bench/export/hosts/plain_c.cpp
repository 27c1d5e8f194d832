#include "exported_law.h"

namespace kerf::bench {
namespace {

std::vector<HostFile> plain_c_files(const ExportedLaw& law) {
  return {{law.name + ".c", law.plain_c}};
}

}  // namespace

Host plain_c_host() {
  return {.name = "c", .what = "one file of C99", .takes_c = true, .files = plain_c_files, .forces = nullptr};
}

}  // namespace kerf::bench
