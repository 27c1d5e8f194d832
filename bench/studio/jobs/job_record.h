#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace kerf::bench {

enum class JobState : std::uint8_t {
  waiting,
  running,
  done,
  failed,
  stopped,
  interrupted  ///< the studio ended while it waited or ran
};
[[nodiscard]] std::string_view name_of(JobState state) noexcept;

/// What asks for a job again: a path of the studio and the body that is posted there.
// NOLINTNEXTLINE(bugprone-exception-escape): of what moves JSON, which does not throw
struct JobAgain {
  std::string path;  ///< empty: it cannot be asked for again
  nlohmann::json body;
};

/// What is kept of a job on disk, so that it outlives page and studio.
// NOLINTNEXTLINE(bugprone-exception-escape): of what moves JSON, which does not throw
struct JobRecord {
  std::size_t number = 0;
  std::string kind;   ///< "fit", or "verb"
  std::string title;  ///< "Fit of cut.h5"
  JobState state = JobState::waiting;
  std::string error;    ///< why it failed
  std::string file;     ///< id of its result in the workspace; empty: none with a page of its own
  std::string outcome;  ///< what it found in a word, such as "did not pass"; empty: nothing to say
  std::vector<std::string> outputs;  ///< files and folders that it writes, by their names in the workspace
  std::string created;               ///< by the wall clock, ISO 8601
  double seconds = 0.0;              ///< that it has run, by a clock that nobody sets
  double clock_set_s = 0.0;          ///< by how much the wall clock was set while it ran
  JobAgain again;
  bool is_unwanted = false;  ///< somebody has asked to stop it

  [[nodiscard]] bool has_ended() const noexcept {
    return state != JobState::waiting && state != JobState::running;
  }
  /// What one is that the studio's end, too, would have ended: who asked first is named.
  [[nodiscard]] JobState state_without_studio() const noexcept {
    return is_unwanted ? JobState::stopped : JobState::interrupted;
  }
};

[[nodiscard]] nlohmann::ordered_json to_json(const JobRecord& record);
/// @throws std::exception for what is no record, or one of a later format.
[[nodiscard]] JobRecord job_record_in(std::string_view text);

[[nodiscard]] std::string iso_8601(std::chrono::system_clock::time_point time);

}  // namespace kerf::bench
