#include "run/blank_parts.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

#include <kerf/fitting/jnd.h>
#include <kerf/schema/recorded_rows.h>

#include "inspect/flagged_cycles.h"
#include "laws/render.h"
#include "prepare/blank_off.h"
#include "prepare/prepare_file.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_parts = 10;
constexpr double not_found = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> laws_with_parameters(const StudiedRecording& result) {
  std::vector<std::string> models;
  for (const StudiedLaw& law : result.laws)
    if (law.can_be_chosen && !law.parameters.empty()) models.push_back(law.model);
  return models;
}

void add_cycles(const schema::Recording& recording, const StudiedRecording& result, double felt,
                bool all_cycles, QuantityValues& values) {
  std::vector<double> peaks;
  std::vector<double> works;
  for (const FlaggedCycle& cycle : flagged_cycles(schema::RowsInMemory(recording), *recording.cycles, felt)) {
    const auto judged = std::ranges::find(result.cycles, cycle.facts.number, &StudiedCycle::number);
    if (judged == result.cycles.end() || (!judged->is_good && !all_cycles)) continue;
    peaks.push_back(cycle.facts.peak);
    works.push_back(cycle.facts.closing_work);
  }
  const auto mean = [](const std::vector<double>& of) {
    return of.empty() ? not_found
                      : std::accumulate(of.begin(), of.end(), 0.0) / static_cast<double>(of.size());
  };
  values["peak"] = mean(peaks);
  values["work"] = mean(works);
}

void add_parameters(const schema::Recording& recording, const BeforeBlank& before,
                    std::vector<RowSpan> uncovered, const StudiedRecording& result, QuantityValues& values) {
  for (const StudiedLaw& law : result.laws)
    for (const StudiedParameter& parameter : law.parameters)
      values[law.model + "." + parameter.name] = not_found;
  const FitSource source{.recording = &recording,
                         .name = "recording",
                         .axis = before.axis,
                         .contact = contact_of(recording, before.axis),
                         .not_the_tissue = std::move(uncovered)};
  FitRecordingOptions options = before.options;
  options.models = laws_with_parameters(result);
  options.floor = false;
  options.fit.folds = 0;
  options.fit.intervals = fitting::Intervals::white;
  if (options.models.empty()) return;
  const RecordingFit fit = fit_recordings(std::span(&source, 1), options);
  for (const FittedLaw& law : fit.laws) {
    if (!law.result.can_be_chosen()) continue;
    for (const fitting::Estimate& estimate : law.result.parameters)
      values[law.result.model + "." + estimate.info.name] = estimate.value;
  }
}

}  // namespace

std::vector<QuantityValues> without_parts(const BeforeBlank& before, const StudiedRecording& result,
                                          bool all_cycles) {
  const std::size_t parts = std::min(result.blank->cycles, most_parts);
  BlankOptions blank = read_blank(before.blank);
  const schema::Axis& along = before.recording->axes[before.axis];
  const double felt = fitting::jnd_of(along.force_unit, along.lever).threshold;
  std::vector<QuantityValues> all;
  for (std::size_t part = 0; part < parts; ++part) {
    blank.left_out = CyclePart{.part = part, .parts = parts};
    schema::Recording less = *before.recording;
    QuantityValues& values = all.emplace_back();
    try {
      const BlankTaken taken = remove_blank(less, blank);
      add_cycles(less, result, felt, all_cycles, values);
      add_parameters(less, before, taken.uncovered, result, values);
    } catch (const std::invalid_argument&) {
      continue;  // without this part the rest covers too little: what is not there is not known
    }
  }
  return all;
}

}  // namespace kerf::bench
