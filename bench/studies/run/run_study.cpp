#include "run/run_study.h"

#include <cerrno>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <kerf/schema/unfinished.h>

#include "files/disk_room.h"
#include "files/json_file.h"
#include "files/named_file.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "inputs/copied_input.h"
#include "inputs/study_imports.h"
#include "page/study_page.h"
#include "recordings/provenance.h"
#include "results/crate.h"
#include "results/study_tables.h"
#include "run/held_out.h"
#include "run/kept_recording.h"
#include "run/recording_step.h"
#include "threads/for_each_index.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

/// Two runs of one study at once would write over each other.
class HeldStudy {
 public:
  explicit HeldStudy(const fs::path& file) : descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(descriptor_);
      throw std::invalid_argument(
          fmt::format("{}: another process runs this study; wait until it ends", file.string()));
    }
  }
  HeldStudy(const HeldStudy&) = delete;
  HeldStudy& operator=(const HeldStudy&) = delete;
  ~HeldStudy() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

 private:
  int descriptor_;
};

/// What killed runs left half-written, by the one that runs the study now.
void remove_left_behind(const fs::path& folder) {
  for (const char* place : {"", "recordings", "held_out", "imports", "inputs"})
    if (fs::is_directory(folder / place)) (void)schema::remove_unfinished(folder / place);
  std::error_code none;
  std::vector<fs::path> within;  // the drawer's own folders
  for (const auto& entry : fs::recursive_directory_iterator(folder / "inputs", none))
    if (entry.is_directory()) within.push_back(entry.path());
  for (const fs::path& place : within) (void)schema::remove_unfinished(place);
}

/// Maps are asked for before the work, all at once.
void require_maps(const fs::path& file, const StudyPlan& plan) {
  std::size_t unknown = 0;
  std::string first;
  for (const DrawerFile& one : plan.files) {
    if (!one.ignored.empty() || fs::path(one.path).extension() == ".h5") continue;
    if (!plan.map_of(one).empty() || !one.join_suggested.empty()) continue;
    if (unknown++ == 0) first = one.path;
  }
  if (unknown > 0)
    throw std::invalid_argument(
        fmt::format("{}: the columns of {} files are unknown, the first is {}; write a 'map' such as "
                    "\"time=1[s],position=2[mm],force=3[N]\" into it",
                    file.string(), unknown, first));
}

/// One line, without the path of the copy that was read: "line 7: ...".
std::string in_one_line(const std::string& message, const fs::path& source) {
  const std::string path = source.string() + ":";
  if (!message.starts_with(path)) return message;
  const std::string rest = message.substr(path.size());
  return rest.starts_with(' ') ? rest.substr(1) : "line " + rest;
}

StudiedRecording made_or_kept(const RecordingStep& step, const std::string& name, const fs::path& folder,
                              const std::atomic<bool>& stop) {
  const fs::path place = folder / "recordings" / name;
  if (auto kept = kept_recording(place, key_of(step))) return std::move(*kept);
  WholeFolder whole(place, schema::Existing::replace);
  StudiedRecording result = run_recording_step(step, whole.path(), stop);
  whole.commit();
  return result;
}

void study_one(const StudyPlan& plan, DrawerRecording& one, const fs::path& folder,
               const std::atomic<bool>& stop) {
  fs::path source = plan.folder / fs::path(one.file.path);
  try {
    source = copied_input(plan, one.file, folder);
    if (!one.file.join.empty()) (void)copied_input(plan, plan.file_called(one.file.join), folder);
    one.result = made_or_kept(step_of(plan, one.file, folder), one.name, folder, stop);
  } catch (const std::system_error&) {
    throw;  // a disk, or Ctrl-C: no fault of the file
  } catch (const std::bad_alloc&) {
    one.result.failure = "there was not enough memory";
  } catch (const std::exception& error) {
    one.result.failure = in_one_line(in_words_of_study(error.what()), source);
  }
}

/// What is to be said of a recording at once; empty if there is nothing.
std::string line_of(const DrawerRecording& one) {
  const StudiedRecording& result = one.result;
  if (!result.failure.empty()) return fmt::format("{}: {}", one.file.path, result.failure);
  if (result.blank && !result.blank->is_taken())
    return fmt::format("{}: no blank is taken off it: {}", one.file.path, result.blank->why_none);
  return "";
}

void study_those(const std::vector<std::size_t>& places, const StudyPlan& plan,
                 std::vector<DrawerRecording>& recordings, const fs::path& folder,
                 const StudyRunOptions& options, const std::atomic<bool>& stop) {
  std::mutex says;
  for_each_index(places.size(), options.jobs, [&](std::size_t i) {
    if (stop) throw std::system_error(std::make_error_code(std::errc::interrupted), "the study was stopped");
    DrawerRecording& one = recordings[places[i]];
    study_one(plan, one, folder, stop);
    if (const std::string line = line_of(one); !line.empty() && options.warn) {
      const std::scoped_lock lock(says);
      options.warn(line);
    }
    if (options.done != nullptr) ++*options.done;
  });
}

/// Blanks first, which are taken off the others.
void study_all(const StudyPlan& plan, std::vector<DrawerRecording>& recordings, const fs::path& folder,
               const StudyRunOptions& options, const std::atomic<bool>& stop) {
  std::vector<std::size_t> blanks;
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < recordings.size(); ++i)
    (recordings[i].file.blank ? blanks : others).push_back(i);
  study_those(blanks, plan, recordings, folder, options, stop);
  study_those(others, plan, recordings, folder, options, stop);
}

void take_kept(std::vector<DrawerRecording>& recordings, const fs::path& folder) {
  for (DrawerRecording& one : recordings) {
    if (auto kept = kept_recording(folder / "recordings" / one.name, "")) {
      one.result = std::move(*kept);
    } else {
      one.result.failure = "nothing was computed of it yet";
    }
  }
}

/// What was kept of groups that are no more.
void remove_unused(const StudyResults& results, const fs::path& folder) {
  std::set<fs::path> used;
  for (const StudiedGroup& group : results.groups)
    used.insert(kept_errors_file(results.recordings, group.counted, results.plan, folder));
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder / "held_out", none))
    if (!used.contains(entry.path())) fs::remove(entry.path(), none);
}

void write_results(const StudyResults& results, const fs::path& folder) {
  remove_unused(results, folder);
  const fs::path tables = folder / "tables";
  {
    WholeFolder whole(tables, schema::Existing::replace);
    write_study_tables(results, whole.path());
    whole.commit();
  }
  write_json_file(folder / "study.json", study_as_json(results));
  write_whole_file(folder / "report.html", study_page(results, folder));
  write_json_file(folder / crate_file, study_crate(results, folder));
}

/// What no law can be fitted to together costs a line, and the study goes on.
void judge_on_others(StudiedGroup& group, const StudyResults& results, const fs::path& folder,
                     const StudyRunOptions& options, const std::atomic<bool>& stop) {
  try {
    group.on_others =
        errors_on_others(results.plan, results.recordings, group.counted, folder, options.jobs, stop);
  } catch (const std::invalid_argument& error) {
    if (options.warn)
      options.warn(fmt::format("{}: no law is judged on recordings that it was not fitted to: {}",
                               group.name(), error.what()));
  }
}

}  // namespace

StudyResults run_study(const fs::path& file, const StudyRunOptions& options, const std::atomic<bool>& stop) {
  StudyResults results;
  results.plan = read_study(file);
  const fs::path folder = fs::absolute(file).parent_path();
  results.name = folder.filename().string();
  const HeldStudy held(file);
  remove_left_behind(folder);
  const StudyPlan& plan = results.plan;
  if (!options.only_report) {
    require_maps(file, plan);
    take_imports(plan, folder);
    for (const char* output : {"study.json", "report.html", crate_file})
      require_output(folder / output, true);
  }
  const std::vector<std::string> names = recording_names(plan);
  for (std::size_t i = 0; i < plan.files.size(); ++i)
    if (plan.files[i].ignored.empty())
      results.recordings.push_back({.name = names[i], .file = plan.files[i], .result = {}});
  if (results.recordings.empty())
    throw std::invalid_argument(fmt::format("{}: no file takes part in this study", file.string()));
  require_disk(folder / "recordings", bytes_of_run(plan, folder),
               fmt::format("a study of {} files", results.recordings.size()));
  if (options.only_report) {
    take_kept(results.recordings, folder);
  } else {
    study_all(plan, results.recordings, folder, options, stop);
  }
  doubt_recordings(results.recordings, plan.all_cycles);
  form_groups(results);
  for (StudiedGroup& group : results.groups) judge_on_others(group, results, folder, options, stop);
  conclude(results);
  write_results(results, folder);
  return results;
}

}  // namespace kerf::bench
