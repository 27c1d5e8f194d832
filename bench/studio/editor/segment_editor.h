#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <kerf/fitting/fit.h>
#include <kerf/models/law.h>
#include <kerf/schema/recording.h>

#include "laws/law_file.h"

namespace kerf::bench {

/// The averaged cycle of an axis, as a law of segments is drawn over it ([Okamura2003], section 3.2).
///
/// Penetration grows along the contact's direction from its position, both as `kerf fit` takes them
/// (contact_of()); a positive force resists growing penetration, so an opening that resists opening is
/// negative. Closing is the direction in which the penetration grows.
struct EditorCurve {
  std::string axis;
  std::string position_unit;  ///< "m" or "rad"
  std::string force_unit;     ///< "N" or "N·m": that of every force here and in what is made from it
  std::size_t cycles = 0;
  bool segmented_here = false;  ///< the recording has no cycles of this axis: found as `kerf segment` does
  models::Contact contact;
  std::vector<double> penetration;  ///< increasing
  std::vector<double> closing;      ///< mean over the cycles; NaN where fewer than half of them reached
  std::vector<double> opening;
  /// In the unit of the force: the threshold of a torque is that of a force at the axis' lever, or at 10 mm
  /// where it names none.
  fitting::Jnd jnd;
};

/// Breakpoints of a law of segments.
struct Knots {
  std::vector<double> penetration;  ///< increasing, 2 to 17
  std::vector<double> closing;      ///< force at each
  std::vector<double> opening;      ///< likewise; empty: one branch
};

/// How far a law is from the averaged cycle, at every finite point of the branches that it has. A law of one
/// branch is compared with the closing.
struct LawError {
  double rmse_n = 0.0;
  double worst_n = 0.0;  ///< the largest error, not negative
  double worst_penetration = 0.0;
  bool worst_is_closing = true;
  double jnd_n = 0.0;  ///< at the root mean square force of the points
  double rmse_jnd = 0.0;
  double worst_jnd = 0.0;  ///< the largest error in JNDs of the averaged force at that place
};

/// What a drawn law has to know of its recording beside the curve.
struct CurveSource {
  std::string recording_uuid;
  std::string recording_sha256;
  std::string recording_content{};
  models::Options rendering_aids;  ///< of a law with two branches: with_rendering_aids()
};

/// @throws std::invalid_argument as find_cycles() and axis_series() do.
[[nodiscard]] EditorCurve editor_curve(const schema::Recording& recording, std::size_t axis);

/// Without the SHA-256, which is the file's. @throws std::invalid_argument as axis_series() does.
[[nodiscard]] CurveSource curve_source(const schema::Recording& recording, std::size_t axis,
                                       const EditorCurve& curve);

/// @throws std::invalid_argument, one sentence for each fault: not 2 to 17 breakpoints, another number of
///         forces, a number that is not finite or beyond the law's bounds, penetrations that do not increase.
void check_knots(const Knots& knots);

/// @throws std::invalid_argument as check_knots() does, or if the curve has no point on the law's branches.
[[nodiscard]] LawError law_error(const EditorCurve& curve, const Knots& knots);

/// The breakpoints with the least error (fitting::fit_segments). @throws std::invalid_argument: not 1 to 16
/// segments, a branch without points, or too few points for as many segments.
[[nodiscard]] Knots best_knots(const EditorCurve& curve, std::size_t segments, bool loop);

/// The forces with the least error at the penetrations of these breakpoints, on the branches that they have.
/// @throws std::invalid_argument as check_knots() does, or if the points leave the force at a knot open.
[[nodiscard]] Knots best_forces(const EditorCurve& curve, const Knots& knots);

/// The law as it will be rendered. @throws std::invalid_argument as law_error() does.
[[nodiscard]] LawFile drawn_law(const EditorCurve& curve, const Knots& knots, const CurveSource& source);

/// The breakpoints of a law file. @throws std::invalid_argument if it is not a piecewise law.
[[nodiscard]] Knots knots_of(const LawFile& file);

}  // namespace kerf::bench
