#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace kerf::fitting {

/// A change of the parameters that leaves the forces as they are, as far as the noise lets one see.
struct UnidentifiableDirection {
  std::vector<std::pair<std::size_t, double>>
      parts;                    ///< parameter and its share; the largest first, which is 1
  double relative_error = 0.0;  ///< standard error along it, in units of the scale; may be infinite
};

/// Directions whose interval reaches further than the scale itself (a factor of e on a logarithmic one): so
/// far away a linearisation says nothing, so that neither would a number. Those directions of J S (S the
/// scale) span a space; elimination finds the changes of fewest parameters in it.
///
/// `normal` is J^T J and `noise` J^T Sigma J, Sigma the covariance of the noise: the standard error along d
/// is sqrt(d^T noise d) / d^T normal d. `null` spans what J does not see at all.
[[nodiscard]] std::vector<UnidentifiableDirection> unidentifiable_directions(const Eigen::MatrixXd& normal,
                                                                             const Eigen::MatrixXd& noise,
                                                                             const Eigen::MatrixXd& null,
                                                                             const Eigen::VectorXd& scale,
                                                                             double quantile);

/// A sentence for whoever made the recording, such as "the data determine the product of 'toughness' and
/// 'width', but neither of them". Names and scales (true: logarithmic) of the parameters by index.
[[nodiscard]] std::string describe(const UnidentifiableDirection& unidentifiable,
                                   const std::vector<std::string>& names,
                                   const std::vector<bool>& logarithmic);

}  // namespace kerf::fitting
