#include "calibration/design.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/QR>

namespace kerf::fitting::calibration {
namespace {

bool all_finite(const std::vector<double>& numbers) {
  return std::ranges::all_of(numbers, [](double one) { return std::isfinite(one); });
}

}  // namespace

void require_sound(const Holds& holds) {
  if (holds.holds.empty()) throw std::invalid_argument("there is no load: nothing to calibrate by");
  if (holds.components.empty() || holds.signals.empty())
    throw std::invalid_argument("a calibration needs a signal and a component of load at least");
  if (holds.signals.size() < holds.components.size()) {
    throw std::invalid_argument(std::to_string(holds.signals.size()) + " signals cannot tell " +
                                std::to_string(holds.components.size()) +
                                " components; give as many signals at least");
  }
  for (const Hold& hold : holds.holds) {
    const std::string where = "row " + std::to_string(hold.row) + ": ";
    if (hold.load.size() != holds.components.size() || hold.signal.size() != holds.signals.size())
      throw std::invalid_argument(where + "it has another number of components or signals");
    if (!all_finite(hold.load) || !all_finite(hold.signal) || !std::isfinite(hold.time_s))
      throw std::invalid_argument(where + "not every number is finite; leave the row out or mend it");
  }
  const auto rows = static_cast<Eigen::Index>(holds.holds.size() * holds.components.size());
  if (holds.load_error.cols() > 0 && holds.load_error.rows() != rows)
    throw std::invalid_argument("the errors of the loads are those of other loads");
}

Eigen::MatrixXd loads_of(const Holds& holds) {
  Eigen::MatrixXd loads(static_cast<Eigen::Index>(holds.holds.size()),
                        static_cast<Eigen::Index>(holds.components.size()));
  for (Eigen::Index i = 0; i < loads.rows(); ++i) {
    for (Eigen::Index k = 0; k < loads.cols(); ++k)
      loads(i, k) = holds.holds[static_cast<std::size_t>(i)].load[static_cast<std::size_t>(k)];
  }
  return loads;
}

Eigen::VectorXd signal_of(const Holds& holds, std::size_t signal) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(holds.holds.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values(i) = holds.holds[static_cast<std::size_t>(i)].signal[signal];
  return values;
}

Design design_of(const Holds& holds, const Options& options) {
  Design design;
  const Eigen::MatrixXd loads = loads_of(holds);
  const Eigen::Index n = loads.rows();
  const Eigen::Index m = loads.cols();
  design.full_scale = loads.cwiseAbs().colwise().maxCoeff();
  for (double& scale : design.full_scale) scale = scale > 0.0 ? scale : 1.0;
  double first_s = holds.holds.front().time_s;
  double last_s = first_s;
  double coldest = holds.holds.front().temperature;
  double warmest = coldest;
  double sum = 0.0;
  design.has_temperature = true;
  for (const Hold& hold : holds.holds) {
    design.tares = std::max(design.tares, static_cast<Eigen::Index>(hold.tare) + 1);
    first_s = std::min(first_s, hold.time_s);
    last_s = std::max(last_s, hold.time_s);
    design.has_temperature = design.has_temperature && std::isfinite(hold.temperature);
    coldest = std::min(coldest, hold.temperature);
    warmest = std::max(warmest, hold.temperature);
    sum += hold.temperature;
  }
  design.time_span_s = last_s - first_s;
  if (design.has_temperature) {
    design.mean_temperature = sum / static_cast<double>(n);
    design.temperature_range_k = warmest - coldest;
  }
  Eigen::Index columns = m + design.tares;
  if (options.drift && design.time_span_s > 0.0) design.drift = columns++;
  if (design.has_temperature && design.temperature_range_k >= options.least_temperature_range_k)
    design.temperature = columns++;
  design.columns.setZero(n, columns);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Hold& hold = holds.holds[static_cast<std::size_t>(i)];
    design.columns.row(i).head(m) = loads.row(i).array() / design.full_scale.transpose().array();
    design.columns(i, m + static_cast<Eigen::Index>(hold.tare)) = 1.0;
    if (design.drift >= 0) design.columns(i, design.drift) = (hold.time_s - last_s) / design.time_span_s;
    if (design.temperature >= 0)
      design.columns(i, design.temperature) =
          (hold.temperature - design.mean_temperature) / design.temperature_range_k;
  }
  return design;
}

Eigen::MatrixXd loads_alone(const Design& design) {
  const Eigen::Index m = design.components();
  const Eigen::MatrixXd others = design.columns.rightCols(design.columns.cols() - m);
  const Eigen::MatrixXd loads = design.columns.leftCols(m);
  return loads - others * others.completeOrthogonalDecomposition().solve(loads);
}

Branch branch_of(const Eigen::MatrixXd& loads, const Eigen::VectorXd& coefficients, double half_width) {
  Branch branch{.loads = loads,
                .width = Eigen::VectorXd::Zero(loads.rows()),
                .dragged = std::vector<Eigen::Index>(static_cast<std::size_t>(loads.rows()))};
  const Eigen::VectorXd elastic = loads * coefficients;
  double follower = elastic(0);
  for (Eigen::Index i = 1; i < loads.rows(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double away = elastic(i) - follower;
    if (std::abs(away) <= half_width) {  // it sticks
      branch.loads.row(i) = branch.loads.row(i - 1);
      branch.width(i) = branch.width(i - 1);
      branch.dragged[at] = branch.dragged[at - 1];
      continue;
    }
    branch.width(i) = away > 0.0 ? -1.0 : 1.0;
    branch.dragged[at] = i;
    follower = elastic(i) + branch.width(i) * half_width;
  }
  return branch;
}

}  // namespace kerf::fitting::calibration
