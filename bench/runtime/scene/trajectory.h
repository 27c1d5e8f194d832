#pragma once

#include <variant>

#include <kerf/drivers/hand.h>
#include <kerf/drivers/pose_path.h>

namespace kerf::bench {

/// Scissors that open and close: a pause, a closing, a pause, an opening, and so on.
struct ScissorsStrokes {
  double open_rad = drivers::HandOptions{}.open_rad;
  double close_rad = drivers::HandOptions{}.close_rad;
  double stroke_s = drivers::HandOptions{}.stroke_s;
  double pause_s = drivers::HandOptions{}.pause_s;
  double variation = drivers::HandOptions{}.variation;  ///< from stroke to stroke, as a share
};

/// Strokes for scissors; keyframes, with those that an indentation is made of, for a tool that knows its
/// pose; neither if nothing is said.
using Script = std::variant<std::monostate, ScissorsStrokes, drivers::PosePath::Options>;

/// What the hand does with the tool.
struct Trajectory {
  double seconds = 10.0;
  Script script{};
};

}  // namespace kerf::bench
