#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/fitting/jnd.h>

namespace kerf::bench {

enum class ForceEventKind : std::uint8_t { contact, release, drop };
inline constexpr std::array<std::string_view, 3> force_event_names{"contact", "release", "drop"};

struct ForceEvent {
  ForceEventKind kind = ForceEventKind::contact;
  double time_s = 0.0;
  double size = 0.0;  ///< of a drop: from its peak to its end, in the unit of force
};

struct ForceEventOptions {
  fitting::Jnd jnd;
  double contact = 0.0;     ///< |F| above which there is contact, until it is below half of it; 0: twice the
                            ///< threshold of the JND
  double window_s = 0.005;  ///< a drop falls by more than the JND at its peak, and noise, within so long
  std::optional<double> noise;  ///< standard deviation, where the force itself tells of less: noise_of()
};

/// Finds the events that a hand would date a cut by, from the size of a force alone, so that its sign does
/// not matter: contact and release (a threshold with hysteresis), and drops, as a rupture makes them. A drop
/// is dated by the first sample by which the fall exceeds the JND at its peak by as much as noise of the
/// force can make (eight standard deviations, noise_of()); it is over once less than half a
/// JND has been lost within the window. A quick release is a drop too. Values that are not finite are passed
/// over.
[[nodiscard]] std::vector<ForceEvent> find_force_events(std::span<const double> time_s,
                                                        std::span<const double> force,
                                                        const ForceEventOptions& options);

/// How the events of one kind agree.
struct EventMatch {
  std::size_t recorded = 0;
  std::size_t rendered = 0;
  std::vector<double> late_s;  ///< of each pair, rendered less recorded
  [[nodiscard]] double mean_s() const noexcept;
  [[nodiscard]] double worst_s() const noexcept;  ///< the largest difference, with its sign
};

/// Pairs the events of each kind one to one, the nearest first and never over more than `within_s`.
[[nodiscard]] std::array<EventMatch, 3> match_events(std::span<const ForceEvent> recorded,
                                                     std::span<const ForceEvent> rendered, double within_s);

}  // namespace kerf::bench
