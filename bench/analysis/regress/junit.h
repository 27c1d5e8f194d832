#pragma once

#include <filesystem>
#include <string>

#include "regress/run.h"

namespace kerf::bench {

/// What came of a suite as JUnit XML, the form in which build servers take the results of tests: a case that
/// did not pass as <failure>, one that could not be compared as <error>. With the folder of the page,
/// pictures of what differs are named in <system-out> as GitLab and Jenkins take attachments:
/// [[ATTACHMENT|FILE]].
[[nodiscard]] std::string junit_xml(const Suite& suite, const SuiteOutcome& outcome,
                                    const std::filesystem::path& page = {});

/// The same of a suite that could not be read at all: one case of its name with the reason.
[[nodiscard]] std::string junit_xml(const std::filesystem::path& suite, const std::string& error);

/// Text with what XML gives a meaning replaced, and what it forbids (most control characters, bytes that are
/// no UTF-8) by a question mark.
[[nodiscard]] std::string xml_escaped(const std::string& text);

}  // namespace kerf::bench
