#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "live/live_rendering.h"
#include "live/live_status.h"
#include "live/loop_timing.h"
#include "live/row_history.h"
#include "live/running_recording.h"
#include "record/row_tap.h"
#include "scene/scene.h"

namespace kerf::bench {

/// What comes out of one loop and where it goes: rows from the tick through a tap to the history, the timing
/// and a recording; what a person did to the rendering becomes events of both.
class LiveHub {
 public:
  /// All memory is taken here. The rendering has to outlive it.
  LiveHub(LiveRendering& rendering, drivers::DeviceInfo device, std::optional<Scene> scene, double rate_hz);

  /// The tick's: a row that has just come about.
  void push(const schema::Row& row) noexcept {
    rendering_.record(row);
    tap_.push(row);
  }

  /// Takes out what the tick has left. By one thread.
  void drain();
  /// After the last drain: closes a recording that is under way. `fault`: what happened to the device; empty
  /// if the loop was stopped.
  void end(const std::string& fault, const std::vector<drivers::Figure>& figures);

  /// What is rendered, in words.
  struct Rendered {
    std::string law;     ///< its name; empty: none
    std::string plugin;  ///< plugin_in_words() of it
  };
  /// Offers a rendering under a name; none: nothing.
  void offer(std::unique_ptr<LawRendering> rendering, const Rendered& rendered);

  /// A person marks the next rows that come out: an event of the kind "mark", also in a recording.
  void mark(const std::string& text);

  /// @throws std::invalid_argument: another recording is under way, or the file exists; std::system_error.
  void start_recording(const std::filesystem::path& file, bool replace);
  /// @throws std::invalid_argument: there is none; std::system_error: it could not be written to its end.
  void stop_recording();

  [[nodiscard]] const drivers::DeviceInfo& device() const noexcept { return device_; }
  [[nodiscard]] const RowHistory& history() const noexcept { return history_; }
  /// Fills in what the hub knows.
  void tell(LiveStatus& status) const;

 private:
  static constexpr std::size_t tap_rows = 8192;

  [[nodiscard]] std::vector<LiveEvent> events_until(std::uint64_t tick);
  [[nodiscard]] LiveEvent next_mark(const schema::Row& row);
  [[nodiscard]] schema::Event event_of(const LiveChange& change);
  void record(const schema::Row& row);
  [[nodiscard]] std::string close(RunningRecording& recording, const RunningRecording::Ending& ending);

  LiveRendering& rendering_;
  drivers::DeviceInfo device_;
  std::optional<Scene> scene_;
  double rate_hz_;
  RowTap tap_;
  RowHistory history_;
  // Of the draining thread.
  std::vector<schema::Row> chunk_;
  std::deque<LiveChange> changes_;  ///< whose rows have not come yet

  mutable std::mutex mutex_;        ///< of what follows; nothing slow is done under it
  std::vector<std::string> marks_;  ///< whose rows have not come yet
  std::map<std::uint64_t, Rendered> offered_;
  Rendered rendered_;
  bool is_released_ = false;  ///< as of the last row
  LoopTiming timing_;
  std::uint64_t ticks_ = 0;
  std::uint64_t rows_ = 0;
  std::unique_ptr<RunningRecording> recording_;
  bool is_opening_ = false;  ///< a recording
  bool has_ended_ = false;
  std::string recording_failure_;
};

}  // namespace kerf::bench
