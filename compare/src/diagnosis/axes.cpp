#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>
#include <fmt/core.h>

#include "diagnosis/pair.h"

namespace kerf::compare {
namespace {

/// Channels of one unit, two or three: axes of a space.
using Group = std::vector<const ForcePair*>;

std::vector<Group> groups_of(const std::vector<ForcePair>& pairs) {
  std::vector<Group> groups;
  for (const char* unit : {"N", "N·m"}) {
    Group group;
    for (const ForcePair& one : pairs) {
      if (one.unit == unit) group.push_back(&one);
    }
    const bool some_differ = std::ranges::any_of(group, [](const ForcePair* one) { return one->differs; });
    if (some_differ && (group.size() == 2 || group.size() == 3)) groups.push_back(std::move(group));
  }
  return groups;
}

/// RMS of got - matrix expected over that of the difference, of all channels of a group.
double remainder_of(const Group& group, const Eigen::MatrixXd& matrix) {
  double left = 0.0;
  double all = 0.0;
  const auto size = static_cast<Eigen::Index>(group.size());
  for (std::size_t row = 0; row < group.front()->rows(); ++row) {
    for (Eigen::Index i = 0; i < size; ++i) {
      const ForcePair& one = *group[static_cast<std::size_t>(i)];
      double rest = one.got[row];
      for (Eigen::Index j = 0; j < size; ++j)
        rest -= matrix(i, j) * group[static_cast<std::size_t>(j)]->expected[row];
      left += rest * rest;
      all += one.difference[row] * one.difference[row];
    }
  }
  return all > 0.0 ? std::sqrt(left / all) : 1.0;
}

/// The signed permutation that is nearest, axis by axis; zero where it is none.
Eigen::MatrixXd nearest_permutation(const Group& group) {
  const auto size = static_cast<Eigen::Index>(group.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const ForcePair& got = *group[static_cast<std::size_t>(i)];
    double least = 0.0;
    for (const double square : got.got) least += square * square;
    if (least == 0.0 && !got.differs) matrix(i, i) = 1.0;
    for (Eigen::Index j = 0; j < size; ++j) {
      const ForcePair& from = *group[static_cast<std::size_t>(j)];
      for (const double sign : {1.0, -1.0}) {
        double left = 0.0;
        for (std::size_t row = 0; row < got.rows(); ++row)
          left += std::pow(got.got[row] - sign * from.expected[row], 2);
        if (left >= least) continue;
        least = left;
        matrix.row(i).setZero();
        matrix(i, j) = sign;
      }
    }
  }
  return matrix;
}

std::vector<std::size_t> channels_of(const Group& group) {
  std::vector<std::size_t> channels;
  for (const ForcePair* one : group) {
    if (one->differs) channels.push_back(one->channel);
  }
  return channels;
}

void find_permutation(const Group& group, Findings& found) {
  const Eigen::MatrixXd matrix = nearest_permutation(group);
  if (matrix.cwiseAbs().isIdentity() || (matrix.cwiseAbs().rowwise().sum().array() != 1.0).any() ||
      (matrix.cwiseAbs().colwise().sum().array() != 1.0).any())
    return;
  std::string text;
  Finding finding{
      .change = Change::axes, .channels = channels_of(group), .remainder = remainder_of(group, matrix)};
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Eigen::Index from = 0;
    matrix.row(i).cwiseAbs().maxCoeff(&from);
    if (from == i && matrix(i, i) > 0.0) continue;
    // Their names are put in where all of them are known.
    text += fmt::format("{}{{{}}} is {}{{{}}}", text.empty() ? "" : ", ",
                        group[static_cast<std::size_t>(i)]->channel, matrix(i, from) < 0.0 ? "-" : "",
                        group[static_cast<std::size_t>(from)]->channel);
    finding.numbers.emplace_back(fmt::format("from_{}", group[static_cast<std::size_t>(i)]->channel),
                                 static_cast<double>(group[static_cast<std::size_t>(from)]->channel));
  }
  finding.sentence = "axes took each other's place: " + text;
  if (finding.remainder < guessed_remainder) found.push_back(std::move(finding));
}

void find_rotation(const Group& group, Findings& found) {
  const auto size = static_cast<Eigen::Index>(group.size());
  Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(size, size);  // got expected^T
  for (std::size_t row = 0; row < group.front()->rows(); ++row) {
    for (Eigen::Index i = 0; i < size; ++i) {
      for (Eigen::Index j = 0; j < size; ++j)
        cross(i, j) +=
            group[static_cast<std::size_t>(i)]->got[row] * group[static_cast<std::size_t>(j)]->expected[row];
    }
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::VectorXd signs = Eigen::VectorXd::Ones(size);
  signs[size - 1] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::MatrixXd turned = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  const double cosine = size == 3 ? 0.5 * (turned.trace() - 1.0) : 0.5 * turned.trace();
  const double angle_deg = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi;
  if (angle_deg < 1e-3) return;
  Finding finding{.change = Change::rotation,
                  .channels = channels_of(group),
                  .remainder = remainder_of(group, turned),
                  .sentence = fmt::format("the axes are turned by {:.4g} deg", angle_deg),
                  .numbers = {{"deg", angle_deg}}};
  if (size == 3 && angle_deg < 179.9) {
    Eigen::Vector3d axis(turned(2, 1) - turned(1, 2), turned(0, 2) - turned(2, 0),
                         turned(1, 0) - turned(0, 1));
    axis.normalize();
    axis = (1e6 * axis).array().round() / 1e6 + 0.0;  // and no -0
    finding.sentence += fmt::format(" about ({:.3g}, {:.3g}, {:.3g})", axis.x(), axis.y(), axis.z());
  }
  if (finding.remainder < guessed_remainder) found.push_back(std::move(finding));
}

}  // namespace

void find_axes(const std::vector<ForcePair>& pairs, Findings& found) {
  for (const Group& group : groups_of(pairs)) {
    find_permutation(group, found);
    find_rotation(group, found);
  }
}

}  // namespace kerf::compare
