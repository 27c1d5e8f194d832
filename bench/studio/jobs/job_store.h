#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/processes/helper.h>

#include "jobs/job_record.h"

namespace kerf::bench {

/// The jobs of a workspace on disk: `N.json`, the record, written whole or not at all, and `N.log` beside it,
/// in a hidden folder of the workspace. The folder is made by the first job. One studio at a time has it: a
/// second one on the same workspace keeps nothing, and says so. By one thread at a time.
class JobStore {
 public:
  /// The most that is kept of a log [bytes].
  static constexpr std::size_t longest_log = std::size_t{1} << 18U;

  /// Without a folder nothing is kept.
  explicit JobStore(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}

  /// What is there, oldest first. One that was under way when its studio ended is interrupted now, or stopped
  /// where somebody had asked for that; a record that cannot be read stands as one that has failed, with the
  /// reason.
  [[nodiscard]] std::vector<JobRecord> load();
  /// Why it is not kept; empty if it is.
  [[nodiscard]] std::string keep(const JobRecord& record);
  /// Adds to the log; likewise.
  [[nodiscard]] std::string append(std::size_t job, std::string_view text);
  [[nodiscard]] std::string log_of(std::size_t job) const;
  void forget(std::size_t job);

 private:
  /// Makes the folder if there is none, and takes it for this studio. @throws std::exception that says why
  /// not.
  void take();
  [[nodiscard]] std::filesystem::path file(std::size_t job, std::string_view ending) const;

  std::filesystem::path folder_;
  processes::Descriptor lock_;
};

/// Where a studio keeps what belongs to it and not to the lab's files: `.kerf-studio` in the workspace.
[[nodiscard]] std::filesystem::path state_folder_of(const std::filesystem::path& workspace);

}  // namespace kerf::bench
