#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

/// Whether lines begin as JSON does, whose numbers between commas are no columns.
[[nodiscard]] bool is_json(const std::vector<std::string_view>& lines);

/// What lines that are no table of numbers are instead, and what to do with them: JSON, a log of NAME=VALUE,
/// several numbers in one field. Empty if nobody can tell.
[[nodiscard]] std::string what_it_may_be(const std::vector<std::string_view>& lines);

}  // namespace kerf::bench
