#include "editor/editor_routes.h"

#include <cmath>
#include <list>
#include <memory>
#include <utility>

#include "editor/editor_json.h"
#include "editor/segment_editor.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;

/// A curve, and the state of the file that it was made from.
struct KeptCurve {
  WorkspaceEntry file;
  std::size_t axis = 0;
  EditorCurve curve;
  CurveSource source;
};

/// The curves of the last few recordings that were edited; for the one thread of the slow answers.
class KeptCurves {
 public:
  explicit KeptCurves(Workspace& workspace) : workspace_(workspace) {}

  const KeptCurve& of(const std::string& id, std::size_t axis) {
    WorkspaceEntry file = workspace_.find(id, FileKind::recording);
    file.modified = std::filesystem::last_write_time(file.path);  // not that of the last scan
    const auto kept = std::find_if(curves_.begin(), curves_.end(),
                                   [&](const KeptCurve& it) { return it.file.id == id && it.axis == axis; });
    if (kept != curves_.end() && kept->file.modified == file.modified) {
      curves_.splice(curves_.begin(), curves_, kept);
      return curves_.front();
    }
    if (kept != curves_.end()) curves_.erase(kept);
    const schema::Recording recording = schema::read_recording(file.path);
    EditorCurve curve = editor_curve(recording, axis);
    CurveSource source = curve_source(recording, axis, curve);
    curves_.push_front({.file = file, .axis = axis, .curve = std::move(curve), .source = std::move(source)});
    constexpr std::size_t most = 4;
    if (curves_.size() > most) curves_.pop_back();
    return curves_.front();
  }
  const KeptCurve& of(const nlohmann::json& asked) {
    const double axis = number_in(asked, "axis", 0.0, schema::max_axes - 1);
    return of(text_in(asked, "recording"), static_cast<std::size_t>(axis));
  }

 private:
  Workspace& workspace_;
  std::list<KeptCurve> curves_;  ///< the last one used first
};

HttpResponse knots_with_error(const KeptCurve& kept, const Knots& knots) {
  return json_response(
      {{"knots", knots_as_json(knots)}, {"error", law_error_as_json(law_error(kept.curve, knots))}});
}

HttpResponse existing_law(Workspace& workspace, const std::string& id) {
  const LawFile file = read_law_file(workspace.find(id, FileKind::law).path);
  Json json = knots_as_json(knots_of(file));
  json["contact_position"] = file.contact.position;
  json["closing_direction"] = file.contact.direction;
  json["position_unit"] = file.position_unit;
  json["force_unit"] = file.force_unit;
  return json_response(json);
}

HttpResponse saved(Workspace& workspace, const KeptCurve& kept, const nlohmann::json& asked) {
  const Knots knots = knots_in(asked, "knots");
  const bool replace = flag_in(asked, "replace", false);
  const auto path = workspace.new_file(text_in(asked, "name"), ".law.toml", replace);
  CurveSource source = kept.source;
  FitProvenance named;
  name_recording(named, kept.file.path);
  source.recording_sha256 = std::move(named.recording_sha256);
  source.recording_content = std::move(named.recording_content);
  write_law_file(path, drawn_law(kept.curve, knots, source), schema::existing_if(replace));
  return json_response({{"id", workspace.id_of(path)},
                        {"name", path.filename().string()},
                        {"error", law_error_as_json(law_error(kept.curve, knots))}});
}

}  // namespace

void add_editor_routes(Routes& routes, Workspace& workspace, std::function<void(const LawFile&)> render) {
  const auto curves = std::make_shared<KeptCurves>(workspace);
  constexpr auto slow = Routes::Pace::slow;
  routes.get("/api/editor/curve", slow, [curves](const HttpRequest& request) {
    const std::string id = text_in_query(request, "id");
    return json_response(
        curve_as_json(curves->of(id, count_in_query(request, "axis", schema::max_axes - 1)).curve, id));
  });
  routes.get("/api/editor/law", slow, [&workspace](const HttpRequest& request) {
    return existing_law(workspace, text_in_query(request, "id"));
  });
  routes.post("/api/editor/error", slow, [curves](const HttpRequest& request) {
    const nlohmann::json asked = json_in(request);
    return json_response(law_error_as_json(law_error(curves->of(asked).curve, knots_in(asked, "knots"))));
  });
  routes.post("/api/editor/best", slow, [curves](const HttpRequest& request) {
    const nlohmann::json asked = json_in(request);
    constexpr double max_segments = 16.0;
    const auto segments = static_cast<std::size_t>(number_in(asked, "segments", 1.0, max_segments));
    const bool loop = flag_in(asked, "loop", false);
    const KeptCurve& kept = curves->of(asked);
    return knots_with_error(kept, best_knots(kept.curve, segments, loop));
  });
  routes.post("/api/editor/forces", slow, [curves](const HttpRequest& request) {
    const nlohmann::json asked = json_in(request);
    const KeptCurve& kept = curves->of(asked);
    return knots_with_error(kept, best_forces(kept.curve, knots_in(asked, "knots")));
  });
  routes.post("/api/editor/save", slow, [curves, &workspace](const HttpRequest& request) {
    const nlohmann::json asked = json_in(request);
    return saved(workspace, curves->of(asked), asked);
  });
  routes.post("/api/editor/feel", slow, [curves, render = std::move(render)](const HttpRequest& request) {
    const nlohmann::json asked = json_in(request);
    const KeptCurve& kept = curves->of(asked);
    const LawFile law = drawn_law(kept.curve, knots_in(asked, "knots"), kept.source);
    if (!render) throw RequestError(409, "no loop is running to feel the law on");
    render(law);
    return json_response(Json::object());
  });
}

}  // namespace kerf::bench
