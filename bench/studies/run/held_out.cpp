#include "run/held_out.h"

#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "files/json_file.h"
#include "files/named_file.h"
#include "fits/fit_recording.h"
#include "fits/fit_series.h"
#include "fits/rendered_series.h"
#include "fits/row_doubts.h"
#include "recordings/axes.h"
#include "recordings/provenance.h"
#include "recordings/whole_recording.h"
#include "threads/for_each_index.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

/// Places in the group that are left out together.
using Fold = std::vector<std::size_t>;

std::vector<Fold> folds_of(const std::vector<DrawerRecording>& recordings,
                           const std::vector<std::size_t>& group) {
  std::map<std::string, Fold> specimens;
  bool all_known = true;
  for (std::size_t i = 0; i < group.size(); ++i) {
    const std::string& specimen = recordings[group[i]].file.specimen;
    all_known = all_known && !specimen.empty();
    specimens[specimen].push_back(i);
  }
  std::vector<Fold> folds;
  if (all_known && specimens.size() > 1) {
    for (auto& [name, fold] : specimens) folds.push_back(std::move(fold));
  } else {
    for (std::size_t i = 0; i < group.size(); ++i) folds.push_back({i});
  }
  return folds;
}

/// The recordings of a group, read, each with what a fit takes.
struct GroupSources {
  std::vector<schema::Recording> recordings;
  std::vector<FitSource> sources;
  FitRecordingOptions options;
};

GroupSources sources_of_group(const StudyPlan& plan, const std::vector<DrawerRecording>& recordings,
                              const std::vector<std::size_t>& group, const fs::path& folder) {
  GroupSources all;
  all.recordings.reserve(group.size());
  for (const std::size_t at : group) {
    all.recordings.push_back(
        read_whole_recording(folder / "recordings" / recordings[at].name / "recording.h5"));
    const schema::Recording& recording = all.recordings.back();
    const std::size_t axis = find_cut_axis(recording, "");
    all.sources.push_back({.recording = &recording,
                           .name = recordings[at].name,
                           .axis = axis,
                           .contact = contact_of(recording, axis),
                           .not_the_tissue = recordings[at].result.not_the_tissue()});
  }
  all.options.models = plan.laws;
  all.options.law_options = plan.law_options;
  all.options.rows.cycles.by = plan.all_cycles ? CycleChoice::By::all : CycleChoice::By::good;
  all.options.floor = false;
  all.options.fit.folds = 0;
  all.options.fit.intervals = fitting::Intervals::white;
  take_jnd_of(all.recordings[0].axes[all.sources[0].axis], all.options.fit);
  return all;
}

/// Root mean square error of a law as a loop renders it, over the rows that count.
double rendered_error(const models::Law& law, AxisSeries series, double rate_hz) {
  const std::vector<double> force = RenderedSeries(series, rate_hz).force(law);
  for (std::size_t i = 0; i < force.size(); ++i) series.force[i] -= force[i];
  return fitting::rms_of(fitted_view(series));
}

std::vector<ErrorOnOthers> errors_of_fold(const GroupSources& all, const Fold& fold,
                                          const std::atomic<bool>& stop) {
  std::vector<FitSource> others;
  for (std::size_t i = 0; i < all.sources.size(); ++i)
    if (std::ranges::find(fold, i) == fold.end()) others.push_back(all.sources[i]);
  FitRecordingOptions options = all.options;
  options.stop = &stop;
  const RecordingFit fit = fit_recordings(others, options);
  std::vector<ErrorOnOthers> errors;
  for (const std::size_t at : fold) {
    const AxisSeries series = counted_series(all.sources[at], options.rows, options.fit.jnd).series;
    const double jnd = options.fit.jnd.at(fitting::rms_of(fitted_view(series)));
    for (const std::string& model : options.models) {
      ErrorOnOthers error{.recording = all.sources[at].name,
                          .law = model,
                          .error_jnd = std::numeric_limits<double>::quiet_NaN()};
      for (const FittedLaw& law : fit.laws) {
        if (law.result.model == model && law.result.can_be_chosen())
          error.error_jnd = rendered_error(law.file.law, series, options.loop_rate_hz) / jnd;
      }
      errors.push_back(std::move(error));
    }
  }
  return errors;
}

std::string key_of_group(const StudyPlan& plan, const std::vector<DrawerRecording>& recordings,
                         const std::vector<std::size_t>& group) {
  json all = json::array({"held out 1", plan.laws});
  for (const std::size_t at : group)
    all.push_back({recordings[at].name, recordings[at].result.key, recordings[at].file.specimen});
  return sha256_of(std::string_view(all.dump()));
}

/// Of an earlier run with this key; nothing if there is none.
std::vector<ErrorOnOthers> kept_errors(const fs::path& file, const std::string& key) {
  std::vector<ErrorOnOthers> errors;
  try {
    const json kept = json::parse(read_named_file(file, LargestInput::table));
    if (kept.at("key") != key) return {};
    for (const json& one : kept.at("errors")) {
      const json& error = one.at("error_jnd");
      errors.push_back(
          {.recording = one.at("recording"),
           .law = one.at("law"),
           .error_jnd = error.is_null() ? std::numeric_limits<double>::quiet_NaN() : error.get<double>()});
    }
  } catch (const std::exception&) {
    return {};  // it is made anew
  }
  return errors;
}

}  // namespace

fs::path kept_errors_file(const std::vector<DrawerRecording>& recordings,
                          const std::vector<std::size_t>& group, const StudyPlan& plan,
                          const fs::path& folder) {
  return folder / "held_out" / (key_of_group(plan, recordings, group).substr(0, 16) + ".json");
}

std::vector<ErrorOnOthers> errors_on_others(const StudyPlan& plan,
                                            const std::vector<DrawerRecording>& recordings,
                                            const std::vector<std::size_t>& group, const fs::path& folder,
                                            std::size_t threads, const std::atomic<bool>& stop) {
  if (group.size() < 2) return {};
  const std::string key = key_of_group(plan, recordings, group);
  const fs::path file = kept_errors_file(recordings, group, plan, folder);
  std::vector<ErrorOnOthers> errors = kept_errors(file, key);
  if (!errors.empty()) return errors;
  const GroupSources all = sources_of_group(plan, recordings, group, folder);
  const std::vector<Fold> folds = folds_of(recordings, group);
  std::vector<std::vector<ErrorOnOthers>> of_folds(folds.size());
  for_each_index(folds.size(), threads,
                 [&](std::size_t i) { of_folds[i] = errors_of_fold(all, folds[i], stop); });
  json kept{{"key", key}, {"errors", json::array()}};
  for (std::vector<ErrorOnOthers>& fold : of_folds) {
    for (ErrorOnOthers& error : fold) {
      kept["errors"].push_back(
          {{"recording", error.recording},
           {"law", error.law},
           {"error_jnd", std::isfinite(error.error_jnd) ? json(error.error_jnd) : json(nullptr)}});
      errors.push_back(std::move(error));
    }
  }
  fs::create_directories(file.parent_path());
  write_json_file(file, kept);
  return errors;
}

}  // namespace kerf::bench
