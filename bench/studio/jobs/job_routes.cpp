#include "jobs/job_routes.h"

#include <cmath>

namespace kerf::bench {
namespace {

constexpr double largest_number = 1e15;

}  // namespace

std::size_t job_in(const HttpRequest& request) {
  const double number = number_in(json_in(request), "job", 0.0, largest_number);
  if (number != std::floor(number)) throw RequestError(400, "'job' is not a whole number");
  return static_cast<std::size_t>(number);
}

std::size_t job_in_query(const HttpRequest& request) {
  return count_in_query(request, "job", static_cast<std::size_t>(largest_number));
}

void add_job_routes(Routes& routes, Jobs& jobs) {
  using Pace = Routes::Pace;
  routes.get("/api/jobs", Pace::at_once, [&jobs](const HttpRequest&) { return json_response(jobs.list()); });
  routes.get("/api/jobs/log", Pace::slow, [&jobs](const HttpRequest& request) {
    return json_response({{"text", jobs.log_of(job_in_query(request))}});
  });
  routes.post("/api/jobs/stop", Pace::stop, [&jobs](const HttpRequest& request) {
    jobs.stop(job_in(request));
    return json_response(nlohmann::ordered_json::object());
  });
  routes.post("/api/jobs/forget", Pace::slow, [&jobs](const HttpRequest& request) {
    jobs.forget(job_in(request));
    return json_response(nlohmann::ordered_json::object());
  });
}

}  // namespace kerf::bench
