#include "studio/studio.h"

#include <optional>
#include <string_view>

#include "studio/jobs.h"
#include "studio/result_routes.h"
#include "studio/session_host.h"
#include "studio/session_routes.h"
#include "studio/studio_page.h"
#include "studio/workspace.h"
#include "studio/workspace_routes.h"
#include "web/gate.h"
#include "web/http_server.h"
#include "web/routes.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_body = 1 << 20;
constexpr std::string_view subject_folder = "/subject";

}  // namespace

class Studio::State {
 public:
  explicit State(const StudioOptions& options)
      : workspace_(options.folder),
        server_({.address = options.address, .port = options.port, .most_body = most_body}),
        gate_(server_.hosts()),
        sessions_(server_.hosts(), [this] { server_.wake(); }) {
    routes_.on_ready([this] { server_.wake(); });
    add_workspace_routes(routes_, workspace_, options.device_uri);
    add_result_routes(routes_, workspace_, jobs_);
    add_session_routes(routes_, workspace_, sessions_, options.key_file, [] {});
    server_.start([this](const HttpRequest& request, bool overdue) { return respond(request, overdue); });
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { server_.stop(); }

  [[nodiscard]] std::string url() const { return gate_.url("/"); }
  [[nodiscard]] bool is_loopback() const noexcept { return server_.is_loopback(); }

 private:
  std::optional<HttpResponse> respond(const HttpRequest& request, bool overdue) {
    if (request.path.starts_with(subject_folder) && request.path.substr(subject_folder.size(), 1) == "/") {
      HttpRequest below = request;
      below.path.erase(0, subject_folder.size());
      return sessions_.respond(below, overdue);
    }
    if (!gate_.admits(request)) {
      return HttpResponse{.status = 403,
                          .body = "This address is not valid. Open the one that kerf studio shows.\n"};
    }
    if (request.path.starts_with("/api/")) return routes_.respond(request, overdue);
    if (request.method != "GET") return refusal(405);
    return page_file(studio_page(), request.path, gate_.token());
  }

  // In the order in which they may go, the last one first, once the server has stopped.
  Workspace workspace_;
  Jobs jobs_;
  HttpServer server_;
  Gate gate_;
  SessionHost sessions_;
  Routes routes_;
};

Studio::Studio(const StudioOptions& options) : state_(std::make_unique<State>(options)) {}
Studio::~Studio() = default;
std::string Studio::url() const { return state_->url(); }
bool Studio::is_loopback() const noexcept { return state_->is_loopback(); }

}  // namespace kerf::bench
