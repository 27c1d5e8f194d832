#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include "kerf/models/blade.h"

namespace kerf::models {
namespace {

using Eigen::Vector3d;

/// Takes the text up to a divider off the front of `rest`.
std::string_view next_part(std::string_view& rest, char divider) {
  const auto end = std::min(rest.find(divider), rest.size());
  const std::string_view part = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return part;
}

Vector3d parse_point(std::string_view text, std::string_view option) {
  std::istringstream stream{std::string(text)};
  stream.imbue(std::locale::classic());
  Vector3d point;
  std::string more;
  if (!(stream >> point.x() >> point.y() >> point.z()) || stream >> more || !point.allFinite() ||
      point.cwiseAbs().maxCoeff() > 1e3) {
    throw std::invalid_argument(
        "law 'blade', option '" + std::string(option) + "': \"" + std::string(text) +
        "\" is not a point; expected three numbers in metres, such as \"0.005 0 -0.112\"");
  }
  return point;
}

std::vector<Vector3d> parse_points(std::string_view text, std::string_view option) {
  std::vector<Vector3d> points;
  while (!text.empty()) points.push_back(parse_point(next_part(text, ','), option));
  return points;
}

[[noreturn]] void refuse_polygon(std::size_t number, const std::string& why) {
  throw std::invalid_argument("law 'blade', option 'polygons': polygon " + std::to_string(number) + ' ' +
                              why);
}

BladeShape::Polygon polygon_of(const std::vector<Vector3d>& points, std::size_t number) {
  if (points.size() < 3 || points.size() > BladeShape::max_corners) {
    refuse_polygon(number, "has " + std::to_string(points.size()) + " corners, expected 3 to " +
                               std::to_string(BladeShape::max_corners));
  }
  BladeShape::Polygon polygon;
  polygon.corners = points.size();
  std::copy(points.begin(), points.end(), polygon.corner.begin());
  Vector3d twice_area = Vector3d::Zero();
  double size = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) size = std::max(size, (points[i] - points[0]).norm());
  for (std::size_t i = 2; i < points.size(); ++i) {
    twice_area += (points[i - 1] - points[0]).cross(points[i] - points[0]);
  }
  if (!(twice_area.norm() > 1e-9 * size * size)) refuse_polygon(number, "has no area");
  polygon.normal = twice_area.normalized();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d side = points[(i + 1) % points.size()] - points[i];
    if (std::abs(polygon.normal.dot(points[i] - points[0])) > 1e-6 * size)
      refuse_polygon(number, "is not planar");
    for (const Vector3d& point : points) {
      if (side.cross(point - points[i]).dot(polygon.normal) < -1e-9 * size * size) {
        refuse_polygon(number, "is not convex");
      }
    }
  }
  const Vector3d first_side = points[1] - points[0];
  if (!(first_side.norm() > 1e-9 * size)) refuse_polygon(number, "begins with the same corner twice");
  polygon.across = first_side.normalized();
  return polygon;
}

}  // namespace

BladeShape BladeShape::parse(std::string_view polygons, std::string_view edge) {
  BladeShape shape;
  while (!polygons.empty()) {
    const auto points = parse_points(next_part(polygons, ';'), "polygons");
    if (shape.polygons == max_polygons) {
      throw std::invalid_argument("law 'blade', option 'polygons': more than " +
                                  std::to_string(max_polygons) + " polygons");
    }
    shape.polygon[shape.polygons] = polygon_of(points, shape.polygons + 1);
    ++shape.polygons;
  }
  const auto ends = parse_points(edge, "edge");
  if (!ends.empty() && ends.size() != 2) {
    throw std::invalid_argument("law 'blade', option 'edge': " + std::to_string(ends.size()) +
                                " points, expected the two ends or nothing");
  }
  shape.has_edge = !ends.empty();
  if (shape.has_edge) shape.edge = {ends[0], ends[1]};
  if (shape.polygons == 0 && !shape.has_edge) {
    throw std::invalid_argument("law 'blade': neither polygons nor an edge; it would never be felt");
  }
  return shape;
}

}  // namespace kerf::models
