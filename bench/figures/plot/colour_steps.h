#pragma once

#include <string>
#include <vector>

namespace kerf::bench {

/// A scale of colours in steps, so that a tile's class can be told from its neighbours' and read at the
/// scale: viridis, which gets lighter all the way for every kind of colour vision and in grey.
struct ColourSteps {
  std::string label;           ///< with its unit
  std::vector<double> bounds;  ///< ascending, one more than there are colours
  double lightest = 1.0;       ///< share of the scale that is used: thin lines on white need less than all

  [[nodiscard]] std::size_t steps() const noexcept { return bounds.size() - 1; }
  /// The step of a number; beyond the ends the first or last one.
  [[nodiscard]] std::size_t step_of(double value) const noexcept;
  /// "#440154"
  [[nodiscard]] std::string colour_of_step(std::size_t step) const;
  /// Black or white, whichever is legible on it.
  [[nodiscard]] std::string ink_on_step(std::size_t step) const;
};

/// Round steps, about ten, that hold both ends; by factors where they are above zero and two decades apart.
[[nodiscard]] ColourSteps round_steps(std::string label, double smallest, double largest);
/// Tenths from 0 to 1.
[[nodiscard]] ColourSteps share_steps(std::string label);

}  // namespace kerf::bench
