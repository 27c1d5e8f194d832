#include "subject/subject_page.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sodium.h>

#include "subject/page_files.h"
#include "subject/subject_rules.h"
#include "subject/subject_words.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_actions = 16;  // that wait to be taken

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string new_token() {
  std::array<unsigned char, 16> bytes{};
  randombytes_buf(bytes.data(), bytes.size());
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

/// In a time that does not tell how much of it is right.
bool is_same_secret(std::string_view given, std::string_view secret) noexcept {
  return given.size() == secret.size() && sodium_memcmp(given.data(), secret.data(), secret.size()) == 0;
}

std::string_view type_of(std::string_view name) noexcept {
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  if (name.ends_with(".js")) return "text/javascript; charset=utf-8";
  if (name.ends_with(".svg")) return "image/svg+xml";
  return "text/html; charset=utf-8";
}

std::string with_token(std::string_view html, const std::string& token) {
  constexpr std::string_view mark = "{{token}}";
  std::string text(html);
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at)) {
    text.replace(at, mark.size(), token);
  }
  return text;
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
  using Kind = SubjectAction::Kind;
  constexpr std::array<std::pair<std::string_view, Kind>, 5> kinds{{{"go_on", Kind::go_on},
                                                                    {"decline", Kind::decline},
                                                                    {"play", Kind::play},
                                                                    {"answer", Kind::answer},
                                                                    {"quit", Kind::quit}}};
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

PageSubject::PageSubject(std::uint16_t port) : token_(new_token()), server_(port) {
  server_.start([this](const HttpRequest& request, bool overdue) { return respond(request, overdue); });
}

PageSubject::~PageSubject() {
  std::unique_lock lock(mutex_);
  if (fetched_ > 0) fetch_.wait_for(lock, std::chrono::seconds(1), [this] { return fetched_ == number_; });
}

std::string PageSubject::url() const {
  return fmt::format("http://127.0.0.1:{}/?token={}", server_.port(), token_);
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
  server_.wake();
}

std::optional<SubjectAction> PageSubject::next() {
  const std::lock_guard lock(mutex_);
  if (actions_.empty()) return std::nullopt;
  const SubjectAction action = actions_.front();
  actions_.pop_front();
  return action;
}

bool PageSubject::is_from_the_page(const HttpRequest& request) const {
  const std::array hosts{fmt::format("127.0.0.1:{}", server_.port()),
                         fmt::format("localhost:{}", server_.port())};
  const auto is_ours = [&](std::string_view host) { return host == hosts[0] || host == hosts[1]; };
  if (!is_ours(request.header("host"))) return false;
  if (request.headers.contains("origin")) {
    std::string_view origin = request.header("origin");
    if (!origin.starts_with("http://")) return false;
    origin.remove_prefix(7);
    if (!is_ours(origin)) return false;
  }
  if (request.headers.contains("x-kerf-token")) return is_same_secret(request.header("x-kerf-token"), token_);
  // An address can be opened from anywhere; an action only by the page, which sends the header.
  const auto in_address = request.query.find("token");
  return request.method != "POST" && in_address != request.query.end() &&
         is_same_secret(in_address->second, token_);
}

std::optional<HttpResponse> PageSubject::respond(const HttpRequest& request, bool overdue) {
  if (!is_from_the_page(request)) {
    return HttpResponse{.status = 403,
                        .body = "This address is not valid. Open the one that kerf session run shows.\n"};
  }
  if (request.path == "/action") return request.method == "POST" ? take_action(request) : refusal(405);
  if (request.method != "GET") return refusal(405);
  if (request.path == "/view") return view_after(request, overdue);
  return file(request.path);
}

HttpResponse PageSubject::file(const std::string& path) const {
  for (const PageFile& it : page_files()) {
    const bool is_page = it.name == "page.html";
    if (path != (is_page ? std::string("/") : fmt::format("/{}", it.name))) continue;
    return {.type = std::string(type_of(it.name)),
            .body = is_page ? with_token(it.content, token_) : std::string(it.content)};
  }
  return refusal(404);
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
  if (actions_.size() >= most_actions) return refusal(503);
  actions_.push_back(asked->action);
  return as_json(200, "{}");
}

}  // namespace kerf::bench
