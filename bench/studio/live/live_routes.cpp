#include "live/live_routes.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "live/live_event.h"
#include "views/trace_view.h"

namespace kerf::bench {
namespace {

using Pace = Routes::Pace;

constexpr std::size_t max_sent_ticks = 100'000;  ///< in a column
constexpr std::size_t max_sent_columns = 10'000;
constexpr double latest_s = 1e7;
constexpr std::size_t longest_mark = 200;  ///< bytes: an event of a recording has room for 256

/// One viewer of the stream; sees nothing of the loop while a session runs.
class LiveViewer {
 public:
  LiveViewer(const LiveLoop& loop, std::function<bool()> is_closed, std::size_t ticks_per_column)
      : loop_(loop), is_closed_(std::move(is_closed)), cursor_{.ticks_per_column = ticks_per_column} {}

  [[nodiscard]] std::string next() {
    if (is_closed_()) {
      return is_status_due(cursor_) ? status_event(session_status_as_json(loop_.is_released()))
                                    : std::string();
    }
    return live_event(loop_, cursor_);
  }

 private:
  const LiveLoop& loop_;
  std::function<bool()> is_closed_;
  LiveCursor cursor_;
};

/// The answers, without who may ask for them.
class LiveAnswers {
 public:
  LiveAnswers(LiveLoop& loop, const LiveHooks& hooks) : loop_(loop), hooks_(hooks) {}

  [[nodiscard]] HttpResponse status() const {
    return json_response(hooks_.is_closed() ? session_status_as_json(loop_.is_released())
                                            : status_as_json(loop_.status()));
  }

  [[nodiscard]] HttpResponse traces() const {
    const LiveLoop::Watched watched = loop_.watched();
    return json_response(traces_as_json(watched.hub ? watched.history().traces() : std::vector<Trace>{}));
  }

  [[nodiscard]] HttpResponse stream(const HttpRequest& request) const {
    const std::size_t ticks = count_in_query(request, "ticks", max_sent_ticks);
    if (ticks == 0) throw RequestError(400, "parameter 'ticks' is 0: a column has at least one tick");
    const auto viewer = std::make_shared<LiveViewer>(loop_, hooks_.is_closed, ticks);
    return {.type = "text/event-stream", .body = viewer->next(), .more = [viewer] { return viewer->next(); }};
  }

  [[nodiscard]] HttpResponse view(const HttpRequest& request) const {
    const LiveLoop::Watched watched = loop_.watched();
    if (!watched.hub) throw RequestError(409, "No loop has run yet: there is nothing to show.");
    const RowHistory& history = watched.history();
    return bytes_response(
        bytes_of(history.view(counts_in_query(request, "traces", history.traces().size() - 1),
                              number_in_query(request, "from", -latest_s, latest_s),
                              number_in_query(request, "to", -latest_s, latest_s),
                              count_in_query(request, "columns", max_sent_columns))));
  }

  [[nodiscard]] HttpResponse start(const HttpRequest& request) const {
    const nlohmann::json body = json_in(request);
    if (loop_.status().is_running) throw RequestError(409, "The loop is running: stop it first.");
    LiveOptions options{.device_uri = hooks_.uri_of(text_or(body, "device", "")),
                        .sensor_uri = hooks_.uri_of(text_or(body, "sensor", "")),
                        .scene = {}};
    const std::string scene = text_or(body, "scene_id", "");
    if (!scene.empty()) options.scene = hooks_.scene_of(scene);
    loop_.start(options);
    if (hooks_.is_closed()) loop_.stop();  // the session began while the device was opened
    return status();
  }

  [[nodiscard]] HttpResponse stop() const {
    loop_.request_stop();
    return status();
  }

  [[nodiscard]] HttpResponse render(const HttpRequest& request) const {
    const nlohmann::json body = json_in(request);
    require_running();
    if (body.contains("law")) {
      const std::string id = text_in(body, "law");
      loop_.render(hooks_.law_of(id), hooks_.law_name_of ? hooks_.law_name_of(id) : id);
    } else if (body.contains("toml")) {
      const LawFile law = parse_law_file(text_in(body, "toml"), "the law");
      loop_.render(law, std::string(law.law.model()));
    } else {
      loop_.render_nothing();
    }
    return status();
  }

  [[nodiscard]] HttpResponse zero() const {
    loop_.release_force();
    return {.type = "application/json", .body = R"({"released":true})"};
  }

  [[nodiscard]] HttpResponse resume() const {
    loop_.resume();
    return status();
  }

  [[nodiscard]] HttpResponse confirm() const {
    loop_.confirm_position();
    return status();
  }

  [[nodiscard]] HttpResponse dismiss() const {
    loop_.dismiss_fault();
    return status();
  }

  [[nodiscard]] HttpResponse mark(const HttpRequest& request) const {
    const std::string text = text_in(json_in(request), "text");
    const auto steers = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
    if (text.empty() || text.size() > longest_mark || std::ranges::any_of(text, steers))
      throw RequestError(400, "a mark is one line of 1 to 200 bytes");
    require_running();
    loop_.mark(text);
    return status();
  }

  [[nodiscard]] HttpResponse record(const HttpRequest& request) const {
    const std::string name = text_in(json_in(request), "name");
    require_running();
    loop_.start_recording(hooks_.new_recording(name));
    return status();
  }

  [[nodiscard]] HttpResponse stop_recording() const {
    require_running();
    loop_.stop_recording();
    return status();
  }

  void require_open() const {
    if (hooks_.is_closed()) throw RequestError(409, "A session is running; nothing of the loop is shown.");
  }

 private:
  void require_running() const {
    if (!loop_.status().is_running) throw RequestError(409, "No loop is running: start it first.");
  }

  LiveLoop& loop_;
  LiveHooks hooks_;
};

}  // namespace

void add_live_routes(Routes& routes, LiveLoop& loop, const LiveHooks& hooks) {
  const auto answers = std::make_shared<LiveAnswers>(loop, hooks);
  const auto when_open = [answers](const auto& answer) -> Routes::Answer {
    return [answers, answer](const HttpRequest& request) {
      answers->require_open();
      return answer(request);
    };
  };
  const auto get = [&](const char* path, Pace pace, const auto& answer) {
    routes.get(path, pace, when_open(answer));
  };
  const auto post = [&](const char* path, Pace pace, const auto& answer) {
    routes.post(path, pace, when_open(answer));
  };
  using Request = const HttpRequest&;
  // Before all others: it depends on nothing and waits for nothing.
  routes.post("/api/live/zero", Pace::at_once, [answers](Request) { return answers->zero(); });
  routes.get("/api/live/status", Pace::at_once, [answers](Request) { return answers->status(); });
  get("/api/live/traces", Pace::at_once, [answers](Request) { return answers->traces(); });
  get("/api/live/stream", Pace::at_once, [answers](Request it) { return answers->stream(it); });
  get("/api/live/view", Pace::slow, [answers](Request it) { return answers->view(it); });
  // A device may wait for a person (homing) while it is opened: stopping must not stand in line behind that.
  post("/api/live/start", Pace::action, [answers](Request it) { return answers->start(it); });
  post("/api/live/stop", Pace::at_once, [answers](Request) { return answers->stop(); });
  post("/api/live/feel", Pace::action, [answers](Request it) { return answers->render(it); });
  post("/api/live/resume", Pace::at_once, [answers](Request) { return answers->resume(); });
  post("/api/live/confirm", Pace::at_once, [answers](Request) { return answers->confirm(); });
  post("/api/live/dismiss", Pace::at_once, [answers](Request) { return answers->dismiss(); });
  post("/api/live/mark", Pace::action, [answers](Request it) { return answers->mark(it); });
  post("/api/live/record", Pace::action, [answers](Request it) { return answers->record(it); });
  post("/api/live/record/stop", Pace::action, [answers](Request) { return answers->stop_recording(); });
}

}  // namespace kerf::bench
