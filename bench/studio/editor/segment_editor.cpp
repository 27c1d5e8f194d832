#include "editor/segment_editor.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include <kerf/fitting/segmented.h>
#include <kerf/models/piecewise.h>

#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_knots = models::Piecewise<double>::max_segments + 1;
constexpr double bound = 1e6;  // of the law's parameters

models::Piecewise<double> law_of(const Knots& knots) {
  models::Piecewise<double> law;
  law.knots = knots.penetration.size();
  law.loop = !knots.opening.empty();
  std::copy(knots.penetration.begin(), knots.penetration.end(), law.knot.begin());
  std::copy(knots.closing.begin(), knots.closing.end(), law.closing.begin());
  std::copy(knots.opening.begin(), knots.opening.end(), law.opening.begin());
  return law;
}

/// The finite points of a curve, one after the other.
struct CurvePoints {
  std::vector<double> penetration;
  std::vector<double> force;
  std::vector<std::uint8_t> branch;  ///< 0 closing, 1 opening

  [[nodiscard]] fitting::Curve view(bool loop) const {
    return {.position = penetration,
            .force = force,
            .weight = {},
            .branch = loop ? std::span<const std::uint8_t>(branch) : std::span<const std::uint8_t>()};
  }
};

CurvePoints points_of(const EditorCurve& curve, bool loop) {
  CurvePoints points;
  const std::uint8_t branches = loop ? 2 : 1;
  for (std::uint8_t branch = 0; branch < branches; ++branch) {
    const std::vector<double>& force = branch == 0 ? curve.closing : curve.opening;
    for (std::size_t i = 0; i < curve.penetration.size(); ++i) {
      if (!std::isfinite(force[i])) continue;
      points.penetration.push_back(curve.penetration[i]);
      points.force.push_back(force[i]);
      points.branch.push_back(branch);
    }
  }
  return points;
}

/// To fit to: at least one point on each branch.
CurvePoints points_to_fit(const EditorCurve& curve, bool loop) {
  CurvePoints points = points_of(curve, loop);
  const std::uint8_t branches = loop ? 2 : 1;
  for (std::uint8_t branch = 0; branch < branches; ++branch) {
    if (std::find(points.branch.begin(), points.branch.end(), branch) != points.branch.end()) continue;
    throw std::invalid_argument(branch == 0 ? "the averaged cycle has no closing to fit"
                                            : "the averaged cycle has no opening to fit; take one branch");
  }
  return points;
}

Knots knots_from(const fitting::SegmentedCurve& curve) {
  return {.penetration = curve.knots,
          .closing = curve.force.front(),
          .opening = curve.force.size() > 1 ? curve.force[1] : std::vector<double>{}};
}

/// On the line through (x0, y0) and (x1, y1).
double on_line(double x, double x0, double y0, double x1, double y1) {
  return y0 + (y1 - y0) * ((x - x0) / (x1 - x0));
}

void check_forces(const Knots& knots, const std::vector<double>& forces, std::string_view branch) {
  if (forces.size() != knots.penetration.size()) {
    throw std::invalid_argument(fmt::format("there are {} {} forces for {} breakpoints; give one for each",
                                            forces.size(), branch, knots.penetration.size()));
  }
}

void check_bounds(const std::vector<double>& values, std::string_view what) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      throw std::invalid_argument(fmt::format("the {} of breakpoint {} is not a number", what, i + 1));
    }
    if (std::abs(values[i]) > bound) {
      throw std::invalid_argument(fmt::format("the {} of breakpoint {} is {:g}, and a law takes {:g} to {:g}",
                                              what, i + 1, values[i], -bound, bound));
    }
  }
}

}  // namespace

void check_knots(const Knots& knots) {
  const std::size_t count = knots.penetration.size();
  if (count < 2 || count > max_knots) {
    throw std::invalid_argument(
        fmt::format("a law takes 2 to {} breakpoints, and here are {}", max_knots, count));
  }
  check_forces(knots, knots.closing, "closing");
  if (!knots.opening.empty()) check_forces(knots, knots.opening, "opening");
  check_bounds(knots.penetration, "penetration");
  check_bounds(knots.closing, "closing force");
  check_bounds(knots.opening, "opening force");
  for (std::size_t i = 1; i < count; ++i) {
    if (knots.penetration[i - 1] < knots.penetration[i]) continue;
    throw std::invalid_argument(fmt::format("breakpoint {} at {:g} must be deeper than breakpoint {} at {:g}",
                                            i + 1, knots.penetration[i], i, knots.penetration[i - 1]));
  }
}

LawError law_error(const EditorCurve& curve, const Knots& knots) {
  check_knots(knots);
  const models::Piecewise<double> law = law_of(knots);
  const CurvePoints points = points_of(curve, law.loop);
  if (points.force.empty())
    throw std::invalid_argument("the averaged cycle has no point to compare a law with");
  LawError error{.worst_n = -1.0};
  double squares = 0.0;
  double force_squares = 0.0;
  for (std::size_t i = 0; i < points.force.size(); ++i) {
    const bool closing = points.branch[i] == 0;
    const double off = std::abs(law.branch_force(closing, points.penetration[i]) - points.force[i]);
    squares += off * off;
    force_squares += points.force[i] * points.force[i];
    if (!(off > error.worst_n)) continue;
    error.worst_n = off;
    error.worst_penetration = points.penetration[i];
    error.worst_is_closing = closing;
    error.worst_jnd = off / curve.jnd.at(points.force[i]);
  }
  const auto count = static_cast<double>(points.force.size());
  error.rmse_n = std::sqrt(squares / count);
  error.jnd_n = curve.jnd.at(std::sqrt(force_squares / count));
  error.rmse_jnd = error.rmse_n / error.jnd_n;
  return error;
}

Knots best_knots(const EditorCurve& curve, std::size_t segments, bool loop) {
  if (segments < 1 || segments >= max_knots) {
    throw std::invalid_argument(
        fmt::format("a law takes 1 to {} segments, and {} were asked for", max_knots - 1, segments));
  }
  const CurvePoints points = points_to_fit(curve, loop);
  const auto curves = fitting::fit_segments(points.view(loop), {.max_segments = segments});
  if (curves.empty() || curves.back().segments() != segments) {
    throw std::invalid_argument(
        fmt::format("the averaged cycle has too few points for {} segments; {} are the most", segments,
                    curves.empty() ? 0 : curves.back().segments()));
  }
  return knots_from(curves.back());
}

Knots best_forces(const EditorCurve& curve, const Knots& knots) {
  check_knots(knots);
  const bool loop = !knots.opening.empty();
  CurvePoints points = points_to_fit(curve, loop);
  // Before its first knot the law goes on with the force there, as if those points were at the knot.
  for (double& penetration : points.penetration)
    penetration = std::max(penetration, knots.penetration.front());
  fitting::SegmentedOptions options{.max_segments = 1};
  options.breakpoints.assign(knots.penetration.begin() + 1, knots.penetration.end() - 1);
  const auto curves = fitting::fit_segments(points.view(loop), options);
  if (curves.empty()) throw std::invalid_argument("the averaged cycle has too few points for a line");
  Knots best = knots_from(curves.back());
  // The ends of the fit are those of the points; along its first and last line to those that are drawn.
  const std::size_t last = best.penetration.size() - 1;
  for (auto* force : {&best.closing, &best.opening}) {
    if (force->empty()) continue;
    const auto at = [&](std::size_t i, std::size_t j, double penetration) {
      return on_line(penetration, best.penetration[i], (*force)[i], best.penetration[j], (*force)[j]);
    };
    const double first_force = at(0, 1, knots.penetration.front());
    const double last_force = at(last - 1, last, knots.penetration.back());
    force->front() = first_force;
    force->back() = last_force;
  }
  best.penetration = knots.penetration;
  return best;
}

LawFile drawn_law(const EditorCurve& curve, const Knots& knots, const CurveSource& source) {
  const LawError error = law_error(curve, knots);
  models::Options options;
  if (!knots.opening.empty()) options = source.rendering_aids;
  options["segments"] = static_cast<double>(knots.penetration.size() - 1);
  options["loop"] = !knots.opening.empty();
  std::vector<double> values;
  for (const auto* part : {&knots.penetration, &knots.closing, &knots.opening})
    values.insert(values.end(), part->begin(), part->end());
  return {.law = models::Law::make("piecewise", values, options),
          .contact = curve.contact,
          .axis = curve.axis,
          .position_unit = curve.position_unit,
          .force_unit = curve.force_unit,
          .std_errors = {},
          .fit = {.recording_uuid = source.recording_uuid,
                  .recording_sha256 = source.recording_sha256,
                  .recording_content = source.recording_content,
                  .rmse_n = error.rmse_n,
                  .date = schema::new_header("").created,
                  .software = software()}};
}

Knots knots_of(const LawFile& file) {
  if (models::law_facts(file.law.model()).search != models::Search::segments) {
    throw std::invalid_argument(
        fmt::format("law '{}' has no breakpoints; the segment editor takes 'piecewise'", file.law.model()));
  }
  const auto& options = file.law.options();
  const auto loop = options.find("loop");
  const std::size_t parts = loop != options.end() && std::get<bool>(loop->second) ? 3 : 2;
  const std::vector<double>& values = file.law.values();
  const auto count = static_cast<std::ptrdiff_t>(values.size() / parts);
  const auto part = [&](std::ptrdiff_t i) {
    return std::vector<double>(values.begin() + i * count, values.begin() + (i + 1) * count);
  };
  return {.penetration = part(0), .closing = part(1), .opening = parts > 2 ? part(2) : std::vector<double>{}};
}

}  // namespace kerf::bench
