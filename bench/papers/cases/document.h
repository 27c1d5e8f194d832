#pragma once

#include <string>
#include <vector>

#include "cases/cases.h"
#include "cases/control_cost.h"

namespace kerf::bench {

/// The cases as a page: a table, a section a case with its picture, what passivity control costs. Pictures
/// are `folder`/NAME.svg, the controller's costs `folder`/control_cost.svg.
[[nodiscard]] std::string cases_as_markdown(const std::vector<NamedCase>& cases, const ControlCosts& costs,
                                            const std::string& folder);

/// Between these two lines of a document its cases stand; what is around them is written by hand.
inline constexpr const char* cases_begin = "<!-- cases: written by the bench -->\n";
inline constexpr const char* cases_end = "<!-- end of the cases -->\n";

/// A document with its cases written anew. @throws std::invalid_argument if it lacks either line.
[[nodiscard]] std::string with_cases(const std::string& document, const std::string& cases);

}  // namespace kerf::bench
