#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/drivers/device_model.h>

#include "identify/axis_experiment.h"
#include "plot/plot.h"
#include "stability/findings.h"

namespace kerf::bench {

/// What the constant force along an axis is taken for. A friction that is stronger one way than the other and
/// gravity move the axis in the same way, so one of them has to be known.
enum class OffsetIs { gravity, friction, unknown };

/// One axis: what was done, and what came of it.
struct IdentifiedAxis {
  std::size_t axis = 0;
  AxisExperiment measured;
  std::optional<identification::Identified> found;
  std::optional<Findings> z_width;  ///< search_z_widths(); none: it was not asked for
  std::string
      problem;  ///< why nothing was found, or the experiment was not finished; empty: nothing is wrong
};

struct IdentifiedDevice {
  drivers::DeviceInfo device;
  OffsetIs offset = OffsetIs::gravity;
  bool held = false;
  std::vector<IdentifiedAxis> axes;

  /// Every axis was measured to its end, and its model fits.
  [[nodiscard]] bool is_good() const noexcept;
};

/// Estimates from what was measured of an axis; what cannot be told becomes its problem.
[[nodiscard]] IdentifiedAxis identified_axis(AxisExperiment measured, std::size_t axis);

[[nodiscard]] drivers::DeviceModel model_of(const IdentifiedDevice& identified);
[[nodiscard]] nlohmann::ordered_json identified_as_json(const IdentifiedDevice& identified);
/// For a terminal: each number with its interval, what fits and what does not.
[[nodiscard]] std::vector<std::string> identified_lines(const IdentifiedDevice& identified);
/// Of an axis of which something was found: its response over frequency with coherence, friction over speed,
/// and the Z-width where it was searched.
[[nodiscard]] std::vector<Figure> axis_figures(const IdentifiedDevice& identified, const IdentifiedAxis& of);
/// identify.json, identify.html, pictures, NAME.device.toml, and AXIS-z-width.csv of a Z-width. @throws
/// std::system_error
void write_identified(const IdentifiedDevice& identified, const std::string& name,
                      const std::filesystem::path& folder);

}  // namespace kerf::bench
