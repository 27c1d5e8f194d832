#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "laws/law_file.h"
#include "live/live_hub.h"
#include "live/live_rendering.h"
#include "live/live_status.h"
#include "run/run.h"
#include "scene/scene.h"

namespace kerf::bench {

struct LiveOptions {
  std::string device_uri;  ///< empty: the scene's, else sim:scissors
  std::string sensor_uri;  ///< what measures the device's forces beside it; empty: the device itself
  /// What a simulated device meets; none: sim:scissors meets the default scene, others nothing.
  std::optional<Scene> scene;
  double rate_hz = 1000.0;
  double ramp_s = 0.25;  ///< of the soft start, and from law to law
  bool passivity_control = false;
};

/// A loop that a person watches and steers while it runs, by the wall clock, in threads of its own: one runs
/// the device, one takes the rows out 60 times a second. One loop at a time; it may be started again and
/// again. For any thread.
class LiveLoop {
 public:
  /// The rows of one loop.
  struct Watched {
    std::uint64_t run = 0;  ///< which loop, from 1
    std::shared_ptr<const LiveHub> hub;
    [[nodiscard]] const RowHistory& history() const noexcept { return hub->history(); }
  };

  LiveLoop() = default;
  LiveLoop(const LiveLoop&) = delete;
  LiveLoop& operator=(const LiveLoop&) = delete;
  /// Stops the loop.
  ~LiveLoop();

  /// Called by the thread that takes the rows out whenever it has, and once more when the loop is over; not
  /// any more once stop() has returned. Set before start(); must not throw, nor start or stop the loop.
  void on_rows(std::function<void()> call) { on_rows_ = std::move(call); }

  /// Returns once the device is open. Renders nothing at first; a force that was released stays so.
  /// @throws drivers::DeviceError, std::invalid_argument (a rate out of range, the loop runs already).
  void start(const LiveOptions& options);
  /// Stops the loop, closes its recording and waits for both. A device that is being opened is given up.
  void stop();
  /// The same without waiting; never blocks.
  void request_stop() noexcept { stop_.store(true); }
  /// For the end of the program: zero force now, no loop is started any more, the one that runs ends. Never
  /// blocks.
  void close() noexcept {
    rendering_.release();
    closed_.store(true);
    stop_.store(true);
  }

  /// Goes softly over to a law. @throws std::invalid_argument: no loop runs, or as named_axes_for().
  void render(const LawFile& law, const std::string& name);
  /// Goes softly over to no force. @throws std::invalid_argument: no loop runs.
  void render_nothing();

  /// Marks this moment by an event of the kind "mark", which a recording holds too.
  /// @throws std::invalid_argument: no loop runs.
  void mark(const std::string& text);

  /// Zero force from the next tick on, held until resume(), also over a new start. Never blocks, and needs no
  /// running loop.
  void release_force() noexcept { rendering_.release(); }
  /// The force comes back along the soft start.
  void resume() noexcept { rendering_.resume(); }
  /// The tool is where it seems to be after a jump: the force comes back along the soft start.
  void confirm_position() noexcept { hold_.confirm(); }
  [[nodiscard]] bool is_released() const noexcept { return rendering_.is_released(); }
  /// What ended a loop, also one of somebody else's on the same device: the status tells it until it is
  /// dismissed or another loop starts.
  void tell_fault(const std::string& fault);
  void dismiss_fault() { tell_fault(""); }

  /// Records from now on, beside everything else. @throws std::invalid_argument: no loop runs, it is recorded
  /// already, or the file exists; std::system_error.
  void start_recording(const std::filesystem::path& file, bool replace = false);
  /// @throws std::invalid_argument: nothing is being recorded; std::system_error: the file could not be
  /// written to its end.
  void stop_recording();

  [[nodiscard]] LiveStatus status() const;
  /// The rows of the loop that runs, else of the last one; nothing within if there was none.
  [[nodiscard]] Watched watched() const;

 private:
  /// `over`: has ended, and who looks on is being told.
  enum class Phase : std::uint8_t { idle, starting, running, over };

  void open(const LiveOptions& options);
  void enter(Phase phase);
  void run(RunOptions options, std::promise<void>& opened);
  void watch(LiveHub& hub);
  void require_running() const;  ///< with mutex_ held
  [[nodiscard]] std::shared_ptr<LiveHub> running_hub() const;

  LiveRendering rendering_{0.25};
  ZeroHold hold_;
  std::function<void()> on_rows_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> closed_{false};
  std::atomic<bool> is_run_over_{false};
  // Of run(), and read by watch() once it is over.
  std::string fault_;
  std::vector<drivers::Figure> figures_;

  std::mutex starting_;       ///< one start at a time
  mutable std::mutex mutex_;  ///< of what follows; nothing slow is done under it
  std::condition_variable changed_;
  Phase phase_ = Phase::idle;
  std::uint64_t runs_ = 0;
  std::shared_ptr<LiveHub> hub_;
  std::string ended_;
  std::string warning_;

  std::jthread running_;
  std::jthread watching_;  ///< last: uses the rest
};

}  // namespace kerf::bench
