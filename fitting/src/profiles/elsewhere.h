#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "problem.h"

namespace kerf::fitting {

/// Where a law may leave as little as near its best, far from there. One that is linear in all parameters but
/// one has at each value of that one a single place of least squares [GolubPereyra1973]; the values are those
/// at which a search for the law begins (models::ScanFacts), and decades beyond.
class Elsewhere {
 public:
  /// Sums over the samples once for each value. Nothing is elsewhere for other laws, nor where that parameter
  /// is held or recordings have parameters of their own.
  Elsewhere(const Problem& problem, const LawObjective& law);

  /// The coordinates that leave least with one of them held, at the best of the values; none where it is the
  /// one that takes them.
  [[nodiscard]] std::optional<Eigen::VectorXd> least(Eigen::Index held, double value) const;

 private:
  /// A value, all else at one, and what the law leaves there.
  struct Scanned {
    std::vector<double> values;
    Sums sums;
  };
  /// The sums at any other values: the law is linear in them.
  [[nodiscard]] static std::function<bool(const std::vector<double>& values, Sums& sums)> sums_from(
      const Scanned& scanned);

  const Problem& problem_;
  Values best_;
  std::size_t bent_ = 0;  ///< the parameter that takes the values
  std::vector<Scanned> scanned_;
};

}  // namespace kerf::fitting
