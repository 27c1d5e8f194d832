#include "fuzz/hdf5/checks.h"
#include "fuzz/hdf5/seeds.h"
#include "fuzz/overwritten.h"
#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

/// A sound file with bytes overwritten: the first byte says which file.
void fuzz_hdf5_bytes(Bytes bytes) {
  if (bytes.empty()) return;
  const std::string& sound = seed_files().bytes(bytes.front() % SeedFiles::count);
  check_readers_apart(seed_files().folder().write("fuzz.h5", overwritten(sound, bytes.subspan(1))));
}

const Registered registered("hdf5_bytes", fuzz_hdf5_bytes);

}  // namespace
}  // namespace kerf::fuzz
