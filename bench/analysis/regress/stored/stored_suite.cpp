#include "regress/stored/stored_suite.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "laws/sampled_motion.h"
#include "regress/stored/conflict.h"
#include "regress/stored/summary.h"
#include "regress/stored/text_forces.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

fs::path trajectory_file(const fs::path& folder, const std::string& sha256) {
  return folder / "trajectories" / (sha256.substr(0, 16) + ".csv");
}

StoredSuite read_binary(const fs::path& file, const Suite& suite) {
  if (!fs::exists(file)) return {};
  require_no_conflict(file, suite);
  return {.cases = schema::read_regression(file), .errors = {}};
}

std::vector<fs::path> tables_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::exists(folder)) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

StoredSuite read_texts(const fs::path& folder, const Suite& suite) {
  StoredSuite stored;
  for (const fs::path& file : tables_in(folder)) {
    const auto about = std::ranges::find_if(
        suite.cases, [&](const RegressionCase& one) { return text_file_of(one.name) == file.filename(); });
    try {
      schema::StoredForces one = read_forces_text(file, suite);
      const fs::path trajectory = trajectory_file(folder, one.trajectory_sha256);
      if (fs::exists(trajectory)) one.trajectory = read_trajectory_text(trajectory, suite);
      stored.cases.push_back(std::move(one));
    } catch (const std::invalid_argument& error) {
      if (about == suite.cases.end()) throw;
      stored.errors[about->name] = error.what();
    }
  }
  return stored;
}

/// Where the forces of a suite stand in the form that it does not have.
fs::path other_form(const Suite& suite) {
  fs::path other = suite.stored;
  return other.replace_extension(suite.references == References::text ? ".h5" : ".forces");
}

void write_if_other(const fs::path& file, const std::string& text) {
  if (!fs::exists(file) || read_whole_file(file) != text) write_whole_file(file, text);
}

/// Trajectories that no case has any more, unless there are cases of which that is not known.
void remove_unused(const fs::path& folder, std::size_t cases, const std::set<fs::path>& trajectories) {
  if (tables_in(folder).size() != cases) return;
  for (const fs::path& file : tables_in(folder / "trajectories")) {
    if (!trajectories.contains(file)) fs::remove(file);
  }
}

void write_texts(const fs::path& folder, const std::vector<schema::StoredForces>& cases,
                 const std::vector<std::string>& gone) {
  fs::create_directories(folder);
  std::set<fs::path> trajectories;
  for (const schema::StoredForces& one : cases) {
    if (!one.trajectory.empty()) {
      const fs::path file = trajectory_file(folder, one.trajectory_sha256);
      fs::create_directories(file.parent_path());
      if (trajectories.insert(file).second) write_if_other(file, trajectory_as_text(one.trajectory));
    }
    write_if_other(folder / text_file_of(one.name), forces_as_text(one));
  }
  for (const std::string& name : gone) fs::remove(folder / text_file_of(name));
  remove_unused(folder, cases.size(), trajectories);
}

std::string wanted_summary(const Suite& suite, const std::vector<schema::StoredForces>& cases) {
  std::vector<SummaryBlock> before;
  try {
    if (fs::exists(summary_file(suite))) before = read_summary(suite);
  } catch (const std::invalid_argument&) {  // a conflict: nothing of it is kept
  }
  return summary_text(suite, cases, before);
}

}  // namespace

StoredSuite read_stored(const Suite& suite) {
  const bool here = fs::exists(suite.stored);
  const fs::path place = here ? suite.stored : other_form(suite);
  const bool text = (suite.references == References::text) == here;
  return text ? read_texts(place, suite) : read_binary(place, suite);
}

void write_stored(const Suite& suite, const std::vector<schema::StoredForces>& cases,
                  const std::vector<std::string>& gone) {
  const std::string summary = wanted_summary(suite, cases);
  if (suite.references == References::text) {
    write_texts(suite.stored, cases, gone);
  } else if (!fs::exists(suite.stored) || schema::read_regression(suite.stored) != cases) {
    schema::write_regression(suite.stored, cases);
  }
  write_if_other(summary_file(suite), summary);
}

std::string what_is_missing(const Suite& suite, const std::vector<schema::StoredForces>& cases) {
  if (!fs::exists(suite.stored))
    return fmt::format("the forces of {} go to {}", other_form(suite).string(), suite.stored.string());
  const fs::path summary = summary_file(suite);
  if (!fs::exists(summary) || read_whole_file(summary) != wanted_summary(suite, cases))
    return summary.string() + " is not up to date";
  return {};
}

schema::StoredTrajectory stored_trajectory(const RegressionCase& about, const SampledMotion& motion) {
  if (about.trajectory.empty() && about.motion.recording.empty()) return {};
  schema::StoredTrajectory path{.time_s = motion.time_s};
  const std::vector<models::LawAxis> axes = axes_of(about);
  for (const models::LawAxis& axis : axes) path.axes.push_back({axis.name, axis.position_unit});
  for (const models::SpatialMotion& sample : motion.sample)
    for (std::size_t i = 0; i < axes.size(); ++i) path.position.push_back(sample.position[i]);
  return path;
}

}  // namespace kerf::bench
