#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "run/doubts.h"

namespace kerf::test {

/// A recording of a drawer that was studied, with two good cycles and a law that serves it.
struct Studied {
  std::string name;
  std::string tissue = "liver";
  std::string speed = "slow";
  std::string specimen;
  double peak = 1.0;       ///< [N]
  double stiffness = 100;  ///< [N/m]
  double travel = 0.01;    ///< [m]
  double period_s = 1e-3;
  double held_out_jnd = 0.5;
};

inline bench::DrawerRecording studied(const Studied& what) {
  bench::DrawerRecording one;
  one.name = what.name;
  one.file = {
      .path = what.name + ".txt", .tissue = what.tissue, .speed = what.speed, .specimen = what.specimen};
  bench::StudiedRecording& result = one.result;
  result.position_unit = "m";
  result.force_unit = "N";
  result.travel = what.travel;
  result.period_s = what.period_s;
  result.peak = what.peak;
  result.rms = 0.5 * what.peak;
  result.jnd = 0.1;
  result.clipped_at = result.least_shown = result.floor = std::numeric_limits<double>::quiet_NaN();
  result.closing_direction = 1.0;
  for (const std::uint32_t number : {1U, 2U})
    result.cycles.push_back({.number = number, .closing_s = 1.0, .peak = what.peak, .closing_work = 1e-3});
  result.laws.push_back({.model = "kelvin",
                         .free_parameters = 3,
                         .rmse = 0.01,
                         .held_out = 0.1 * what.held_out_jnd,
                         .can_be_chosen = true,
                         .within_jnd = what.held_out_jnd <= 1.0,
                         .blame = "",
                         .parameters = {{.name = "parallel_stiffness",
                                         .unit = "N/m",
                                         .value = what.stiffness,
                                         .std_error = 0.01 * what.stiffness,
                                         .is_positive = true}}});
  result.chosen = "kelvin";
  return one;
}

/// Five specimens of a tissue, whose forces differ by a few per cent.
inline std::vector<bench::DrawerRecording> five_specimens(const std::string& tissue, double peak) {
  std::vector<bench::DrawerRecording> all;
  for (int i = 0; i < 5; ++i)
    all.push_back(studied({.name = tissue + std::to_string(i),
                           .tissue = tissue,
                           .specimen = tissue + "-s" + std::to_string(i),
                           .peak = peak * (1.0 + 0.03 * i),
                           .stiffness = 100.0 * peak * (1.0 + 0.03 * i)}));
  return all;
}

}  // namespace kerf::test
