#pragma once

#include <chrono>

namespace kerf::plugins {

/// From now on a signal of a crash, or exit(), from within a plug-in ends the program at once with a line
/// that names the file and exit status 4. What is not a plug-in's ends it as before.
void blame_crashes();

/// From now on a call into a plug-in that does not come back for so long ends the program likewise. The first
/// call decides how long.
void blame_hangs(std::chrono::milliseconds patience);

}  // namespace kerf::plugins
