#include <algorithm>
#include <stdexcept>
#include <utility>

#include <kerf/fitting/jnd.h>
#include <kerf/schema/recorded_rows.h>

#include "editor/segment_editor.h"
#include "fits/fit_recording.h"
#include "inspect/flagged_cycles.h"
#include "laws/render.h"
#include "recordings/axis_series.h"
#include "segment/segment.h"

namespace kerf::bench {
namespace {

/// Without samples: contact_of() then says what it knows from a scene, an onset or the cycles.
models::Contact contact_with(const schema::Recording& recording, std::size_t axis,
                             const schema::Cycles& cycles) {
  schema::Recording about;
  about.header = recording.header;
  about.axes = recording.axes;
  about.cycles = cycles;
  return contact_of(about, axis);
}

}  // namespace

EditorCurve editor_curve(const schema::Recording& recording, std::size_t axis) {
  if (axis >= recording.dimensions()) throw std::invalid_argument("the recording has no such axis");
  const bool has_cycles = recording.cycles && recording.cycles->axis == axis;
  const schema::Cycles cycles = has_cycles ? *recording.cycles : find_cycles(recording, {.axis = axis});
  const schema::Axis& about = recording.axes[axis];
  const fitting::Jnd jnd = fitting::jnd_of(about.force_unit, about.lever);
  CycleMeans means = means_of_good_cycles(schema::RowsInMemory(recording), cycles, jnd.threshold);
  EditorCurve curve{.axis = about.name,
                    .position_unit = about.position_unit,
                    .force_unit = about.force_unit,
                    .cycles = means.cycles,
                    .segmented_here = !has_cycles,
                    .contact = contact_with(recording, axis, cycles),
                    .penetration = {},
                    .closing = std::move(means.closing),
                    .opening = std::move(means.opening),
                    .jnd = jnd};
  const double direction = curve.contact.direction;
  for (const double position : cycles.grid) {
    curve.penetration.push_back(direction * (position - curve.contact.position));
  }
  // A law closes where the penetration grows, whatever the strokes are called in the recording.
  if (direction != cycles.closing_direction) std::swap(curve.closing, curve.opening);
  if (direction < 0.0) {
    for (auto* values : {&curve.penetration, &curve.closing, &curve.opening})
      std::reverse(values->begin(), values->end());
  }
  if (recording.force_measured.empty()) {  // as axis_series() has it
    for (auto* forces : {&curve.closing, &curve.opening}) {
      for (double& force : *forces) force *= -direction;
    }
  }
  return curve;
}

CurveSource curve_source(const schema::Recording& recording, std::size_t axis, const EditorCurve& curve) {
  return {
      .recording_uuid = recording.header.uuid,
      .recording_sha256 = {},
      .rendering_aids = with_rendering_aids({{"loop", true}}, fit_series(recording, axis, curve.contact))};
}

}  // namespace kerf::bench
