#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drawer/study_file.h"
#include "run/studied_recording.h"

namespace kerf::bench {

/// A recording of a drawer with what its file says of it.
struct DrawerRecording {
  std::string name;
  DrawerFile file{};
  StudiedRecording result;
  std::vector<std::string> doubts{};      ///< why it may not be one like the others
  std::optional<double> share_of_tool{};  ///< peak of a blank of its speed to its own, where that is beyond
                                          ///< 0.3 and not taken off

  /// Whether it counts in what is said of its tissue.
  [[nodiscard]] bool counts() const {
    return result.failure.empty() && !file.blank && !result.laws.empty() &&
           (doubts.empty() || !file.accepted.empty());
  }
};

/// What is doubted of each recording beside the others of its drawer:
///
///     a unit     its travel, its usual step or its peak force is that of the others times what one unit is
///     of
///                another (degrees for radians, ms for s, kgf for N), within 1.4 times; or more than 5 times
///                theirs. Forces are held to recordings of the same tissue and speed (tissue, where there are
///                too few), the others to all. The others are at least three and agree with each other three
///                times better.
///     the axis   a law of an angle and a torque says nothing of a length and a force: most decide
///     cycles     none is good (unless all count)
///     closing    it closes the other way round than most
///     blank      none was taken off it, but off others of its tissue and speed
///
/// And whether a blank of its speed (any, where no speed is the same) meets a large share of its peak: no
/// reason to leave it out, but what is fitted is then tool and tissue together.
///
/// Another unit or another experiment: that is for a person to say.
void doubt_recordings(std::vector<DrawerRecording>& recordings, bool all_cycles = false);

}  // namespace kerf::bench
