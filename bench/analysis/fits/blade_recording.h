#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/fitting/blade.h>
#include <kerf/schema/recording.h>

#include "laws/law_file.h"

namespace kerf::bench {

/// A blade fitted to a recording: the result, and the law as it will be rendered.
struct BladeRecordingFit {
  fitting::BladeFit fit;
  LawFile file;
  std::size_t left_out = 0;       ///< rows that are not finite, or that the recording itself marks as faulty
  bool commanded = false;         ///< no force was measured: a rendered law was fitted
  std::vector<std::string> axes;  ///< of the law, in its order
  std::vector<std::string> warnings;
};

/// Fits the law `blade` to the axes x, y, z, rx, ry, rz of a recording; `options.law_options` has its shape.
/// The velocity of a device, which lags, is replaced by the zero-phase slope of its positions (a parabola
/// over 20 ms, at least five samples). An axis along which no force was measured is left out.
/// @throws std::invalid_argument for a recording without these axes, or as fitting::fit_blade() does.
[[nodiscard]] BladeRecordingFit fit_blade_recording(const schema::Recording& recording,
                                                    const fitting::BladeFitOptions& options);

/// The shape and the fidelity of a law file. @throws std::invalid_argument if it has another law.
[[nodiscard]] models::Options blade_shape_of(const LawFile& law, const std::string& name);

/// "exact", "paper" or "strips:N" as options of the law. @throws std::invalid_argument.
void set_blade_fidelity(models::Options& law_options, const std::string& fidelity);

/// The JSON of `kerf blade`.
[[nodiscard]] nlohmann::ordered_json blade_fit_as_json(const BladeRecordingFit& fit);

}  // namespace kerf::bench
