#include "kerf/fitting/calibration/load_checks.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/SVD>

#include "calibration/design.h"

namespace kerf::fitting::calibration {
namespace {

/// Shares of full scale below which a direction of loads is taken for missing.
constexpr double smallest_share = 1e-3;

/// "fx and ty", of a direction in the space of loads.
std::string components_in(const Eigen::VectorXd& direction, const std::vector<std::string>& names) {
  std::string text;
  for (Eigen::Index k = 0; k < direction.size(); ++k) {
    if (std::abs(direction(k)) < 0.1 * direction.cwiseAbs().maxCoeff()) continue;
    text += (text.empty() ? "" : " and ") + names[static_cast<std::size_t>(k)];
  }
  return text;
}

}  // namespace

std::string undetermined(const Holds& holds) {
  require_sound(holds);
  const Eigen::MatrixXd loads = loads_of(holds);
  for (Eigen::Index k = 0; k < loads.cols(); ++k) {
    const std::string& name = holds.components[static_cast<std::size_t>(k)];
    if (loads.col(k).cwiseAbs().maxCoeff() <= 0.0) return "no load along " + name + ": add one";
    if (loads.col(k).maxCoeff() <= loads.col(k).minCoeff()) {
      return "the load along " + name +
             " is the same in every row, and cannot be told from the reading without load: add one without "
             "it";
    }
  }
  Eigen::MatrixXd alone = loads_alone(design_of(holds, {}));
  for (Eigen::Index k = 0; k < alone.cols(); ++k) {
    if (alone.col(k).norm() < smallest_share * std::sqrt(static_cast<double>(alone.rows()))) {
      return "the load along " + holds.components[static_cast<std::size_t>(k)] +
             " changes with time or temperature alone, and cannot be told from drift: take it off and put it "
             "on "
             "again";
    }
    alone.col(k) /= alone.col(k).norm();
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(alone, Eigen::ComputeThinV);
  const Eigen::VectorXd& values = svd.singularValues();
  const Eigen::Index last = values.size() - 1;
  if (values(last) >= smallest_share * values(0) && alone.rows() >= alone.cols()) return "";
  return components_in(svd.matrixV().col(last), holds.components) +
         " cannot be told apart: every load that has one has the others in the same proportion; add one with "
         "another direction or another lever arm";
}

std::optional<NextLoad> next_load(const Holds& holds, const std::vector<Candidate>& candidates) {
  require_sound(holds);
  const Design design = design_of(holds, {});
  const Eigen::Index m = design.components();
  Eigen::MatrixXd information = design.columns.transpose() * design.columns;
  // Where nothing is known of a direction yet, whatever tells of it comes first.
  information.diagonal().array() += 1e-9 * std::max(1.0, information.diagonal().maxCoeff());
  const Eigen::LDLT<Eigen::MatrixXd> factor(information);
  std::optional<NextLoad> best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Eigen::VectorXd row = design.columns.row(design.columns.rows() - 1);
    for (Eigen::Index k = 0; k < m; ++k)
      row(k) = candidates[i].load[static_cast<std::size_t>(k)] / design.full_scale(k);
    const double gain = 1.0 + row.dot(factor.solve(row));
    if (!best || gain > best->gain * (1.0 + 1e-9)) best = {.candidate = i, .gain = gain};
  }
  return best;
}

std::vector<SignalFault> signal_faults(const Holds& holds, const std::vector<double>& noise, double range) {
  require_sound(holds);
  std::vector<SignalFault> faults;
  const Eigen::MatrixXd loads = loads_of(holds);
  const auto under_other_load = [&](const std::vector<std::size_t>& rows) {
    return std::ranges::any_of(rows, [&](std::size_t row) {
      const auto at = static_cast<Eigen::Index>(row);
      const auto first = static_cast<Eigen::Index>(rows.front());
      return (loads.row(at) - loads.row(first)).cwiseAbs().maxCoeff() > 0.0;
    });
  };
  for (std::size_t i = 0; i < holds.signals.size(); ++i) {
    const Eigen::VectorXd signal = signal_of(holds, i);
    const double moved = signal.maxCoeff() - signal.minCoeff();
    if (!(moved > 5.0 * (i < noise.size() ? noise[i] : 0.0))) {
      faults.push_back({.kind = SignalFault::Kind::dead, .signal = i, .value = moved});
      continue;
    }
    for (const double end : {signal.minCoeff(), signal.maxCoeff()}) {
      std::vector<std::size_t> there;
      for (std::size_t row = 0; row < holds.holds.size(); ++row) {
        const double value = signal(static_cast<Eigen::Index>(row));
        if (std::abs(value - end) <= 1e-9 * moved || std::abs(value) >= range) there.push_back(row);
      }
      const bool at_range = std::abs(end) >= range;
      if (at_range || (there.size() > 1 && end != 0.0 && under_other_load(there))) {
        faults.push_back(
            {.kind = SignalFault::Kind::saturated, .signal = i, .value = end, .holds = std::move(there)});
        break;
      }
    }
  }
  return faults;
}

std::vector<std::pair<std::size_t, std::size_t>> copies(const Holds& holds) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t i = 0; i < holds.holds.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (holds.holds[i].load == holds.holds[j].load && holds.holds[i].signal == holds.holds[j].signal) {
        found.emplace_back(j, i);
        break;
      }
    }
  }
  return found;
}

}  // namespace kerf::fitting::calibration
