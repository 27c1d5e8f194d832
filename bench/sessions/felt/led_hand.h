#pragma once

#include <string>

#include "protocol/protocol.h"

namespace kerf::bench {

/// A simulated device whose hand keeps to the target of the protocol's guide, in step with its clock: the
/// hand wants to be where the target is, and is pushed aside by what it feels. As it is: a URI of another
/// device than sim:scissors, or one that says itself what the hand does; a protocol without a target on
/// theta, or with one beyond what the hand may want (-20 to 60 deg).
[[nodiscard]] std::string led_hand(const std::string& uri, const Protocol& protocol);

}  // namespace kerf::bench
