#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sealed/session_store.h"

// Whether a trial counts: what was felt of each of its slots, and whether the loop was sound meanwhile.

namespace kerf::bench {

/// Below it a force is not felt: the smallest JND of force that simulated observers have unless said
/// otherwise.
inline constexpr double least_felt_force_n = 0.05;

/// While one slot played, over the axes of the device; torques as forces at a lever of 10 mm.
struct SlotFelt {
  double playing_s = 0.0;
  double contact_s = 0.0;  ///< with a force that can be felt
  double rms_n = 0.0;      ///< over contact_s; 0 without contact
  double peak_n = 0.0;
  double travel_m = 0.0;            ///< of the points where forces act
  double speed_m_s = 0.0;           ///< travel over playing_s
  double work_j = 0.0;              ///< that the hand did against the force
  std::uint64_t limited_ticks = 0;  ///< the force was cut, or came more slowly than was asked for
};

struct TrialQuality {
  std::vector<SlotFelt> slots;
  std::uint64_t faulty_ticks = 0;  ///< faults of law or device, jumps, watchdog, lost rows, a new soft start
  std::uint64_t missed_deadlines = 0;

  [[nodiscard]] bool is_felt() const noexcept;  ///< every slot had contact
  [[nodiscard]] bool is_sound() const noexcept { return faulty_ticks == 0; }
};

/// None of a trial without a trace, of which nothing is known.
[[nodiscard]] std::optional<TrialQuality> quality_of(const RecordedTrial& trial, std::size_t slots);

}  // namespace kerf::bench
