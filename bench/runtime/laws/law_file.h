#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <kerf/models/law.h>
#include <kerf/schema/final_name.h>

namespace kerf::bench {

/// Where a law was fitted: what it says elsewhere, nobody has seen.
struct FittedRange {
  double least = 0.0;    ///< penetration [m or rad]
  double most = 0.0;     ///< penetration [m or rad]
  double fastest = 0.0;  ///< speed, >= 0 [m/s or rad/s]
};

/// How a law came about, kept in its file.
struct FitProvenance {
  std::string recording_uuid;
  std::string recording_sha256;   ///< of the file
  std::string recording_content;  ///< SHA-256 of what was sampled: content_sha256_of()
  double rmse_n = 0.0;
  std::string date;      ///< ISO 8601, UTC
  std::string software;  ///< kerf::software()
  std::optional<FittedRange>
      range{};  ///< not known: of laws written by hand, and in files of earlier versions
};

/// Says which file a law was fitted to, and which samples.
void name_recording(FitProvenance& fit, const std::filesystem::path& recording);

/// A law with everything that it takes to render it on an axis: `NAME.law.toml`.
struct LawFile {
  models::Law law;
  models::Contact contact;
  std::string axis;                 ///< name of the axis it was fitted on, for example "theta"
  std::string position_unit = "m";  ///< "m" or "rad"
  std::string force_unit = "N";
  std::vector<double> std_errors;  ///< one a parameter, or empty
  FitProvenance fit;               ///< empty strings if it was written by hand
  std::string name{};              ///< of the file, for messages; empty if it was not read from one
};

/// Reads a law file; of a plug-in, NAME.so, its law with its initial parameters (plugin_laws.h). Parameters
/// may be given in any unit of the same kind ("N/mm", "N/deg").
/// @throws std::invalid_argument with file, line, what was found and what was expected: an unknown key, a
///         missing unit, a unit of another kind, a parameter out of its bounds; with the version that wrote
///         the file, as its first line names it, if that is later than this one.
/// @throws std::system_error if it cannot be read.
[[nodiscard]] LawFile read_law_file(const std::filesystem::path& file);

/// Writes a law file under a comment that names the program, whole or not at all. @throws std::system_error.
void write_law_file(const std::filesystem::path& file, const LawFile& law,
                    schema::Existing existing = schema::Existing::replace);

/// A law file as TOML text, and back; `name` stands for the file in messages.
[[nodiscard]] std::string to_toml(const LawFile& law);
[[nodiscard]] LawFile parse_law_file(const std::string& text, const std::string& name);

}  // namespace kerf::bench
