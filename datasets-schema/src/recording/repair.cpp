#include <stdexcept>

#include <kerf/schema/live_recording.h>
#include <kerf/schema/recorded_rows.h>
#include <kerf/schema/recording_file.h>
#include <kerf/schema/repair.h>

#include "hdf5/files.h"

namespace kerf::schema {
namespace {

constexpr auto status_of_repaired = "aborted: the program that recorded it ended without closing it";

}  // namespace

Repaired repair(const std::filesystem::path& name, const RepairOptions& options) {
  const Place place = find_recording(name);
  if (place.being_written) {
    throw std::invalid_argument(place.file.string() + ": is still being recorded; stop that program first");
  }
  const RecordingFile rows(place.file);
  Recording recording = rows.about();
  if (recording.header.status != "recording") {
    throw std::invalid_argument(place.file.string() + ": was closed, its status is '" +
                                recording.header.status + "'; there is nothing to repair");
  }
  auto output = options.output;
  if (output.empty()) {
    output = place.file;
    if (place.partial) output.replace_extension();
  }
  const bool in_place = output == place.file;
  if (!in_place && !options.replace && std::filesystem::exists(output)) {
    throw std::invalid_argument(output.string() + ": exists already; give another name with -o, or --force");
  }
  const double end_s = rows.rows() == 0 ? 0.0 : rows.last_time_s();
  recording.header.status = status_of_repaired;
  recording.events.push_back(
      {.time_s = end_s, .kind = "repair", .text = "closed by kerf repair; the last rows may be missing"});
  write_recording(output, recording, rows, existing_if(in_place || options.replace));
  synchronise(output);
  synchronise(folder_of(output));
  if (place.partial && options.output.empty()) std::filesystem::remove(place.file);
  return {.file = output, .rows = rows.rows(), .duration_s = end_s};
}

}  // namespace kerf::schema
