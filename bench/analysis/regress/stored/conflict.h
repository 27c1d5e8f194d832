#pragma once

#include <filesystem>
#include <string_view>

#include "regress/suite.h"

namespace kerf::bench {

/// A merge that two branches left undecided stands in a file as lines that begin with '<<<<<<< '; a file
/// that Git LFS has not fetched as a pointer. @throws std::invalid_argument in one line that says what to do.
void require_no_conflict(const std::filesystem::path& file, std::string_view text, const Suite& suite);
/// The same of the first bytes of a file that is no text.
void require_no_conflict(const std::filesystem::path& file, const Suite& suite);

}  // namespace kerf::bench
