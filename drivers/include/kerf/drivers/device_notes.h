#pragma once

#include <functional>
#include <string>
#include <vector>

namespace kerf::drivers {

/// Keeps a line that ought to be known before a device is used and is no reason to refuse it: a calibration
/// that is old, a bias that has moved. Set-up alone calls it, from any thread.
void note_device(std::string line);

/// What has been noted since this was last asked, the first first.
[[nodiscard]] std::vector<std::string> take_device_notes();

/// Who is told at once what the opening of a device waits for, where that is longer than a person expects.
/// The program says it once, before anything is opened.
void tell_waits_to(std::function<void(const std::string&)> told);
void tell_wait(const std::string& line);

}  // namespace kerf::drivers
