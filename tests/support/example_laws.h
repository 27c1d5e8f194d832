#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/law.h>

namespace kerf::test {

/// Three memberships an input, rising with depth and speed.
inline std::vector<double> fuzzy_values() {
  std::vector values{0.0, 0.005, 0.01, 0.002, 0.002, 0.002, 0.0, 0.005, 0.01, 0.002, 0.002, 0.002};
  for (const double of_each_rule : {8.0, 1.0, 0.02}) values.insert(values.end(), 9, of_each_rule);
  return values;
}

/// A plausible law of every kind in the registry; a law that is not listed here fails every suite that walks
/// it.
inline models::Law example(std::string_view model) {
  if (model == "kelvin") return models::Law::make(model, std::vector{8.0, 7.0, 130.0});
  if (model == "maxwell") return models::Law::make(model, std::vector{8.0, 20.0, 7.0, 0.5, 20.0});
  if (model == "springpot") {
    return models::Law::make(model, std::vector{5.0, 8.0, 0.3}, {{"reference_time", 2.0}});
  }
  if (model == "hunt_crossley") return models::Law::make(model, std::vector{0.05, 0.02, 1.5});
  if (model == "friction") return models::Law::make(model, std::vector{-0.1, 2.0, 0.3, 0.8, 0.005});
  if (model == "exponential")
    return models::Law::make(model, std::vector{0.02, 3.0, 0.4}, {{"thickness", 0.3}});
  if (model == "piecewise") {
    return models::Law::make(
        model, std::vector{0.0, 0.1, 0.4, 0.1, 2.0, 1.5, -0.1, -1.0, -0.7},
        {{"segments", 2.0}, {"loop", true}, {"ramp_band", 0.01}, {"reversal_scale", 40.0}});
  }
  if (model == "recording") {
    return models::Law::make(model, std::vector{0.1, 2.0, 1.5, -0.1, -1.0, -0.7},
                             {{"points", 3.0}, {"last", 0.4}, {"loop", true}, {"velocity_corner", 10.0}});
  }
  if (model == "scissors_analytic") {
    return models::Law::make(model, std::vector{0.003, 0.4, 6.0}, {{"ramp_band", 0.01}});
  }
  if (model == "precontact") return models::Law::make(model, std::vector{300.0, 0.01});
  if (model == "fracture") return models::Law::make(model, std::vector{4.3e-3, 4.0, 2e-3, 2000.0, 1e-3});
  if (model == "fuzzy_rupture") return models::Law::make(model, fuzzy_values());
  if (model == "fuzzy_kelvin") {
    std::vector values{8.0, 7.0, 130.0};
    const auto surface = fuzzy_values();
    values.insert(values.end(), surface.begin(), surface.end());
    return models::Law::make(model, values);
  }
  if (model == "fuzzy_kelvin_3d") {
    std::vector values{8.0, 9.0, 20.0, 7.0, 6.0, 15.0, 130.0, 100.0, 50.0};
    const auto surface = fuzzy_values();
    values.insert(values.end(), surface.begin(), surface.end());
    return models::Law::make(model, values, {{"stiffening", 30.0}});
  }
  if (model == "blade")
    return models::Law::make(model, std::vector{5.0, 2e4, 4e3, 100.0, 1e6, 3e5, 0.02, 0.1});
  if (model == "scissors") return models::Law::make(model, std::vector{0.003, 0.4, 6.0, 1000.0, 2.0});
  if (model == "scissors_mesh") {
    return models::Law::make(model, std::vector{10.0, 5.0, 5e-5, 1e-5, 1e-3, 50.0, 0.01, 5000.0, 1e-3, 3e-4},
                             {{"columns", 12.0}, {"rows", 10.0}, {"edge", 0.02}});
  }
  if (model == "orthogonal") {
    return models::Law::make(model, std::vector{0.1, 5.0, 2.0, 0.06},
                             {{"surface", std::string("sphere")}, {"point", std::string("0 -0.02 0")}});
  }
  throw std::logic_error("no example of law " + std::string(model));
}

}  // namespace kerf::test
