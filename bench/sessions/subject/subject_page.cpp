#include "subject/subject_page.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "subject/session_page.h"
#include "subject/subject_rules.h"
#include "subject/subject_words.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_actions = 16;  // that wait to be taken

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string json_of(const SubjectView& view, std::uint64_t number, double wait_s) {
  const nlohmann::json json{
      {"number", number},
      {"stage", name_of(view.stage)},
      {"study", view.study},
      {"heading", heading(view)},
      {"text", text_below(view)},
      {"progress", progress(view)},
      {"plays", what_plays(view)},
      {"labels", view.labels},
      {"answers", std::min(view.answers, view.labels.size())},
      {"playing", view.playing ? nlohmann::json(*view.playing) : nlohmann::json(nullptr)},
      {"may_switch", view.may_switch},
      {"may_answer", view.may_answer},
      {"may_go_on", view.may_go_on},
      {"trial", view.trial},
      {"wait_s", wait_s},
      {"notice", view.notice}};
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

struct PageAction {
  SubjectAction action;
  std::string stage;
  std::size_t trial = 0;
};

std::optional<PageAction> read_action(const std::string& body) {
  using Action = SubjectAction::Kind;
  constexpr std::array<std::pair<std::string_view, Action>, 5> kinds{{{"go_on", Action::go_on},
                                                                      {"decline", Action::decline},
                                                                      {"play", Action::play},
                                                                      {"answer", Action::answer},
                                                                      {"quit", Action::quit}}};
  const nlohmann::json json = nlohmann::json::parse(body, nullptr, false);
  const auto has = [&](const char* key, auto is) { return json.contains(key) && (json[key].*is)(); };
  if (!json.is_object() || !has("kind", &nlohmann::json::is_string) ||
      !has("stage", &nlohmann::json::is_string) || !has("slot", &nlohmann::json::is_number_unsigned) ||
      !has("trial", &nlohmann::json::is_number_unsigned)) {
    return std::nullopt;
  }
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const auto& it) {
    return it.first == json["kind"].get<std::string>();
  });
  if (found == kinds.end()) return std::nullopt;
  return PageAction{.action = {.kind = found->second, .slot = json["slot"].get<std::size_t>()},
                    .stage = json["stage"].get<std::string>(),
                    .trial = json["trial"].get<std::size_t>()};
}

HttpResponse as_json(int status, std::string body) {
  return {.status = status, .type = "application/json", .body = std::move(body)};
}

HttpResponse refused(int status, std::string_view why) {
  return as_json(status, nlohmann::json{{"error", why}}.dump());
}

}  // namespace

PageSubject::PageSubject(AccessControl access, std::function<void()> wake)
    : access_(std::move(access)), wake_(std::move(wake)) {}

std::optional<SessionStage> PageSubject::stage() {
  const std::lock_guard lock(mutex_);
  return number_ > 0 ? std::optional(view_.stage) : std::nullopt;
}

void PageSubject::wait_until_fetched() {
  std::unique_lock lock(mutex_);
  if (fetched_ > 0) fetch_.wait_for(lock, std::chrono::seconds(1), [this] { return fetched_ == number_; });
}

void PageSubject::show(const SubjectView& view) {
  {
    const std::lock_guard lock(mutex_);
    // What was asked for on another screen is not meant for this one.
    if (is_new_screen(view_, view)) actions_.clear();
    view_ = view;
    ++number_;
    shown_s_ = now_s();
  }
  wake_();
}

std::optional<SubjectAction> PageSubject::next() {
  const std::lock_guard lock(mutex_);
  if (actions_.empty()) return std::nullopt;
  const SubjectAction action = actions_.front();
  actions_.pop_front();
  return action;
}

std::optional<HttpResponse> PageSubject::respond(const HttpRequest& request, bool overdue) {
  if (!access_.admits(request))
    return access_.refuse("This address is not valid. Open the one that was shown for this session.");
  if (request.path == "/action") return request.method == "POST" ? take_action(request) : refusal(405);
  if (request.method != "GET") return refusal(405);
  if (request.path == "/view") return view_after(request, overdue);
  return page_file(session_page(), request.path, access_.token());
}

std::optional<HttpResponse> PageSubject::view_after(const HttpRequest& request, bool overdue) {
  const auto found = request.query.find("after");
  const std::string digits = found == request.query.end() ? "0" : found->second;
  std::uint64_t after = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), after);
  if (error != std::errc{} || end != digits.data() + digits.size()) return refusal(400);

  const std::lock_guard lock(mutex_);
  if (number_ <= after) return overdue ? std::optional(HttpResponse{.status = 204}) : std::nullopt;
  fetched_ = number_;
  fetch_.notify_all();
  return as_json(200, json_of(view_, number_, std::max(0.0, view_.wait_s - (now_s() - shown_s_))));
}

HttpResponse PageSubject::take_action(const HttpRequest& request) {
  if (!request.header("content-type").starts_with("application/json")) return refusal(415);
  const std::optional<PageAction> asked = read_action(request.body);
  if (!asked) return refused(400, "an action has kind, slot, stage and trial");

  const std::lock_guard lock(mutex_);
  const bool leaves = asked->action.kind == SubjectAction::Kind::quit;
  if (!leaves && (asked->stage != name_of(view_.stage) || asked->trial != view_.trial)) {
    return refused(409, "That came too late: something else is shown now.");
  }
  if (!permits(view_, asked->action)) return refused(409, "Not now.");
  if (actions_.size() >= max_actions) return refusal(503);
  actions_.push_back(asked->action);
  return as_json(200, "{}");
}

ServedSubject::ServedSubject(std::uint16_t port)
    : server_(port), page_(AccessControl(server_.hosts()), [this] { server_.wake(); }) {
  server_.start([this](const HttpRequest& request, bool overdue) { return page_.respond(request, overdue); });
}

ServedSubject::~ServedSubject() {
  page_.wait_until_fetched();
  server_.stop();
}

}  // namespace kerf::bench
