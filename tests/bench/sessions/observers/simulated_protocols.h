#pragma once

#include <string>

#include <fmt/format.h>

#include "protocol/protocol.h"

namespace kerf::bench {

/// A spring from 0.5 rad on: forces of some newtons in the hand of sim:scissors.
inline std::string spring_toml(double stiffness_n_per_rad) {
  return fmt::format(
      "model = \"kelvin\"\naxis = \"theta\"\nposition_unit = \"rad\"\nforce_unit = \"N\"\n"
      "[contact]\nposition = {{ value = 0.5, unit = \"rad\" }}\ndirection = \"decreasing\"\n"
      "[parameters]\nparallel_stiffness = {{ value = {0}, unit = \"N/rad\" }}\n"
      "series_stiffness = {{ value = {1}, unit = \"N/rad\" }}\ndamping = {{ value = 0.5, unit = \"N·s/rad\" "
      "}}\n",
      stiffness_n_per_rad, 0.1 * stiffness_n_per_rad);
}

/// A protocol whose samples "law 8" or "law 8.8" are springs of so many N/rad.
inline Protocol simulated_protocol(const std::string& toml) {
  return parse_protocol(
      "name = \"simulated\"\nquestion = \"Which is stiffer?\"\ndevice = \"sim:scissors\"\n" + toml +
          "\n[motion]\nfrom = { value = 32, unit = \"deg\" }\nto = { value = 8, unit = \"deg\" }\n",
      "simulated.protocol.toml",
      [](const std::string& name) { return spring_toml(std::stod(name.substr(4))); });
}

inline std::string two_springs(double first, double second) {
  return fmt::format(
      "[[sample]]\nname = \"first\"\nlaw = \"law {}\"\n[[sample]]\nname = \"second\"\nlaw = \"law {}\"\n",
      first, second);
}

/// Constant levels of the whole force, on one side.
inline std::string force_levels(int trials) {
  return fmt::format(
      "design = \"constant\"\ntrials = {}\n[[sample]]\nname = \"spring\"\nlaw = \"law 8\"\n"
      "[scale]\nvary = \"force\"\nlevels = [0.02, 0.04, 0.06, 0.09, 0.13, 0.2]\n",
      trials);
}

}  // namespace kerf::bench
