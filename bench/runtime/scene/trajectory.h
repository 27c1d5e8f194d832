#pragma once

#include <variant>

#include <kerf/drivers/hand.h>
#include <kerf/drivers/pose_path.h>

namespace kerf::bench {

/// Strokes for scissors (of HandOptions not how firmly it holds them); keyframes, with those that an
/// indentation is made of, for a tool that knows its pose; neither if nothing is said.
using Script = std::variant<std::monostate, drivers::HandOptions, drivers::PosePath::Options>;

/// What the hand does with the tool.
struct Trajectory {
  double seconds = 10.0;
  Script script{};
};

}  // namespace kerf::bench
