#pragma once

#include <array>
#include <vector>

#include <kerf/models/law.h>

namespace kerf::test {

/// A law that is known, with the number of parameters that a fit of it has.
struct KnownLaw {
  const char* name;
  models::Law law;
  std::size_t parameters;
};

inline models::Law known_line() {
  return models::Law::make("piecewise", std::array{0.0, 1.0, 0.0, 8.0}, {{"segments", 1.0}});
}
inline models::Law known_kelvin() { return models::Law::make("kelvin", std::array{5.0, 8.0, 1.6}); }

inline std::vector<KnownLaw> known_laws() {
  using models::Law;
  return {
      {"a straight line", known_line(), 2},
      {"kelvin", known_kelvin(), 3},
      {"exponential", Law::make("exponential", std::array{0.2, 0.7, 0.3}, {{"thickness", 0.1}}), 3},
      {"hunt_crossley", Law::make("hunt_crossley", std::array{0.03, 0.01, 1.5}), 3},
      {"maxwell", Law::make("maxwell", std::array{4.0, 6.0, 8.0, 0.05, 0.8}), 5},
      {"friction", Law::make("friction", std::array{0.2, 4.0, 0.1, 1.0, 0.01}), 5},
      {"piecewise",
       Law::make("piecewise", std::array{0.0, 0.15, 0.3, 0.5, 0.1, 0.6, 2.5, 3.0}, {{"segments", 3.0}}), 6},
      {"piecewise with a loop",
       Law::make("piecewise", std::array{0.0, 0.15, 0.3, 0.5, 0.2, 0.6, 3.0, 3.4, 0.0, 0.1, 2.0, 2.6},
                 {{"segments", 3.0}, {"loop", true}}),
       10}};
}

}  // namespace kerf::test
