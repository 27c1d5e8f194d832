#include "run/study_blanks.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/ranges.h>

#include "prepare/prepare_file.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

/// Without the option that `kerf prepare` has it of, and without the file, which stands beside it.
std::string of_the_study(std::string message, const std::string& name) {
  for (const std::string& begin : {std::string("--blank: "), name + ": "})
    if (message.starts_with(begin)) message.erase(0, begin.size());
  return message;
}

StudiedBlank studied(const BlankTaken& taken) {
  return {.name = taken.file,
          .why_none = "",
          .rows = taken.rows,
          .covered = taken.covered,
          .cycles = taken.tool.used.size(),
          .force_rms = taken.force_rms,
          .taken_rms = taken.taken_rms,
          .spread_rms = taken.spread_rms,
          .negative_before = taken.negative_before,
          .negative_after = taken.negative_after,
          .pulling_share = taken.pulling_share,
          .uncovered = taken.uncovered};
}

}  // namespace

std::vector<std::size_t> fitting_blanks(const StudyPlan& plan, const DrawerFile& file) {
  std::vector<std::size_t> of_its_speed;
  std::vector<std::size_t> of_no_speed;
  if (!file.less_blank.empty()) {
    const auto named = std::ranges::find(plan.files, file.less_blank, &DrawerFile::path);
    if (named == plan.files.end()) return {};
    return {static_cast<std::size_t>(named - plan.files.begin())};
  }
  for (std::size_t i = 0; i < plan.files.size(); ++i) {
    const DrawerFile& blank = plan.files[i];
    if (!blank.blank || !blank.ignored.empty() || blank.rig != file.rig) continue;
    if (blank.speed == file.speed) of_its_speed.push_back(i);
    if (blank.speed.empty()) of_no_speed.push_back(i);
  }
  return of_its_speed.empty() ? of_no_speed : of_its_speed;
}

StudiedBlank take_blank_off(schema::Recording& recording, const StudyBlanks& blanks,
                            std::vector<std::string>& warnings) {
  std::vector<std::string> reasons;
  schema::Recording best;
  std::optional<BlankTaken> taken;
  for (const StudyBlank& blank : blanks.all) {
    if (blank.recording.empty()) {
      reasons.push_back(blank.name + " could not be used");
      continue;
    }
    try {
      BlankOptions options = read_blank(blank.recording);
      options.file = blank.name;
      schema::Recording less = recording;
      BlankTaken one = remove_blank(less, options);
      if (taken && one.covered <= taken->covered) continue;
      best = std::move(less);
      taken = std::move(one);
    } catch (const std::invalid_argument& error) {
      reasons.push_back(fmt::format("{}: {}", blank.name, of_the_study(error.what(), blank.name)));
    }
  }
  if (!taken) {
    StudiedBlank none;
    none.why_none = reasons.empty() ? blanks.why_none : fmt::format("{}", fmt::join(reasons, "; "));
    return none;
  }
  recording = std::move(best);
  add_history(recording.header, "prepare: " + blank_step(*taken));
  for (const std::string& warning : taken->warnings)
    warnings.push_back(fmt::format("blank {}: {}", taken->file, of_the_study(warning, taken->file)));
  return studied(*taken);
}

}  // namespace kerf::bench
