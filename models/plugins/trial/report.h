#pragma once

#include <string>

namespace kerf::law_trial {

/// To who started this process: "at STAGE" before what a plug-in might not come back from, "refused WHY" or
/// "done ..." at the end.
void report(const std::string& line);

/// Tells why the plug-in is none, and ends.
[[noreturn]] void refuse(const std::string& why);

}  // namespace kerf::law_trial
