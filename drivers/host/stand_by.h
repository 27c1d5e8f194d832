#pragma once

#include "work.h"

namespace kerf::host {

/// Makes a copy of this process that lets the device go where this one dies, or holds a force and gives no
/// sign of life in time, and that ends this one where it outlives its program by a second. The copy has what
/// open() left: descriptors and memory, but no threads.
/// @returns its process. @throws Refusal where it cannot be made: no force may be given then
[[nodiscard]] pid_t stand_by(const Opened& opened, drivers::hosted::Page& page);

}  // namespace kerf::host
