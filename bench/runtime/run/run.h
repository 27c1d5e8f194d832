#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>

#include "device_model/model_in_use.h"
#include "files/progress.h"
#include "host/host_floor.h"
#include "host/realtime.h"
#include "laws/law_file.h"
#include "loop/loop.h"
#include "recordings/row_figures.h"
#include "scene/scene.h"

namespace kerf::bench {

/// A law that takes over during a run, softly.
struct LawChange {
  LawFile law;
  double at_s = 0.0;  ///< loop time
};

/// What is rendered where it is no law: called once a tick, it must not allocate, lock or throw.
struct OtherRendering {
  std::function<Command(const drivers::Sample&, double elapsed_s)> step;
  std::function<bool()> finished;  ///< ends the run before its time; empty: nothing does
  std::uint64_t max_ticks = 0;     ///< after which it has finished at the latest; 0: not known
};

/// What to run on a device, for how long, and where to record it.
struct RunOptions {
  std::string device_uri = "sim:scissors";
  std::string
      sensor_uri;  ///< what measures the device's forces beside it; empty: the device itself, or nothing
  double seconds = 10.0;
  double rate_hz = 1000.0;
  bool virtual_time = false;
  std::optional<LawFile> law;      ///< rendered as force; none: the device moves freely
  std::vector<LawChange> changes;  ///< laws that come after it
  /// Makes what is rendered in place of a law once the device is open, before anything moves.
  std::function<OtherRendering(const drivers::DeviceInfo&)> rendering;
  /// Gets the row of every tick, beside a recording or without one; it must not allocate, lock or throw.
  std::function<void(const schema::Row&)> each_row;
  double ramp_s = 0.25;  ///< of the soft start, and from law to law
  bool passivity_control = false;
  /// File of the device's model, of which the passivity controller takes mass and friction; empty: the one
  /// that is kept of the device, if its driver knows less.
  std::string device_model;
  bool is_probe = false;  ///< finds out itself which way the device pushes: no kept probe is asked for
  ZeroHold* zero_hold = nullptr;  ///< where somebody confirms after a jump of the position; none: nobody can
  std::optional<Scene> scene;     ///< what a simulated device meets
  std::optional<std::filesystem::path> record;  ///< where to record
  bool replace = false;                         ///< an existing recording may be replaced
  /// Time to measure what the machine itself does to an empty loop, unless that is known since it was started
  /// and need not be known anew; 0: only how early to wake up is measured. By the wall clock only.
  double floor_s = 0.0;
  bool floor_anew = false;
  ShowProgress progress = show_no_progress;
  std::function<void(std::string_view)> warn;  ///< told at once what is wrong with recording or device
  /// Asked at the end what of that, and of what others had to say meanwhile, nobody could read: it becomes
  /// events of the recording.
  std::function<std::vector<std::string>()> unprinted;
};

struct RunResult {
  drivers::DeviceInfo device;
  std::optional<ModelInUse> device_model;  ///< that a controller took numbers from, or that was named
  double period_s = 0.0;
  LoopReport report;
  std::vector<RealtimeMeasure> realtime;  ///< empty in virtual time
  ThreadUsage usage;                      ///< of the loop's thread while it ran; zero in virtual time
  std::optional<HostFloor> floor;         ///< if it was asked for
  std::int64_t spin_ns = 0;               ///< how long before its deadline the loop woke up
  std::vector<drivers::Figure> figures;   ///< what the device counted
  std::vector<Stall> stalls;              ///< the first Heartbeat::max_stalls of them
  std::uint64_t rows_lost = 0;
  std::optional<RowFigures> recorded;  ///< of the rows in the recording, if there is one
  std::string recording_failure;  ///< why the recording could not be written to its end; empty if it could
};

/// How long a loop was silent, and when the device was released.
[[nodiscard]] std::string in_words(const Stall& stall);

/// Runs the loop on a device and records it if asked to. What renders is held to require_probed(). `stop`
/// ends it early and cleanly. However it ends, the device is left with zero force.
/// @throws drivers::DeviceError, std::invalid_argument, std::system_error (the recording could not be begun).
[[nodiscard]] RunResult run_on_device(const RunOptions& options, const std::atomic<bool>& stop);

/// A flag that Ctrl-C, Ctrl-\, SIGTERM and the end of the terminal set while the object lives; of what is
/// asked for, SIGUSR1 too, by which a queue says that its time is nearly over.
class StopOnSignal {
 public:
  enum class Also : std::uint8_t { nothing, user_signal };
  explicit StopOnSignal(Also also = Also::nothing);
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;
  ~StopOnSignal();
  [[nodiscard]] const std::atomic<bool>& requested() const noexcept;

 private:
  Also also_;
};

}  // namespace kerf::bench
