#include "http/routes.h"

#include <algorithm>
#include <system_error>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "files/for_terminal.h"
#include "host/realtime.h"
#include "loop/without_signals.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_waiting = 64;

/// What an answer says, or why there is none.
HttpResponse guarded(const Routes::Answer& answer, const HttpRequest& request) {
  try {
    return answer(request);
  } catch (const RequestError& error) {
    return json_error(error.status, error.what());
  } catch (const std::invalid_argument& error) {
    return json_error(400, error.what());
  } catch (const schema::FormatError& error) {
    return json_error(400, error.what());
  } catch (const std::exception& error) {
    return json_error(500, error.what());
  }
}

}  // namespace

HttpResponse json_response(const nlohmann::ordered_json& json) {
  return json_text_response(
      json_for_page(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)));
}

HttpResponse json_text_response(std::string text) {
  return {.type = "application/json", .body = std::move(text)};
}

HttpResponse json_error(int status, std::string_view why) {
  HttpResponse response = json_response({{"error", why}});
  response.status = status;
  return response;
}

HttpResponse bytes_response(std::string bytes) {
  return {.type = "application/octet-stream", .body = std::move(bytes)};
}

Routes::Routes() {
  const WithoutSignals none;
  auto thread = threads_.begin();
  for (const Pace pace : {Pace::slow, Pace::action, Pace::stop})
    *thread++ = std::jthread([this, pace](const std::stop_token& stop) { answer_slowly(pace, stop); });
}

Routes::~Routes() = default;

void Routes::get(const std::string& path, Pace pace, Answer answer) {
  routes_[path].push_back({.method = "GET", .pace = pace, .answer = std::move(answer)});
}

void Routes::post(const std::string& path, Pace pace, Answer answer) {
  routes_[path].push_back({.method = "POST", .pace = pace, .answer = std::move(answer)});
}

void Routes::on_ready(std::function<void()> wake) { wake_ = std::move(wake); }

std::optional<HttpResponse> Routes::respond(const HttpRequest& request, bool overdue) {
  if (auto waited = answer_of(request, overdue)) return *std::move(waited);
  const auto found = routes_.find(request.path);
  if (found == routes_.end()) return refusal(404);
  const auto route = std::find_if(found->second.begin(), found->second.end(),
                                  [&](const Route& it) { return it.method == request.method; });
  if (route == found->second.end()) return refusal(405);
  if (route->pace == Pace::at_once) return guarded(route->answer, request);

  const std::lock_guard lock(mutex_);
  forget_the_abandoned();
  if (waiting_.size() >= max_waiting) return json_error(503, "too much to do; try again");
  waiting_.emplace(request.number,
                   Waiting{.request = request, .answer = &route->answer, .pace = route->pace});
  changed_.notify_all();
  return std::nullopt;
}

std::optional<std::optional<HttpResponse>> Routes::answer_of(const HttpRequest& request, bool overdue) {
  const std::lock_guard lock(mutex_);
  const auto asked = waiting_.find(request.number);
  if (asked == waiting_.end()) return std::nullopt;
  if (!asked->second.response) {
    if (!overdue) return std::optional<HttpResponse>();
    if (asked->second.is_begun) return json_error(504, "that takes longer, and goes on");
    waiting_.erase(asked);
    return json_error(503, "too much to do; nothing was done, try again");
  }
  HttpResponse response = *std::move(asked->second.response);
  waiting_.erase(asked);
  return response;
}

void Routes::forget_the_abandoned() {
  std::erase_if(waiting_, [](const auto& it) {
    const Waiting& waiting = it.second;
    return waiting.request.asker.expired() && (!waiting.is_begun || waiting.response);
  });
}

void Routes::answer_slowly(Pace pace, const std::stop_token& stop) {
  stay_off_loop_processor();
  const auto is_next = [pace](const auto& it) { return it.second.pace == pace && !it.second.is_begun; };
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    forget_the_abandoned();
    const auto next = std::find_if(waiting_.begin(), waiting_.end(), is_next);
    if (next == waiting_.end()) {
      changed_.wait(lock, stop, [&] { return std::any_of(waiting_.begin(), waiting_.end(), is_next); });
      continue;
    }
    Waiting& waiting = next->second;  // stays where it is: what is begun is nobody else's to erase
    waiting.is_begun = true;
    lock.unlock();
    HttpResponse response = guarded(*waiting.answer, waiting.request);
    lock.lock();
    waiting.response = std::move(response);
    if (wake_) wake_();
  }
}

}  // namespace kerf::bench
