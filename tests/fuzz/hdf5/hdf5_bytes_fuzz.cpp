#include <cstring>

#include "fuzz/hdf5/checks.h"
#include "fuzz/hdf5/seeds.h"
#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

/// A sound file with bytes overwritten: the first byte says which file, then come pieces, each where, how
/// long and what.
void fuzz_hdf5_bytes(Bytes bytes) {
  if (bytes.empty()) return;
  std::string whole = seed_files().bytes(bytes.front() % SeedFiles::count);
  for (bytes = bytes.subspan(1); bytes.size() > 3;) {
    const std::size_t at = (bytes[0] * 256U + bytes[1]) % whole.size();
    const std::size_t length =
        std::min({1 + bytes[2] % std::size_t{16}, bytes.size() - 3, whole.size() - at});
    std::memcpy(whole.data() + at, bytes.data() + 3, length);
    bytes = bytes.subspan(3 + length);
  }
  check_readers(seed_files().folder().write("fuzz.h5", whole));
}

const Registered registered("hdf5_bytes", fuzz_hdf5_bytes);

}  // namespace
}  // namespace kerf::fuzz
