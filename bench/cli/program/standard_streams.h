#pragma once

#include <string_view>

namespace kerf::bench {

/// Opens standard streams that are closed on /dev/null, so that no file of ours takes their place, and lets a
/// write to a pipe without a reader fail instead of ending the process.
void keep_standard_streams();

/// To standard error; nobody is told if it cannot be written.
void write_error_text(std::string_view text) noexcept;

/// Ends the process as a write to a pipe without a reader does.
[[noreturn]] void end_by_closed_pipe();

}  // namespace kerf::bench
