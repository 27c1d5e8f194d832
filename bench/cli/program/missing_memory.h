#pragma once

namespace kerf::bench {

/// From now on memory that is missing where nobody can catch it, before main() and in what promised not to
/// throw, ends the program with one line and Exit::file_error. Whatever else would end it does so as ever.
void end_where_memory_is_missing() noexcept;

}  // namespace kerf::bench
