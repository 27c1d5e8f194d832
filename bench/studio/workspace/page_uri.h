#pragma once

#include <string>

#include "workspace/workspace.h"

namespace kerf::bench {

/// The URI to open for one that a page has sent. An option that names a file (drivers::names_a_file()) may
/// name a regular file of the workspace alone, by its path within it; a driver opens what it is given, and
/// says in its refusal what stands in there. A machine or port (drivers::names_a_place()) may not be
/// named, and no name of the bench file that leads to one, or to a file, or stands beside such a sensor.
/// @throws RequestError 400 for any other file, and for a machine or port; drivers::DeviceError for what is
/// no URI.
[[nodiscard]] std::string uri_from_page(const Workspace& workspace, const std::string& text);

}  // namespace kerf::bench
