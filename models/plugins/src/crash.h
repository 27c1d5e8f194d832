#pragma once

namespace kerf::plugins {

/// From now on a signal of a crash, or exit(), from within a plug-in ends the program at once with a line
/// that names the file and exit status 4. What is not a plug-in's ends it as before.
void blame_crashes();

}  // namespace kerf::plugins
