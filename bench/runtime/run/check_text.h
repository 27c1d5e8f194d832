#pragma once

#include <string>
#include <vector>

#include "run/check.h"

namespace kerf::bench {

/// What `kerf check` tells of a run before its verdict: what was obtained of the machine, the time of each
/// stage, an empty loop beside it, and the reasons.
[[nodiscard]] std::vector<std::string> check_lines(const RunResult& result, const Verdict& verdict);

}  // namespace kerf::bench
