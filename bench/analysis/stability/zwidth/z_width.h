#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>

#include "files/progress.h"
#include "plot/plot.h"
#include "stability/device/sampled_device.h"
#include "stability/zwidth/wall_search.h"

namespace kerf::bench {

/// What was found on a device in the hand that held it: necessary for passivity, since a wall that has a
/// limit cycle in one hand is not passive; not sufficient, since every other hand would have to be tried.
struct ZWidth {
  drivers::DeviceInfo device;
  std::size_t axis = 0;
  double period_s = 0.0;
  WallSearchOptions options;  ///< with what was left to the axis
  std::vector<WallRung> ladder;
  std::uint64_t ticks = 0;
  std::uint64_t missed = 0;  ///< deadlines
  bool finished = false;     ///< false: it was stopped; what was found until then is kept
};

struct ZWidthOptions {
  WallSearchOptions search;
  std::string axis;  ///< empty: the first
  double rate_hz = 1000.0;
  ShowProgress progress = show_no_progress;
};

/// The axis of that name, the first where none is named. @throws std::invalid_argument if the device has
/// none, or it has no force.
[[nodiscard]] std::size_t axis_of(const drivers::DeviceInfo& device, const std::string& name);

/// Searches through the loop as `kerf run` has it, with its Safety; a simulated device in virtual time.
/// @throws drivers::DeviceError; std::invalid_argument for no such axis, and as check() of the search.
[[nodiscard]] ZWidth measure_z_width(const std::string& uri, const ZWidthOptions& options,
                                     const std::atomic<bool>& stop);
/// The same loop in virtual time on a device that is open: for simulated ones.
[[nodiscard]] ZWidth measure_z_width(drivers::Device& device, const ZWidthOptions& options,
                                     const std::atomic<bool>& stop);

/// A model of the axis with the hand on it, and by how much its numbers may be wrong: half of the interval of
/// 95 %, as a share of each; a delay's in seconds.
struct UncertainModel {
  SampledDevice device;
  double mass = 0.0;
  double viscous = 0.0;
  double coulomb = 0.0;
  double hand = 0.0;  ///< of its mass, damping and stiffness
  double delay_s = 0.0;
  [[nodiscard]] bool is_exact() const noexcept {
    return mass == 0.0 && viscous == 0.0 && coulomb == 0.0 && hand == 0.0 && delay_s == 0.0;
  }
};

/// What a model says of one damping.
struct ZWidthTheory {
  double damping_n_s_per_m = 0.0;
  double boundary = 0.0;  ///< of the model as it is: eigenvalues, or the same search on it (search_model())
  double passive = 0.0;   ///< passive_stiffness(), for any hand
  std::optional<Range>
      band;  ///< 95 % of the boundary over draws of the model's numbers; none of an exact model
};

/// The search on a model, without a loop around it: what a device that is the model comes to.
[[nodiscard]] std::vector<WallRung> search_model(const SampledDevice& device,
                                                 const WallSearchOptions& options);

/// Theory's curve over the ladder: of a linear model (no Coulomb friction, no encoder steps) the eigenvalues,
/// else search_model(). The band is of `draws` models with normal numbers, the same draws every time.
[[nodiscard]] std::vector<ZWidthTheory> z_width_theory(const UncertainModel& model,
                                                       const WallSearchOptions& options,
                                                       std::size_t draws = 40, std::size_t threads = 1);

}  // namespace kerf::bench
