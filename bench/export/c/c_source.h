#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "exported_law.h"

namespace kerf::bench {

/// The law as one file of C99 that needs libm alone: NAME_reset(), NAME_step(), NAME_step_depth(),
/// NAME_describe(). @param law all but `plain_c`
/// @throws std::invalid_argument with the reason for a law that cannot be written out (traced::trace()).
[[nodiscard]] std::string c_source(const ExportedLaw& law);

/// What is known of a law, as NAME_describe() gives it.
[[nodiscard]] nlohmann::ordered_json described(const ExportedLaw& law);

}  // namespace kerf::bench
