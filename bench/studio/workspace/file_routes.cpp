#include "workspace/file_routes.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include <kerf/schema/final_name.h>
#include <kerf/schema/recording.h>

#include "recordings/provenance.h"
#include "workspace/trash.h"

namespace kerf::bench {
namespace {

constexpr std::size_t longest_note = 256;                               ///< bytes, as events have them
constexpr std::uintmax_t largest_annotated = std::uintmax_t{2} << 30U;  ///< it is written anew, from memory

struct NamedKind {
  std::string_view name;
  FileKind kind;
  std::string_view ending;
};
constexpr std::array changeable{NamedKind{"recording", FileKind::recording, ".h5"},
                                NamedKind{"law", FileKind::law, ".law.toml"}};

struct ChangedFile {
  WorkspaceEntry entry;
  std::string_view ending;
};

/// @throws RequestError where it is none that a page may change.
ChangedFile file_in(const nlohmann::json& given, Workspace& workspace) {
  const std::string wanted = text_in(given, "kind");
  const auto kind = std::ranges::find(changeable, std::string_view(wanted), &NamedKind::name);
  if (kind == changeable.end()) throw RequestError(400, "'kind' is recording or law");
  WorkspaceEntry entry = workspace.find(text_in(given, "id"), kind->kind);
  if (!entry.name.ends_with(kind->ending))
    throw RequestError(409, fmt::format("{} is not closed: it is being written, or was left by a crash; then "
                                        "'kerf repair' closes it",
                                        entry.name));
  return {.entry = std::move(entry), .ending = kind->ending};
}

HttpResponse rename_file(const HttpRequest& request, Workspace& workspace) {
  const nlohmann::json given = json_in(request);
  const ChangedFile file = file_in(given, workspace);
  // In the folder where it is; the workspace says what a name is.
  const auto name = workspace.new_file(text_in(given, "name"), file.ending, true).filename();
  const auto target = file.entry.path.parent_path() / name;
  std::error_code error;
  if (std::filesystem::exists(std::filesystem::symlink_status(target, error)))
    throw RequestError(409, fmt::format("{} is there already; choose another name", name.string()));
  schema::take_name(file.entry.path, target, schema::Existing::keep);
  (void)workspace.scan();
  return json_response({{"id", workspace.id_of(target)}});
}

HttpResponse annotate_file(const HttpRequest& request, Workspace& workspace) {
  nlohmann::json given = json_in(request);
  given["kind"] = "recording";
  const WorkspaceEntry entry = file_in(given, workspace).entry;
  const std::string text = text_in(given, "text");
  const auto steers = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (text.empty() || text.size() > longest_note || std::ranges::any_of(text, steers))
    throw RequestError(400, fmt::format("a note is one line of 1 to {} bytes", longest_note));
  if (entry.bytes > largest_annotated)
    throw RequestError(413, fmt::format("{} is larger than {} GB: a note would be written from memory",
                                        entry.name, largest_annotated >> 30U));
  schema::Recording recording = schema::read_recording(entry.path);
  if (given.contains("time_s")) {
    const double time_s = number_in(given, "time_s", -1e9, 1e9);
    schema::Event event{.time_s = time_s, .kind = "note", .text = text};
    recording.events.insert(std::ranges::upper_bound(recording.events, time_s, {}, &schema::Event::time_s),
                            std::move(event));
    add_history(recording.header, fmt::format("studio: note at {:.6g} s: {}", time_s, text));
  } else {
    add_history(recording.header, fmt::format("studio: note: {}", text));
  }
  schema::write_recording(entry.path, recording, schema::Existing::replace);
  return json_response(nlohmann::ordered_json::object());
}

HttpResponse trash_list(const Trash& trash) {
  auto list = nlohmann::ordered_json::array();
  for (const TrashedFile& file : trash.list())
    list.push_back({{"key", file.key}, {"name", file.name}, {"time", file.time}, {"bytes", file.bytes}});
  return json_response(list);
}

}  // namespace

void add_file_routes(Routes& routes, Workspace& workspace) {
  const auto trash = std::make_shared<Trash>(workspace);
  const auto post = [&](const char* path, auto answer) {
    routes.post(path, Routes::Pace::slow, [&workspace, trash, answer](const HttpRequest& request) {
      return answer(request, workspace, *trash);
    });
  };
  using Request = const HttpRequest&;
  post("/api/files/delete", [](Request it, Workspace& folder, Trash& to) {
    return json_response({{"key", to.take(file_in(json_in(it), folder).entry)}});
  });
  post("/api/files/rename", [](Request it, Workspace& folder, Trash&) { return rename_file(it, folder); });
  post("/api/files/annotate",
       [](Request it, Workspace& folder, Trash&) { return annotate_file(it, folder); });
  post("/api/trash/restore", [](Request it, Workspace&, Trash& from) {
    from.restore(text_in(json_in(it), "key"));
    return json_response(nlohmann::ordered_json::object());
  });
  post("/api/trash/empty", [](Request, Workspace&, Trash& it) {
    it.empty();
    return json_response(nlohmann::ordered_json::object());
  });
  routes.get("/api/trash", Routes::Pace::slow, [trash](Request) { return trash_list(*trash); });
}

}  // namespace kerf::bench
