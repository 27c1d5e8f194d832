#include "jobs/job_record.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/chrono.h>

namespace kerf::bench {
namespace {

constexpr int record_format = 1;
constexpr std::array<std::string_view, 6> job_states{"waiting", "running", "done",
                                                     "failed",  "stopped", "interrupted"};

JobState state_named(const std::string& name) {
  const auto found = std::ranges::find(job_states, std::string_view(name));
  if (found == job_states.end()) throw std::invalid_argument("a job has no state '" + name + "'");
  return static_cast<JobState>(found - job_states.begin());
}

}  // namespace

std::string_view name_of(JobState state) noexcept { return job_states[static_cast<std::size_t>(state)]; }

nlohmann::ordered_json to_json(const JobRecord& record) {
  return {{"format", record_format},
          {"job", record.number},
          {"kind", record.kind},
          {"title", record.title},
          {"state", name_of(record.state)},
          {"error", record.error},
          {"file", record.file},
          {"outcome", record.outcome},
          {"outputs", record.outputs},
          {"created", record.created},
          {"seconds", record.seconds},
          {"clock_set_s", record.clock_set_s},
          {"unwanted", record.is_unwanted},
          {"again", {{"path", record.again.path}, {"body", record.again.body}}}};
}

JobRecord job_record_in(std::string_view text) {
  const auto json = nlohmann::json::parse(text);
  if (json.at("format").get<int>() != record_format)
    throw std::invalid_argument("it is of a later version of the studio");
  return {
      .number = json.at("job").get<std::size_t>(),
      .kind = json.at("kind").get<std::string>(),
      .title = json.at("title").get<std::string>(),
      .state = state_named(json.at("state").get<std::string>()),
      .error = json.at("error").get<std::string>(),
      .file = json.at("file").get<std::string>(),
      .outcome = json.at("outcome").get<std::string>(),
      .outputs = json.at("outputs").get<std::vector<std::string>>(),
      .created = json.at("created").get<std::string>(),
      .seconds = json.at("seconds").get<double>(),
      .clock_set_s = json.at("clock_set_s").get<double>(),
      .again = {.path = json.at("again").at("path").get<std::string>(), .body = json.at("again").at("body")},
      .is_unwanted = json.value("unwanted", false)};
}

std::string iso_8601(std::chrono::system_clock::time_point time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
}

}  // namespace kerf::bench
