#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "protocol/felt_level.h"
#include "sealed/session_store.h"

// Whether a trial counts: what was felt of each of its slots, and whether the loop was sound meanwhile.

namespace kerf::bench {

/// A stroke is at least so long, from one turn of the tool to the next.
inline constexpr double least_stroke_m = 0.002;

/// While one slot played, over the axes of the device; torques as forces at a lever of 10 mm. Forces are
/// those of the law: where a guide was felt, what was commanded less what the guide added.
struct SlotFelt {
  double playing_s = 0.0;
  double contact_s = 0.0;  ///< with a force that can be felt
  double rms_n = 0.0;      ///< over contact_s; 0 without contact
  double peak_n = 0.0;
  double travel_m = 0.0;            ///< of the points where forces act
  double speed_m_s = 0.0;           ///< travel over playing_s
  double work_j = 0.0;              ///< that the hand did against the force
  std::size_t strokes = 0;          ///< of the axis with the most of them
  std::uint64_t limited_ticks = 0;  ///< the force was cut, or came more slowly than was asked for
  double peak_speed_m_s = 0.0;      ///< the fastest stretch of 20 ms
  // Of trials that a guide's target led; else NaN.
  double off_target = not_led;   ///< root mean square of the distance to it [unit of the axis]
  double guide_rms_n = not_led;  ///< of the guide's force, over playing_s
  double guide_peak_n = not_led;
  double lag_s = not_led;  ///< guide_lags_s(); known of whole trials only

  [[nodiscard]] double strokes_per_s() const noexcept {
    return playing_s > 0.0 ? static_cast<double>(strokes) / playing_s : 0.0;
  }
  static constexpr double not_led = std::numeric_limits<double>::quiet_NaN();
};

struct TrialQuality {
  std::vector<SlotFelt> slots;
  std::uint64_t faulty_ticks = 0;  ///< faults of law or device, jumps, watchdog, lost rows, a new soft start
  std::uint64_t soft_start_ticks = 0;  ///< of those, with a soft start
  std::uint64_t fault_ticks = 0;       ///< of those, with anything else
  std::uint64_t missed_deadlines = 0;

  [[nodiscard]] bool is_felt() const noexcept;  ///< every slot had contact
  [[nodiscard]] bool is_sound() const noexcept { return faulty_ticks == 0; }
};

/// What is known of a trial so far, tick by tick.
class TrialMeter {
 public:
  /// The axes have to outlive it. `led_axis`: led_axis_of().
  TrialMeter(const std::vector<schema::Axis>& axes, std::size_t slots,
             std::optional<std::size_t> led_axis = {});
  void take(const TraceRow& tick);
  [[nodiscard]] TrialQuality quality() const;

 private:
  /// Of the tool along one axis while one slot plays.
  struct Stroking {
    void go(double way_m) noexcept;

    double at_m = 0.0;
    double least_m = 0.0;  ///< since it turned
    double most_m = 0.0;
    int direction = 0;  ///< of the last stroke
    std::size_t strokes = 0;
  };

  void take_guide(const schema::Row& row, double elapsed_s, SlotFelt& slot);
  void take_speed(const TraceRow& tick, SlotFelt& slot);

  const std::vector<schema::Axis>* axes_;
  std::optional<std::size_t> led_axis_;
  std::vector<double> newtons_;                  ///< of a unit of force on each axis
  std::vector<double> squares_;                  ///< of each slot [N^2 s]
  std::vector<std::vector<Stroking>> stroking_;  ///< slots x axes
  std::vector<double> off_target_;               ///< squares of the distance of each slot [unit^2 s]
  std::vector<double> guide_squares_;            ///< of the guide's force in each slot [N^2 s]
  std::optional<TraceRow> speed_since_;          ///< where the stretch began whose speed is taken
  TrialQuality quality_;
  std::optional<TraceRow> before_;
};

/// Every slot was felt as the protocol asks.
[[nodiscard]] bool is_explored(const TrialQuality& quality, const Exploration& asked) noexcept;

/// Why a trial of that quality does not count, by the rules of its protocol; nothing if it does.
[[nodiscard]] std::vector<VoidReason> void_reasons_of(const TrialQuality& quality, const TrialRules& rules);

/// None of a trial without a trace, of which nothing is known.
[[nodiscard]] std::optional<TrialQuality> quality_of(const RecordedTrial& trial, std::size_t slots);
/// The same with what the protocol's guide tells of it.
[[nodiscard]] std::optional<TrialQuality> quality_of(const RecordedTrial& trial, const Protocol& protocol);

}  // namespace kerf::bench
