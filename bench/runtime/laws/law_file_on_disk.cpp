#include <fmt/core.h>

#include <kerf/version.h>

#include "files/named_file.h"
#include "files/whole_file.h"
#include "laws/law_file.h"
#include "laws/plugin_laws.h"
#include "recordings/provenance.h"

namespace kerf::bench {

LawFile read_law_file(const std::filesystem::path& file) {
  if (is_plugin(file.string())) return law_of_plugin(file);
  return parse_law_file(read_named_file(file), file.string());
}

void name_recording(FitProvenance& fit, const std::filesystem::path& recording) {
  fit.recording_sha256 = sha256_of(recording);
  fit.recording_content = content_sha256_of(recording);
}

void write_law_file(const std::filesystem::path& file, const LawFile& law, schema::Existing existing) {
  write_whole_file(file, fmt::format("# {}\n{}", software(), to_toml(law)), existing);
}

}  // namespace kerf::bench
