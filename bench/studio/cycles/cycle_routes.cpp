#include "cycles/cycle_routes.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "cycles/cycle_view.h"
#include "files/disk_room.h"
#include "files/named_file.h"
#include "files/whole_file.h"
#include "recordings/axis_values.h"
#include "segment/result_state.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;
using Pace = Routes::Pace;

constexpr double farthest_time_s = 1e12;
constexpr std::uintmax_t largest_fit = std::uintmax_t{64} << 20U;

/// That what a page has of the cycles is not what is there, for whoever has to decide: 410 where it is of
/// another recording, whose cycles are none of these, else 409.
RequestError has_changed(const schema::Recording& about, const std::string& uuid) {
  if (!uuid.empty() && uuid != about.header.uuid)
    return {410,
            "Another recording has taken the place of this one since you began. Nothing is saved; what you "
            "changed stays in this tab."};
  const std::vector<ToldEdit> edits = edits_of(about);
  const std::string who = edits.empty() ? "They were found anew or prepared by a program"
                                        : fmt::format("{} saved at {}: {}", edits.back().author,
                                                      edits.back().time, edits.back().what);
  return {409,
          fmt::format("The cycles have changed since you began. {}. Nothing is saved; load them, and what "
                      "you changed is put on top.",
                      who)};
}

class CycleDesk {
 public:
  CycleDesk(Workspace& workspace, RecordingViews& views) : workspace_(workspace), views_(views) {}

  Json stored(const std::string& id) { return look(id, nlohmann::json::object()); }

  Json look(const std::string& id, const nlohmann::json& given) {
    const std::filesystem::path path = path_of(id);
    const auto recording = views_.opened(path);
    CycleQuestion question = cycle_question(given, recording->file().about());
    if (question.step && recording->file().rows() <= max_rows_mended)
      question.edit = with_step(recording->file(), std::move(question.edit), *question.step);
    Json json = cycle_view(*recording, path, question);
    json["author"] = usual_author();  // a page may say another
    json["uuid"] = recording->file().about().header.uuid;
    return json;
  }

  Json row_at(const std::string& id, double time_s) {
    const auto recording = views_.opened(path_of(id));
    const schema::RecordingFile& file = recording->file();
    if (file.rows() == 0) throw RequestError(400, "the recording has no rows");
    const BlockedValues times = axis_values(file, schema::Column::time);
    std::uint64_t low = 0;
    std::uint64_t high = file.rows() - 1;
    while (low < high) {
      const std::uint64_t middle = low + (high - low) / 2;
      if (times[middle] < time_s) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return {{"row", low}, {"time_s", times[low]}};
  }

  Json save(const nlohmann::json& given) {
    const std::string id = text_in(given, "recording");
    const std::string author = text_in(given, "author");
    check_author(author);
    const std::filesystem::path path = path_of(id);
    {
      const auto recording = views_.opened(path);
      const schema::RecordingFile& file = recording->file();
      if (cycles_version(file) != text_in(given, "version"))
        throw has_changed(file.about(), text_or(given, "uuid", ""));
      if (const std::string locked = why_not_mended(file, path); !locked.empty())
        throw RequestError(423, locked);
      const CycleQuestion question = cycle_question(given, file.about());
      keep(path, file, question, author);
    }
    return stored(id);
  }

  Json fit(const std::string& id, const std::string& fit_id) {
    const auto recording = views_.opened(path_of(id));
    const schema::Recording& about = recording->file().about();
    const WorkspaceEntry entry = workspace_.find(fit_id, FileKind::fit);
    const auto fit = Json::parse(read_named_file(entry.path, largest_fit), nullptr, false);
    Json unknown{{"earlier", nullptr}, {"why", ""}};
    if (!fit.is_object() || !fit.contains("recordings") || !fit["recordings"].is_array()) return unknown;
    for (const Json& one : fit["recordings"]) {
      if (!one.is_object() || one.value("uuid", "") != about.header.uuid) continue;
      const ResultState state = state_of(one, about);
      if (state == ResultState::unknown) return unknown;
      if (state == ResultState::before_cycles)
        return {{"earlier", true},
                {"why", "It is of a time before cycles were saved: of all rows. Fit again."}};
      if (state == ResultState::current) return {{"earlier", false}, {"why", ""}};
      const std::vector<ToldEdit> edits = edits_of(about);
      return {{"earlier", true},
              {"why", edits.empty() ? "It is of earlier cycles: they were found anew since. Fit again."
                                    : fmt::format("It is of earlier cycles: {} edited them at {}. Fit again.",
                                                  edits.back().author, edits.back().time)}};
    }
    return unknown;
  }

 private:
  [[nodiscard]] std::filesystem::path path_of(const std::string& id) {
    return workspace_.find(id, FileKind::recording).path;
  }

  static void keep(const std::filesystem::path& path, const schema::RecordingFile& file,
                   const CycleQuestion& question, const std::string& author) {
    const double felt = felt_along(file.about(), question.axis);
    const EditedCycles edited = edited_cycles(file, question.edit, felt);
    const schema::Recording about = with_edit(file, question.edit, edited, felt, author);
    require_change(path);
    std::error_code absent;
    const auto bytes = std::filesystem::file_size(path, absent);
    if (!absent) require_disk(path, bytes, "as many rows as there are");
    schema::write_recording(path, about, file, schema::Existing::replace);
  }

  Workspace& workspace_;
  RecordingViews& views_;
};

}  // namespace

void add_cycle_routes(Routes& routes, Workspace& workspace, RecordingViews& views) {
  const auto desk = std::make_shared<CycleDesk>(workspace, views);
  routes.get("/api/cycles", Pace::slow, [desk](const HttpRequest& request) {
    return json_response(desk->stored(text_in_query(request, "id")));
  });
  routes.get("/api/cycles/row", Pace::slow, [desk](const HttpRequest& request) {
    return json_response(desk->row_at(text_in_query(request, "id"),
                                      number_in_query(request, "time", -farthest_time_s, farthest_time_s)));
  });
  routes.get("/api/cycles/fit", Pace::slow, [desk](const HttpRequest& request) {
    return json_response(desk->fit(text_in_query(request, "id"), text_in_query(request, "fit")));
  });
  routes.post("/api/cycles/look", Pace::slow, [desk](const HttpRequest& request) {
    const nlohmann::json given = json_in(request);
    return json_response(desk->look(text_in(given, "recording"), given));
  });
  routes.post("/api/cycles/save", Pace::slow,
              [desk](const HttpRequest& request) { return json_response(desk->save(json_in(request))); });
}

}  // namespace kerf::bench
