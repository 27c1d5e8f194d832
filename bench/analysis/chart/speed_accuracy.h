#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <kerf/fitting/fit.h>

#include "chart/convergence.h"
#include "chart/cost/tick_cost.h"
#include "fits/fit_recording.h"
#include "laws/law_file.h"
#include "scene/scene.h"
#include "segment/result_state.h"
#include "stability/stability_verdict.h"

namespace kerf::bench {

/// By which percentile of cold ticks the second front goes: the largest that enough ticks were taken for.
enum class ColdTail : std::uint8_t { none, p99, p999 };

/// A law at one fidelity: what a tick costs, and how far its force is from the reference.
struct ChartPoint {
  std::string law;
  std::string fidelity;
  std::size_t parameters = 0;
  double rate_hz = 0.0;  ///< of the loop that renders it
  TickCost cost;
  double error_n = 0.0;    ///< root mean square, on the axis that is worst in JNDs [the chart's unit]
  double error_jnd = 0.0;  ///< the same in JNDs
  double worst_n = 0.0;    ///< the largest, on that axis, likewise
  /// Share of ticks in contact whose error a person could feel, by the JND of the force of then; on the axis
  /// with the largest share. NaN: nobody looked.
  double jnd_fraction = std::numeric_limits<double>::quiet_NaN();
  std::string axis;
  StabilityVerdict stability;
  bool on_front = false;       ///< by median cost
  bool on_cold_front = false;  ///< by the cold tail
  LawFile file;
  std::shared_ptr<const fitting::FitResult> fit{};  ///< to a recording, with its errors fold by fold
};

/// The largest share of ticks outside the JND that a point within the JND may have.
inline constexpr double jnd_fraction_limit = 0.05;

/// Within the JND: its root mean square is, and so are all ticks but a share of jnd_fraction_limit.
[[nodiscard]] bool within_jnd(const ChartPoint& point) noexcept;

/// Cost against error, for all laws and fidelities.
struct SpeedAccuracy {
  std::string source;                        ///< name of the recording or scene
  std::string recording{};                   ///< its uuid; empty for a scene
  KeptState of_recording{};                  ///< of which state; a scene has none
  std::optional<models::Contact> contact{};  ///< of a recording
  std::string reference;                     ///< in words, what errors are towards
  Convergence convergence{};  ///< of the reference, where it is a finer mesh; no refinements else
  double rate_hz = 0.0;
  double jnd_n = 0.0;  ///< of the axis, or of the worst axis of the cheapest point where there are several
  std::string force_unit{"N"};  ///< of errors and JND: the axis' own; of a scene forces at the hand
  bool one_axis = true;         ///< errors in that unit are comparable; else only those in JNDs
  std::vector<ChartPoint> points;
  ColdTail cold_tail = ColdTail::none;
  ColdCost empty_tick;  ///< what the machine itself adds to a cold tick; no ticks if nobody looked
  std::optional<CycleChoice> cycles;  ///< of a recording, as asked for
  std::vector<LeftOutCycle> cycles_left_out;
  std::vector<std::string> notes;
  bool stopped = false;  ///< before it was done; there are no points then
};

struct ChartOptions {
  double rate_hz = 1000.0;
  std::vector<std::string> models;  ///< laws to fit; empty: those that say something of any axis
  fitting::Jnd jnd;
  RowChoice rows{};  ///< of a recording, that count
  std::size_t folds = 5;
  std::size_t threads = 1;
  /// Judges the closed loop with this law at this rate. Empty: nobody does, and only what it renders along
  /// the path is looked at.
  std::function<StabilityVerdict(const LawFile&, double rate_hz)> stability;
  /// cold_ticks: of points near a front; others have ticks_for_p99 at most.
  TickCostOptions timing{.cold_ticks = ticks_for_p999, .told = {}};
  const std::atomic<bool>* stop = nullptr;
  std::atomic<std::size_t>* done = nullptr;  ///< counts up to chart_steps

  [[nodiscard]] bool stopped() const { return stop != nullptr && stop->load(); }
};
inline constexpr std::size_t chart_steps = 1000;

/// A path of the tool that can be had at any rate, on the axes of a device.
struct ScriptedPath {
  drivers::DeviceInfo device;
  std::function<SampledMotion(double rate_hz)> at;
};

/// The script of a scene, on its device; no deeper than where its first layer is cut through. @throws as
/// tool_path() and device_of() do, drivers::DeviceError.
[[nodiscard]] ScriptedPath scripted_path(const Scene& scene);

/// A law of a scene at all its fidelities along a path, and, for a law along one axis, the other laws as
/// fitted to its reference there. The reference is the converged fidelity (fidelities.h); forces are compared
/// at the ticks of each, while the reference pushes.
///
/// Each axis is judged by its own JND at the root mean square of its reference; a torque in N·m counts as the
/// force at the hand (fitting::felt_lever). A point is judged by its
/// worst axis. Not stable: a force that is not finite or above ten times the largest of the reference, or
/// what options.stability says; without that a point is not judged, but competes. Laws with two branches are
/// judged as they are, and timed and held with the rendering aids of [Okamura2003] where they have none. Only
/// points at the chart's own rate compete for the front.
/// @throws std::invalid_argument if the path never meets the tissue.
[[nodiscard]] SpeedAccuracy chart_scene(const LawFile& law, const ScriptedPath& path,
                                        const ChartOptions& options);

/// Every law that fits an axis of a recording, in every size: segments 1 to 12, tables of 2 to 256 points,
/// arms 1 to 4, and each integrator. Errors are those on held-out cycles (blocks where there are none), over
/// the rows in contact and as a loop at the chart's rate renders them (rendered_series.h): with the rendering
/// aids that the cost has too. A law in single precision adds what its rounding does along the recording.
/// Costs are those along the 4,000 rows of the recording with most contact.
/// @throws std::invalid_argument if no law can be fitted.
[[nodiscard]] SpeedAccuracy chart_recording(const FitSource& source, const ChartOptions& options);

/// A recording as it is charted: along the axis of that name, or of its cycles. The recording must outlive
/// it.
/// @throws std::invalid_argument: it has no such axis.
[[nodiscard]] FitSource charted(const schema::Recording& recording, const std::string& name,
                                const std::string& axis);

/// Judges a point whose forces along the path were none that run away.
void judge_stability(ChartPoint& point, const ChartOptions& options);

}  // namespace kerf::bench
