#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

#include <kerf/schema/final_name.h>

#include "convert/recording_columns.h"

namespace kerf::bench {

/// Where a format writes to, and what it counts up by the rows that it is through with.
struct ConversionTarget {
  std::filesystem::path file;
  schema::Existing existing = schema::Existing::keep;
  std::atomic<std::size_t>* rows_done = nullptr;
};

// One function a format, each in convert_FORMAT.cpp.
// @throws as convert().
void convert_to_csv(const RecordingColumns& recording, const ConversionTarget& target);
void convert_to_mat(const RecordingColumns& recording, const ConversionTarget& target);
void convert_to_mcap(const RecordingColumns& recording, const ConversionTarget& target);

/// What a recording says of itself, in words, by name: status, uuid, device, ... What it does not say is left
/// out.
[[nodiscard]] std::map<std::string, std::string> facts_of(const schema::Recording& about);

/// Beside R.csv: R.dictionary.csv, and R.events.csv of a recording with events.
[[nodiscard]] std::filesystem::path dictionary_beside(std::filesystem::path csv);
[[nodiscard]] std::filesystem::path events_beside(std::filesystem::path csv);

}  // namespace kerf::bench
