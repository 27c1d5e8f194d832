#include "replay/table.h"

#include <stdexcept>

#include <fmt/core.h>

#include "laws/render.h"
#include "recordings/axes.h"

namespace kerf::bench {

FittedLaw table_of(const schema::Recording& recording, const std::string& name, const std::string& axis,
                   const std::optional<models::Contact>& contact) {
  FitRecordingOptions options{.models = {"recording"},
                              .rows = {.rows = Counted::all, .cycles = {.by = CycleChoice::By::all}},
                              .floor = false};
  options.axis = axis.empty() && recording.cycles ? recording.cycles->axis : find_axis(recording, axis);
  options.contact = contact ? *contact : contact_of(recording, options.axis);
  RecordingFit fit = fit_recording(recording, options);
  if (fit.laws.empty())
    throw std::invalid_argument(fmt::format("{}: no table can be made of it: {}", name,
                                            fit.refusals.empty() ? "no law" : fit.refusals[0].why));
  return std::move(fit.laws.front());
}

}  // namespace kerf::bench
