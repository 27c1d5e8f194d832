#include "server/studio.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "cycles/cycle_routes.h"
#include "editor/editor_routes.h"
#include "http/http_server.h"
#include "http/routes.h"
#include "intake/intake_routes.h"
#include "jobs/job_routes.h"
#include "jobs/jobs.h"
#include "laws/law_file.h"
#include "live/live_loop.h"
#include "live/live_routes.h"
#include "pages/access_control.h"
#include "protocols/protocol_routes.h"
#include "results/result_routes.h"
#include "scene/scene.h"
#include "server/session_host.h"
#include "server/session_routes.h"
#include "server/studio_page.h"
#include "studies/study_routes.h"
#include "sweeps/sweep_routes.h"
#include "verbs/verb_routes.h"
#include "views/recording_routes.h"
#include "views/recording_views.h"
#include "workspace/file_routes.h"
#include "workspace/page_uri.h"
#include "workspace/workspace.h"
#include "workspace/workspace_routes.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_body = 1 << 20;
constexpr std::string_view subject_folder = "/subject";

/// Of a job, which works in another folder.
std::filesystem::path absolute_or_none(const std::filesystem::path& file) {
  return file.empty() ? file : std::filesystem::absolute(file);
}

}  // namespace

class Studio::State {
 public:
  explicit State(const StudioOptions& options)
      : workspace_(options.folder),
        own_device_(options.device_uri),
        server_({.address = options.address, .port = options.port, .max_body = max_body}),
        access_(server_.hosts()),
        sessions_(
            server_.hosts(), [this] { server_.wake(); },
            [this](const std::string& fault) { loop_.tell_fault(fault); }),
        jobs_(state_folder_of(workspace_.folder()) / "jobs") {
    routes_.on_ready([this] { server_.wake(); });
    loop_.on_rows([this] { server_.wake(); });
    add_workspace_routes(routes_, workspace_, options.device_uri);
    routes_.post("/api/key", Routes::Pace::at_once, [this](const HttpRequest& request) {
      const nlohmann::json given = json_in(request);
      const nlohmann::json texts = given.value("query", nlohmann::json());
      if (!texts.is_object()) throw RequestError(400, "'query' has to be an object of texts");
      std::map<std::string, std::string> query;
      for (const auto& [name, value] : texts.items()) query[name] = text_in(texts, name);
      return json_response({{"key", access_.key_for(text_in(given, "path"), query)}});
    });
    add_file_routes(routes_, workspace_);
    add_live_routes(routes_, loop_, live_hooks());
    add_recording_routes(routes_, views_,
                         [this](const std::string& id) { return path_of(id, FileKind::recording); });
    add_cycle_routes(routes_, workspace_, views_);
    add_intake_routes(routes_, workspace_, jobs_, std::filesystem::read_symlink("/proc/self/exe"));
    add_editor_routes(routes_, workspace_, [this](const LawFile& law) { render(law); });
    add_result_routes(routes_, workspace_, jobs_);
    add_job_routes(routes_, jobs_);
    add_verb_routes(routes_, workspace_, jobs_,
                    {.program = options.program,
                     .forms = options.verbs,
                     .key_file = absolute_or_none(options.key_file),
                     .check = options.check_words});
    add_study_routes(routes_, workspace_);
    add_sweep_routes(routes_, workspace_, options.swept);
    add_protocol_routes(routes_, workspace_);
    add_session_routes(routes_, workspace_, sessions_,
                       {.key_file = options.key_file,
                        .uri_of = [this](const std::string& uri) { return uri_of(uri); },
                        .prepare = [this] { leave_the_device(); }});
    server_.start([this](const HttpRequest& request, bool overdue) { return respond(request, overdue); });
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  /// The hand is let go first: nobody can ask for it once the server has stopped, and a job may take its
  /// time.
  ~State() {
    loop_.close();
    sessions_.close();
    jobs_.close();
    server_.stop();
  }

  [[nodiscard]] std::string url() const { return access_.url("/"); }
  [[nodiscard]] bool is_loopback() const noexcept { return server_.is_loopback(); }

 private:
  [[nodiscard]] std::filesystem::path path_of(const std::string& id, FileKind kind) {
    return workspace_.find(id, kind).path;
  }

  /// Whoever has started the studio may name any file.
  [[nodiscard]] std::string uri_of(const std::string& uri) const {
    return uri == own_device_ ? uri : uri_from_page(workspace_, uri);
  }

  [[nodiscard]] LiveHooks live_hooks() {
    return {.uri_of = [this](const std::string& uri) { return uri_of(uri); },
            .law_of = [this](const std::string& id) { return read_law_file(path_of(id, FileKind::law)); },
            .law_name_of = [this](const std::string& id) { return workspace_.find(id, FileKind::law).name; },
            .scene_of = [this](const std::string& id) { return read_scene(path_of(id, FileKind::scene)); },
            .new_recording = [this](const std::string& name) { return workspace_.new_file(name, ".h5"); },
            .is_closed = [this] { return sessions_.is_running(); }};
  }

  /// To a session, which knows nothing of a force that was released here.
  void leave_the_device() {
    if (loop_.status().is_released)
      throw RequestError(409, "Zero force is held: let the force back first, in the bar.");
    loop_.stop();
    loop_.dismiss_fault();
  }

  /// A drawn law, which has no name yet.
  void render(const LawFile& law) {
    if (sessions_.is_running()) throw RequestError(409, "A session is running.");
    if (!loop_.status().is_running) throw RequestError(409, "No loop is running: start it on the scope.");
    loop_.render(law, "a drawn law");
  }

  std::optional<HttpResponse> respond(const HttpRequest& request, bool overdue) {
    if (request.path.starts_with(subject_folder) && request.path.substr(subject_folder.size(), 1) == "/") {
      HttpRequest below = request;
      below.path.erase(0, subject_folder.size());
      return sessions_.respond(below, overdue);
    }
    const bool asks_for_zero_force = request.path == "/api/live/zero" && request.method == "POST";
    if (!(asks_for_zero_force && server_.is_loopback() ? access_.admits_without_token(request)
                                                       : access_.admits(request))) {
      return access_.refuse("This address is not valid. Open the one that kerf studio shows.");
    }
    // Whoever asks for zero force has a reason: it ends a session too, which can be gone on with.
    if (asks_for_zero_force) {
      loop_.release_force();  // first, so that a session which is just being begun finds it
      sessions_.stop();
    }
    if (request.path.starts_with("/api/")) return routes_.respond(request, overdue);
    if (request.method != "GET") return refusal(405);
    return page_file(studio_page(), request.path, access_.token());
  }

  // In the order in which they may go, the last one first, once the server has stopped.
  Workspace workspace_;
  const std::string own_device_;
  HttpServer server_;
  AccessControl access_;
  RecordingViews views_;
  LiveLoop loop_;
  SessionHost sessions_;
  Jobs jobs_;
  Routes routes_;
};

Studio::Studio(const StudioOptions& options) : state_(std::make_unique<State>(options)) {}
Studio::~Studio() = default;
std::string Studio::url() const { return state_->url(); }
bool Studio::is_loopback() const noexcept { return state_->is_loopback(); }

}  // namespace kerf::bench
