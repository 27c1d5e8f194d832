#include "fuzz/hdf5/checks.h"
#include "fuzz/hdf5/edits.h"
#include "fuzz/hdf5/seeds.h"
#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

/// A sound file that was put out of order: the first byte says which, the others how.
void fuzz_hdf5(Bytes bytes) {
  if (bytes.empty()) return;
  const auto file = seed_files().write(bytes.front() % SeedFiles::count);
  edit_hdf5(file, bytes.subspan(1));
  check_readers(file);
}

const Registered registered("hdf5", fuzz_hdf5);

}  // namespace
}  // namespace kerf::fuzz
