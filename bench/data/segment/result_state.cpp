#include "segment/result_state.h"

#include <kerf/schema/recorded_rows.h>

#include "recordings/provenance.h"
#include "segment/cycle_edit.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

json text_or_null(const std::string& text) { return text.empty() ? json(nullptr) : json(text); }

/// Whether its cycles are those of the axis that a result is of.
bool has_cycles_along(const schema::Recording& about, const json& kept) {
  return about.cycles && kept.value("axis", std::string()) == about.axes[about.cycles->axis].name;
}

}  // namespace

KeptState kept_state(const schema::Recording& recording, std::size_t axis) {
  const bool along = recording.cycles && recording.cycles->axis == axis;
  return {.axis = recording.axes.at(axis).name,
          .content_sha256 = content_sha256_of(schema::RowsInMemory(recording)),
          .cycles_sha256 = along ? cycles_sha256_of(recording) : ""};
}

json as_json(const KeptState& kept) {
  return {{"axis", kept.axis},
          {"content_sha256", text_or_null(kept.content_sha256)},
          {"cycles_sha256", text_or_null(kept.cycles_sha256)}};
}

ResultState state_of(const json& kept, const schema::Recording& about, const std::string& content) {
  const auto samples = kept.find("content_sha256");
  const bool tells_samples = !content.empty() && samples != kept.end() && samples->is_string();
  if (tells_samples && samples->get<std::string>() != content) return ResultState::other_samples;
  const auto cycles = kept.find("cycles_sha256");
  if (cycles == kept.end()) return ResultState::unknown;  // of an earlier version
  if (cycles->is_null() && has_cycles_along(about, kept)) return ResultState::before_cycles;
  if (!cycles->is_string()) return tells_samples ? ResultState::current : ResultState::unknown;
  return cycles->get<std::string>() == cycles_sha256_of(about) ? ResultState::current
                                                               : ResultState::other_cycles;
}

}  // namespace kerf::bench
