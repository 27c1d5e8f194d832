#pragma once

#include <string>
#include <vector>

#include "program/described.h"

namespace kerf::bench {

/// "kerf-session-new", of the program itself "kerf".
[[nodiscard]] std::string page_name(const DescribedVerb& verb);

/// The page of a verb for section 1 of the manual, in the macros of man(7). @param date as pages have it,
/// 2026-11-25
[[nodiscard]] std::string man_page(const DescribedVerb& verb, const std::vector<DescribedVerb>& all,
                                   const std::string& date);

}  // namespace kerf::bench
