#include "fits/judged_rows.h"

#include <algorithm>
#include <string>

#include <kerf/fitting/jnd.h>

#include "segment/cycle_edit.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

/// Whether the fit is of these cycles, by their numbers.
bool has_the_cycles_of(const schema::Recording& recording, const json& fits) {
  const std::string cycles = cycles_sha256_of(recording);
  const json& all = fits.value("recordings", json::array());
  return std::ranges::any_of(all, [&](const json& one) {
    const json& its = one.value("cycles_sha256", json());
    return its.is_string() && its.get<std::string>() == cycles;
  });
}

RowChoice choice_of(const json& settings, const schema::Recording& recording, const json& fits) {
  RowChoice choice;
  if (settings.value("rows", "contact") == "all") choice.rows = Counted::all;
  choice.cycles = parse_cycle_choice(settings.value("cycles", "good"));
  const bool are_there = recording.cycles && has_the_cycles_of(recording, fits);
  if (choice.cycles.by == CycleChoice::By::listed && !are_there) choice.cycles = {};
  return choice;
}

}  // namespace

CountedRows mark_judged(AxisSeries& series, const schema::Recording& recording, std::size_t axis,
                        const json& fits) {
  const schema::Axis& about = recording.axes.at(axis);
  double felt = fitting::jnd_of(about.force_unit, about.lever).threshold;
  if (!fits.is_object() || !fits.contains("settings")) return mark_counted(series, recording, axis, {}, felt);
  const json& settings = fits.at("settings");
  felt = settings.value("threshold", felt);
  return mark_counted(series, recording, axis, choice_of(settings, recording, fits), felt);
}

}  // namespace kerf::bench
