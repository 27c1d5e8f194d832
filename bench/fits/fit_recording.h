#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/fitting/fit.h>
#include <kerf/schema/recording.h>

#include "laws/law_file.h"
#include "laws/render.h"

namespace kerf::bench {

struct FitRecordingOptions {
  std::vector<std::string> models;  ///< empty: the four that fit any axis
  std::size_t axis = 0;
  std::optional<models::Contact> contact;  ///< by default contact_of() the recording
  std::size_t segments = 5;                ///< of the piecewise law
  fitting::FitOptions fit;
};

/// One law fitted to a recording: the result, and the law as it will be rendered.
struct FittedLaw {
  fitting::FitResult result;
  LawFile file;                ///< with the rendering aids of laws that have branches
  double rmse_rendered = 0.0;  ///< error with those aids on [N]
};

/// All laws fitted to one recording.
struct RecordingFit {
  std::string uuid;
  std::size_t samples = 0;
  std::size_t left_out = 0;  ///< rows that are not finite
  double line_rmse_n = 0.0;  ///< of a straight line of force over penetration
  std::vector<FittedLaw> laws;
  fitting::Choice choice;
  std::vector<std::string> warnings;
};

/// Fits laws to an axis of a recording. The velocity of a device, which lags, is replaced by the zero-phase
/// slope of its positions (a parabola over 20 ms, at least five samples). A law that cannot be fitted is told
/// of in the warnings.
/// @throws std::invalid_argument for an unknown law, or a recording without force.
[[nodiscard]] RecordingFit fit_recording(const schema::Recording& recording,
                                         const FitRecordingOptions& options);

/// The laws that are asked for: those named, or every one of the registry.
[[nodiscard]] std::vector<std::string> models_of(const FitRecordingOptions& options);

/// @throws std::invalid_argument if any file that write_fits() would write stands in the folder.
void refuse_to_replace_fits(const FitRecordingOptions& options, const std::filesystem::path& folder);

/// Adds the recording's checksum to the law files and writes NAME.law.toml, fit.json and fit.csv into a
/// folder.
/// @throws std::system_error
void write_fits(RecordingFit& fit, const std::filesystem::path& recording,
                const std::filesystem::path& folder);

/// The JSON of `kerf fit`.
[[nodiscard]] nlohmann::ordered_json fits_as_json(const RecordingFit& fit);

}  // namespace kerf::bench
