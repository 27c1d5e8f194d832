#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <kerf/population/group.h>

namespace kerf::population {

/// Recordings of one specimen: values and the squares of their standard errors (0 where they are unknown).
struct Specimen {
  std::string name;
  std::vector<double> values;
  std::vector<double> variances;
};

struct Specimens {
  std::vector<Specimen> all;
  Unit unit = Unit::specimens;  ///< recordings: each recording is an entry of its own
  bool has_standard_errors = true;
  std::size_t recordings = 0;
  std::size_t left_out = 0;
};

/// Estimates by specimen, in the order in which they come; those without limits are left out.
[[nodiscard]] Specimens specimens_of(std::span<const Estimate> estimates);

/// Each recording an entry of its own.
[[nodiscard]] std::vector<Specimen> apart(const std::vector<Specimen>& specimens);

[[nodiscard]] double mean_of(std::span<const double> values);

}  // namespace kerf::population
