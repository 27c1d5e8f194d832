#include "law_in_words.h"

#include <fmt/format.h>

namespace kerf::bench {

std::string fit_in_words(const LawFile& law) {
  if (law.fit.recording_uuid.empty()) return "none is named: the law was written by hand";
  return fmt::format("recording {} ({}), RMSE {:.4g} {}, {}, {}", law.fit.recording_uuid,
                     law.fit.recording_sha256, law.fit.rmse_n, law.force_unit, law.fit.date,
                     law.fit.software);
}

std::string range_in_words(const LawFile& law) {
  if (!law.fit.range) return "not known: the law file names no range of its fit";
  return fmt::format("penetration {:.4g} to {:.4g} {}, speed up to {:.4g} {}/s, where it was fitted",
                     law.fit.range->least, law.fit.range->most, law.position_unit, law.fit.range->fastest,
                     law.position_unit);
}

}  // namespace kerf::bench
