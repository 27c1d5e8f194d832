#include "drawer/suggest_blank.h"

#include <cmath>
#include <exception>
#include <set>

#include <fmt/core.h>

#include "prepare/blank.h"
#include "recordings/whole_recording.h"
#include "run/study_blanks.h"
#include "segment/segment.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr double most_spread = 0.5;  // of what is taken off, as remove_blank() warns

struct BlankForce {
  double rms = 0.0;
  double spread_rms = 0.0;
  std::string unit;
};

BlankForce force_of_blank(const fs::path& path, const ImportFile& import) {
  if (path.extension() != ".h5" && import.map.empty()) throw std::invalid_argument("its columns are unknown");
  schema::Recording blank =
      path.extension() == ".h5" ? read_whole_recording(path) : import_text(path, import.options).recording;
  if (!blank.cycles) blank.cycles = find_cycles(blank, {});
  const std::size_t axis = blank.cycles->axis;
  const ToolForce tool = tool_force(blank, axis, blank.cycles->closing_direction);
  double squares = 0.0;
  double spreads = 0.0;
  double count = 0.0;
  for (const BlankBranch* branch : {&tool.closing, &tool.opening}) {
    for (std::size_t i = 0; i < branch->mean.size(); ++i) {
      if (!std::isfinite(branch->mean[i])) continue;
      squares += branch->mean[i] * branch->mean[i];
      spreads += branch->spread[i] * branch->spread[i];
      count += 1.0;
    }
  }
  if (count == 0.0) throw std::invalid_argument("no position was reached by two of its cycles");
  return {.rms = std::sqrt(squares / count),
          .spread_rms = std::sqrt(spreads / count),
          .unit = blank.axes.at(axis).force_unit};
}

}  // namespace

BlankSuggestion suggest_blank(const StudyPlan& plan,
                              const std::function<ImportFile(const DrawerFile&)>& import_of) {
  std::set<std::size_t> blanks;
  std::size_t others = 0;
  std::size_t served = 0;
  for (const DrawerFile& file : plan.files) {
    if (!file.ignored.empty() || file.blank) continue;
    ++others;
    const std::vector<std::size_t> fitting = fitting_blanks(plan, file);
    served += fitting.empty() ? 0 : 1;
    blanks.insert(fitting.begin(), fitting.end());
  }
  if (blanks.empty()) return {.subtract = false, .why = "no file is a blank of the rig and speed of another"};
  double most = 0.0;
  for (const std::size_t at : blanks) {
    const DrawerFile& file = plan.files[at];
    try {
      const BlankForce force = force_of_blank(plan.folder / fs::path(file.path), import_of(file));
      if (!(force.spread_rms <= most_spread * force.rms))
        return {
            .subtract = false,
            .why = fmt::format("{} meets {:.2g} {} (rms), which differs by {:.2g} {} from one of its cycles "
                               "to the next: what would be taken off is hardly known",
                               file.path, force.rms, force.unit, force.spread_rms, force.unit)};
      most = std::max(most, force.spread_rms / force.rms);
    } catch (const std::exception& error) {
      return {.subtract = false, .why = fmt::format("{} says nothing: {}", file.path, error.what())};
    }
  }
  return {.subtract = true,
          .why = fmt::format("{} of {} recordings have a blank of their rig and speed, which differs from "
                             "cycle to cycle by {:.0f} % of what it meets at most",
                             served, others, 100.0 * most)};
}

}  // namespace kerf::bench
