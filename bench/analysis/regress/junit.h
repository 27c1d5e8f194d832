#pragma once

#include <string>

#include "regress/run.h"

namespace kerf::bench {

/// What came of a suite as JUnit XML, the form in which build servers take the results of tests.
[[nodiscard]] std::string junit_xml(const Suite& suite, const SuiteOutcome& outcome);

/// Text with what XML gives a meaning replaced, and what it forbids (most control characters, bytes that are
/// no UTF-8) by a question mark.
[[nodiscard]] std::string xml_escaped(const std::string& text);

}  // namespace kerf::bench
