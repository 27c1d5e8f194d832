#pragma once

#include <cstddef>

#include "psychometric/likelihood.h"

namespace kerf::psychophysics {

/// Where the loss of likelihood along one parameter, all others fitted again, reaches a bound: walks from the
/// estimate until it does, then closes in.
class Profile {
 public:
  /// `loss` is twice that of the log-likelihood.
  Profile(const Problem& problem, const Maximum& best, const Held& held, double loss)
      : problem_(problem), best_(best), held_(held), loss_(loss) {}

  /// Minus or plus infinity where the bound of the parameter is reached first.
  [[nodiscard]] double end(std::size_t index, double direction) const;

 private:
  double crossing(std::size_t index, Point& like, double inside, double below, double outside,
                  double above) const;
  double excess(std::size_t index, double value, Point& like) const;

  Problem problem_;
  Maximum best_;
  Held held_;
  double loss_;
};

}  // namespace kerf::psychophysics
