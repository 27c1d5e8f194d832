#include "subject/subject_page.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "html/html.h"
#include "subject/session_page.h"
#include "subject/subject_rules.h"
#include "subject/subject_words.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_actions = 16;  // that wait to be taken

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

constexpr double softest_db = -60.0;  // of full scale, rms
constexpr double loudest_db = -15.0;  // above it the peaks of pink noise, 4.7 rms, are cut

nlohmann::json json_of(MaskingNoise noise, const std::optional<double>& level_db) {
  if (noise == MaskingNoise::none) return nullptr;
  return {{"kind", name_of(noise)},
          {"level_db", level_db ? nlohmann::json(*level_db) : nlohmann::json(nullptr)}};
}

nlohmann::json json_of(const std::optional<SubjectView::AskedNumber>& asked) {
  if (!asked) return nullptr;
  return {{"lower", asked->lower}, {"upper", asked->upper}, {"step", asked->step}, {"ends", asked->ends}};
}

nlohmann::json json_of(const std::optional<GuidedMotion>& guide, bool leads) {
  if (!guide) return nullptr;
  return {{"target", guide->has_target()},
          {"tool", guide->shows_tool},
          {"cycle_s", guide->cycle_s()},
          {"clicks", !guide->has_target() && guide->clicks},
          {"leads", leads}};
}

std::string json_of(const SubjectView& view, std::uint64_t number, double wait_s, nlohmann::json noise,
                    nlohmann::json guide) {
  const nlohmann::json json{
      {"number", number},
      {"stage", name_of(view.stage)},
      {"study", view.study},
      {"heading", heading(view)},
      {"text", text_below(view)},
      {"progress", progress(view)},
      {"plays", what_plays(view)},
      {"labels", view.labels},
      {"answers",
       view.answer_labels.empty() ? std::min(view.answers, view.labels.size()) : view.answer_labels.size()},
      {"answer_labels", view.answer_labels},
      {"label_list", label_list(view, view.labels.size())},
      {"answer_list", answer_list(view)},
      {"in_steps", view.in_steps},
      {"asked_number", json_of(view.number)},
      {"playing", view.playing ? nlohmann::json(*view.playing) : nlohmann::json(nullptr)},
      {"may_switch", view.may_switch},
      {"may_answer", view.may_answer},
      {"may_go_on", view.may_go_on},
      {"may_slip", view.may_slip},
      {"trial", view.trial},
      {"wait_s", wait_s},
      {"noise", std::move(noise)},
      {"guide", std::move(guide)},
      {"notice", view.notice}};
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// For a script: no text in it can end the element.
std::string as_json(const SubjectTexts& texts) {
  nlohmann::json all;
  for (std::size_t i = 0; i < text_names.size(); ++i) all[std::string(text_names[i])] = texts.all()[i];
  const std::string json = all.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string safe;
  for (const char c : json) c == '<' ? safe.append("\\u003c") : safe.append(1, c);
  return safe;
}

/// The page with every {{text NAME}}, and with all of them for its script at {{texts}}.
std::string with_texts(std::string_view html, const SubjectTexts& texts) {
  constexpr std::string_view of_one = "{{text ";
  constexpr std::string_view of_all = "{{texts}}";
  std::string filled;
  for (std::size_t at = html.find("{{"); at != std::string_view::npos; at = html.find("{{")) {
    filled += html.substr(0, at);
    html.remove_prefix(at);
    const std::size_t end = html.find("}}");
    const std::string_view mark = html.substr(0, end + 2);
    if (mark == of_all) {
      filled += as_json(texts);
    } else {
      const std::string_view name = mark.substr(of_one.size(), mark.size() - of_one.size() - 2);
      const auto* const found = std::ranges::find(text_names, name);
      filled += escaped(texts.all().at(static_cast<std::size_t>(found - text_names.begin())));
    }
    html.remove_prefix(mark.size());
  }
  return filled += html;
}

struct PageAction {
  SubjectAction action;
  std::string stage;
  std::size_t trial = 0;
};

std::optional<PageAction> read_action(const std::string& body) {
  using Action = SubjectAction::Kind;
  constexpr std::array<std::pair<std::string_view, Action>, 6> kinds{{{"go_on", Action::go_on},
                                                                      {"decline", Action::decline},
                                                                      {"play", Action::play},
                                                                      {"answer", Action::answer},
                                                                      {"quit", Action::quit},
                                                                      {"slip", Action::slip}}};
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
  constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
  return PageAction{
      .action = {.kind = found->second,
                 .slot = json["slot"].get<std::size_t>(),
                 .number =
                     has("number", &nlohmann::json::is_number) ? json["number"].get<double>() : no_number},
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

PageSubject::PageSubject(AccessControl access, std::function<void()> wake,
                         std::shared_ptr<const SubjectTexts> texts)
    : access_(std::move(access)), wake_(std::move(wake)), texts_(std::move(texts)) {}

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

void PageSubject::use_noise(MaskingNoise noise, std::optional<double> level_db,
                            std::function<void(double)> keep) {
  const std::lock_guard lock(mutex_);
  noise_ = noise;
  noise_level_db_ = level_db;
  keep_noise_level_ = std::move(keep);
}

/// On the session's thread, whose file it goes to.
void PageSubject::keep_noise_level() {
  std::optional<double> asked_db;
  {
    const std::lock_guard lock(mutex_);
    asked_db = std::exchange(noise_level_asked_db_, std::nullopt);
  }
  if (!asked_db) return;
  try {
    keep_noise_level_(*asked_db);
  } catch (const std::system_error&) {
    return;  // the disk is full: the page asks on
  }
  {
    const std::lock_guard lock(mutex_);
    noise_level_db_ = asked_db;
    ++number_;
  }
  wake_();
}

std::optional<SubjectAction> PageSubject::next() {
  keep_noise_level();
  const std::lock_guard lock(mutex_);
  if (actions_.empty()) return std::nullopt;
  const SubjectAction action = actions_.front();
  actions_.pop_front();
  return action;
}

std::optional<HttpResponse> PageSubject::respond(const HttpRequest& request, bool overdue) {
  if (!access_.admits(request)) return access_.refuse((*texts_)("page_wrong_address"));
  if (request.path == "/noise") return request.method == "POST" ? take_noise_level(request) : refusal(405);
  if (request.path == "/action") return request.method == "POST" ? take_action(request) : refusal(405);
  if (request.method != "GET") return refusal(405);
  if (request.path == "/view") return view_after(request, overdue);
  if (request.path == "/guide") return guide_now();
  HttpResponse file = page_file(session_page(), request.path, access_.token());
  if (request.path == "/") file.body = with_texts(file.body, *texts_);
  return file;
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
  return as_json(200, json_of(view_, number_, std::max(0.0, view_.wait_s - (now_s() - shown_s_)),
                              json_of(noise_, noise_level_db_), json_of(guide_, view_.guided)));
}

void PageSubject::use_guide(const GuidedMotion& guide, std::function<GuideLook()> look) {
  const std::lock_guard lock(mutex_);
  guide_ = guide;
  look_ = std::move(look);
}

HttpResponse PageSubject::guide_now() const {
  if (!guide_) return refusal(404);
  const GuideLook look = look_();
  if (!std::isfinite(look.time_s)) return refused(409, (*texts_)("refused_now"));
  const auto share = [&](double position) {
    return std::isfinite(position) ? nlohmann::json(guide_->share_of_way(position)) : nlohmann::json(nullptr);
  };
  nlohmann::json now{{"time_s", look.time_s}};
  if (guide_->has_target()) {
    now["target"] = share(guide_->at(look.time_s).position);
    now["tool"] = guide_->shows_tool ? share(look.position) : nlohmann::json(nullptr);
  }
  return as_json(200, now.dump());
}

HttpResponse PageSubject::take_noise_level(const HttpRequest& request) {
  if (!request.header("content-type").starts_with("application/json")) return refusal(415);
  const nlohmann::json json = nlohmann::json::parse(request.body, nullptr, false);
  const bool is_number = json.is_object() && json.contains("level_db") && json["level_db"].is_number();
  const double level_db = is_number ? json["level_db"].get<double>() : 0.0;
  if (!(level_db >= softest_db && level_db <= loudest_db))
    return refused(400, "a noise has a level_db from -60 to -15");
  const std::lock_guard lock(mutex_);
  if (noise_ == MaskingNoise::none || noise_level_db_) return refused(409, (*texts_)("refused_now"));
  noise_level_asked_db_ = level_db;
  return as_json(200, "{}");
}

HttpResponse PageSubject::take_action(const HttpRequest& request) {
  if (!request.header("content-type").starts_with("application/json")) return refusal(415);
  const std::optional<PageAction> asked = read_action(request.body);
  if (!asked) return refused(400, "an action has kind, slot, stage and trial");

  const std::lock_guard lock(mutex_);
  const bool leaves = asked->action.kind == SubjectAction::Kind::quit;
  if (!leaves && (asked->stage != name_of(view_.stage) || asked->trial != view_.trial)) {
    return refused(409, (*texts_)("refused_late"));
  }
  if (!permits(view_, asked->action)) return refused(409, (*texts_)("refused_now"));
  if (asked->action.kind == SubjectAction::Kind::go_on && noise_ != MaskingNoise::none && !noise_level_db_)
    return refused(409, (*texts_)("refused_noise"));
  if (actions_.size() >= max_actions) return refusal(503);
  actions_.push_back(asked->action);
  return as_json(200, "{}");
}

ServedSubject::ServedSubject(std::uint16_t port, std::shared_ptr<const SubjectTexts> texts)
    : server_(port),
      page_(
          AccessControl(server_.hosts()), [this] { server_.wake(); }, std::move(texts)) {
  server_.start([this](const HttpRequest& request, bool overdue) { return page_.respond(request, overdue); });
}

ServedSubject::~ServedSubject() {
  page_.wait_until_fetched();
  server_.stop();
}

}  // namespace kerf::bench
