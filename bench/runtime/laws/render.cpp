#include "laws/render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include <kerf/models/branch.h>

#include "laws/law_toml.h"

namespace kerf::bench {

models::Contact contact_of(const schema::Recording& recording, std::size_t axis) {
  if (!recording.header.scene_toml.empty()) {
    const toml::table scene = parse_toml(recording.header.scene_toml, "the recording's scene");
    if (const toml::table* tissue = scene["tissue"].as_table()) {
      const LawFile law = law_from_table(*tissue, "the recording's scene", {"until"});
      if (law.axis == recording.axes.at(axis).name) return law.contact;
    }
  }
  const schema::Axis& about = recording.axes.at(axis);
  if (std::isfinite(about.contact_position) && std::isfinite(about.contact_direction)) {
    return {.position = about.contact_position, .direction = about.contact_direction};
  }
  if (recording.cycles && recording.cycles->axis == axis) {
    return {.position = recording.cycles->contact_position, .direction = recording.cycles->closing_direction};
  }
  double smallest = recording.rows() > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    smallest = std::fmin(smallest, recording.position[row * recording.dimensions() + axis]);
  }
  return {.position = smallest, .direction = 1.0};
}

models::Law without_rendering_aids(const models::Law& law) {
  models::Options options = law.options();
  for (const models::OptionInfo& aid : models::BranchSelector::options()) options.erase(aid.name);
  return models::Law::make(law.model(), law.values(), options);
}

std::vector<double> render(const models::Law& law, const AxisSeries& series) {
  std::vector<double> force;
  force.reserve(series.time_s.size());
  models::Law::State state = law.initial_state();
  for (std::size_t i = 0; i < series.time_s.size(); ++i) {
    // The first row has no period before it; the next one's stands in, since a law only starts there.
    const std::size_t end = std::min(std::max<std::size_t>(i, 1), series.time_s.size() - 1);
    const double period_s = end > 0 ? series.time_s[end] - series.time_s[end - 1] : 1e-3;
    force.push_back(
        law.step(state, {.penetration = series.penetration[i], .velocity = series.velocity[i]}, period_s)
            .force);
  }
  return force;
}

}  // namespace kerf::bench
