#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

/// Opens standard streams that are closed on /dev/null, so that no file of ours takes their place, and lets a
/// write to a pipe without a reader fail instead of ending the process.
void keep_standard_streams();

// Everything that the program prints goes by one thread, in its order: nobody here waits for whoever reads,
// and none of these throws.

/// To standard output.
void write_output_text(std::string_view text) noexcept;
/// To standard error.
void write_error_text(std::string_view text) noexcept;
/// To standard error, what is drawn again and again: dropped where something older still waits.
void draw_error_text(std::string_view text) noexcept;

/// Waits for as long as a line takes until what was given is written: before something else writes to the
/// same terminal.
void let_lines_out() noexcept;

/// What write_error_text() was given and could not be written, or has waited for a while.
[[nodiscard]] std::vector<std::string> unprinted_errors();

/// Waits until all is written, as every program's end does; no file is open then, and a signal ends it at
/// once.
/// @returns errno of the first write to standard output that failed; 0 if none did.
int finish_standard_streams() noexcept;

/// Ends the process as a write to a pipe without a reader does.
[[noreturn]] void end_by_closed_pipe();

}  // namespace kerf::bench
