#pragma once

#include <filesystem>
#include <future>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "fits/fit_recording.h"

namespace kerf::bench {

/// @throws std::invalid_argument if any file that write_fits() may write stands in the folder.
void refuse_to_replace_fits(const FitRecordingOptions& options, const std::filesystem::path& folder);

/// The checksums of recordings, found on another thread meanwhile: it hashes what the files are, not what was
/// read of them. @throws by get(), as name_recording().
[[nodiscard]] std::future<std::vector<FitProvenance>> name_meanwhile(
    std::vector<std::filesystem::path> recordings);

/// Adds the recordings' checksums to the law files and writes NAME.law.toml (NAME.RECORDING.law.toml for a
/// further recording with parameters or a contact of its own), fit.json and fit.csv into a folder. `named`
/// are the recordings', in order.
/// @throws std::system_error
void write_fits(RecordingFit& fit, std::span<const FitProvenance> named, const std::filesystem::path& folder);
void write_fits(RecordingFit& fit, const std::filesystem::path& file, const std::filesystem::path& folder);

/// The JSON of `kerf fit`.
[[nodiscard]] nlohmann::ordered_json fits_as_json(const RecordingFit& fit);

/// What is possible at all on a recording, as fit.json and choose.json say it.
[[nodiscard]] nlohmann::ordered_json floor_as_json(const fitting::Floor& floor);

/// Whether the law that a fit.json chooses stays within the JND on data that were held out; none where no law
/// is chosen or nothing was held out. Also of files that do not say so themselves.
[[nodiscard]] std::optional<bool> choice_within_jnd(const nlohmann::ordered_json& fits);

/// What the JSON and the tables call an interval: "ci95" for a confidence of 0.95.
[[nodiscard]] std::string interval_name(double confidence);

/// The law files of a fitted law, in the order of the recordings.
[[nodiscard]] std::vector<std::string> law_file_names(const RecordingFit& fit, const FittedLaw& law);

}  // namespace kerf::bench
