#pragma once

#include <atomic>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>

#include "stability/controllers/controller_design.h"
#include "stability/controllers/transparency.h"
#include "stability/zwidth/z_width.h"

namespace kerf::bench {

struct ControllersOptions {
  ZWidthOptions z_width;
  TransparencyOptions transparency;
  /// Of the wall whose transparency is measured, with the first damping of the ladder; 0: half of the
  /// smallest boundary of all controllers, which all of them hold.
  double wall_n_per_m = 0.0;
};

/// What a linear controller comes to on the model without Coulomb friction and encoder steps.
struct ControllerTheory {
  std::vector<double> boundary_n_per_m;  ///< of each damping of the ladder, in the model's hand: eigenvalues
  std::vector<double> passive_n_per_m;   ///< in any hand; up to the end of the search
  std::vector<std::complex<double>> loop;  ///< impedance at each line of the transparency
};

/// One controller on a device.
struct ComparedController {
  ControllerDesign design;
  ZWidth z_width;
  std::optional<Transparency> transparency;  ///< none where it does not hold that wall
  std::string without;                       ///< why there is none
  std::optional<ControllerTheory> theory;    ///< of a linear one
  double tick_ns = 0.0;                      ///< median time of its step
};

struct ComparedControllers {
  drivers::DeviceInfo device;
  std::size_t axis = 0;
  SampledDevice model;
  Wall wall;  ///< whose transparency was measured; of no stiffness if none was
  std::vector<ComparedController> controllers;
  std::vector<std::string> left_out;  ///< controllers that the device admits none of, and why
  bool finished = false;
};

/// A device that is opened anew for each controller: of one that is simulated each begins the same.
/// @throws drivers::DeviceError; std::invalid_argument as measure_z_width() and design_controller().
[[nodiscard]] ComparedControllers compare_controllers(const std::string& uri, const SampledDevice& model,
                                                      const ControllersOptions& options,
                                                      const std::atomic<bool>& stop);

/// A wall's transparency on a device, through the loop as `kerf run` has it.
/// @throws as measure_z_width(), and if a sensor at the hand is asked for and none tells anything.
[[nodiscard]] Transparency measure_transparency(const std::string& uri, const ControllerDesign& design,
                                                const Wall& wall, const ControllersOptions& options,
                                                const std::atomic<bool>& stop);

}  // namespace kerf::bench
