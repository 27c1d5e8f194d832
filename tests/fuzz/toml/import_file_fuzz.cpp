#include <cmath>
#include <stdexcept>

#include "fuzz/scratch_folder.h"
#include "fuzz/target.h"
#include "imports/import_file.h"

namespace kerf::fuzz {
namespace {

/// An import file that is read has a map, and options within their bounds.
void fuzz_import_file(Bytes bytes) {
  static const ScratchFolder folder;
  const auto file = folder.write("fuzz.import.toml", text_of(bytes));
  bench::ImportFile read;
  if (!is_taken<std::invalid_argument>([&] { read = bench::read_import_file(file); })) return;
  promise(!bench::parse_map(read.map).empty(), "an import file has a map");
  const bench::ImportOptions& options = read.options;
  for (const double value : {options.rate_hz, options.resample_hz, options.velocity_window_s})
    promise(std::isfinite(value) && value >= 0.0, "a rate or a window is finite, or none");
  for (const double value : options.places.origin_m) promise(std::isfinite(value), "an origin is finite");
}

const Registered registered("import_file", fuzz_import_file);

}  // namespace
}  // namespace kerf::fuzz
