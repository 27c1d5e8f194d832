#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>

#include "replay/source.h"

namespace kerf::bench {

/// How a recorded path is played on a device that is held to it.
struct PathOptions {
  double speed = 1.0;  ///< 0.1 to 10 times that of the recording
  bool loop = false;
  bool bridge = false;
  /// Peak speed of every move that was not recorded, as a share of an axis' range a second: to the beginning,
  /// over a gap, back to the beginning of a loop.
  double move_share_per_s = 0.2;
};

/// The positions of a recording on the axes of a device, in pieces between which a move of minimum jerk leads
/// on; whole ticks throughout.
struct Path {
  struct Piece {
    std::vector<double> time_s;  ///< from the piece's begin, at the speed of the replay
    std::vector<models::SpatialMotion> sample;
    std::uint64_t ticks = 0;       ///< that playing it takes
    std::uint64_t wait_ticks = 0;  ///< of the gap after it, for which the reference stays where it is
  };
  double period_s = 1e-3;
  bool loop = false;
  std::vector<std::size_t> axes;  ///< of the device
  drivers::Axes move_limit{};     ///< peak speed of a move, by axis of the device
  std::vector<Piece> pieces;
  std::uint64_t max_ticks = 0;  ///< of one pass, from wherever the device is
};

/// @throws std::invalid_argument if the device lacks an axis of the recording, or a row is out of its range
///         or faster than the device's speed limit: with row, time and mend.
[[nodiscard]] Path make_path(const Source& source, const drivers::DeviceInfo& device, double period_s,
                             const PathOptions& options);

/// Where the device should be, and how fast it should go there.
struct Reference {
  drivers::Axes position{};
  drivers::Axes velocity{};
  bool playing = false;  ///< in the recording itself, not in a move or a wait
  bool finished = false;
};

/// Plays a path tick by tick. It begins wherever the device is. A position never steps: its change in a tick
/// is at most what the recording's own rows or the limit of a move allow.
class PathPlayer {
 public:
  explicit PathPlayer(const Path& path) noexcept : path_(&path) {}

  /// `ticks` after the last call, 1 in a loop that misses nothing; `position` matters in the first call
  /// alone.
  Reference step(std::uint64_t ticks, const drivers::Axes& position) noexcept;

 private:
  enum class Part : std::uint8_t { begin, move, play, wait, end };
  void enter(Part part, std::uint64_t ticks) noexcept;
  void next() noexcept;
  void begin_move() noexcept;
  void move_on() noexcept;
  void play_on() noexcept;

  const Path* path_;
  Part part_ = Part::begin;
  std::size_t piece_ = 0;
  std::size_t row_ = 0;
  std::uint64_t at_ = 0;      ///< ticks into the part
  std::uint64_t length_ = 0;  ///< of the part
  drivers::Axes from_{};
  Reference reference_;
};

}  // namespace kerf::bench
