#include "plot/colour_steps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace kerf::bench {
namespace {

struct Rgb {
  double red = 0.0;
  double green = 0.0;
  double blue = 0.0;
};

/// Viridis at ninths, between which it is very nearly straight.
constexpr std::array<Rgb, 10> viridis{{{68, 1, 84},
                                       {72, 40, 120},
                                       {62, 73, 137},
                                       {49, 104, 142},
                                       {38, 130, 142},
                                       {31, 158, 137},
                                       {53, 183, 121},
                                       {110, 206, 88},
                                       {181, 222, 43},
                                       {253, 231, 37}}};

Rgb viridis_at(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(viridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), viridis.size() - 2);
  const double part = place - static_cast<double>(below);
  const auto mixed = [&](double Rgb::*channel) {
    return viridis[below].*channel * (1.0 - part) + viridis[below + 1].*channel * part;
  };
  return {.red = mixed(&Rgb::red), .green = mixed(&Rgb::green), .blue = mixed(&Rgb::blue)};
}

Rgb colour_at(std::size_t step, std::size_t steps, double lightest) {
  return viridis_at(lightest *
                    (steps < 2 ? 0.5 : static_cast<double>(step) / static_cast<double>(steps - 1)));
}

/// Relative luminance, as contrast is reckoned with on pages.
double luminance(const Rgb& colour) {
  const auto linear = [](double channel) {
    const double share = channel / 255.0;
    return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(colour.red) + 0.7152 * linear(colour.green) + 0.0722 * linear(colour.blue);
}

std::vector<double> linear_bounds(double smallest, double largest) {
  const double rough = (largest - smallest) / 9.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.5, 2.0, 1.0})
    if (factor * power >= rough * (1.0 - 1e-9)) step = factor * power;
  std::vector<double> bounds;
  const double first = std::floor(smallest / step + 1e-9);
  for (double k = first; bounds.empty() || bounds.back() < largest - 1e-9 * step; ++k)
    bounds.push_back(k * step);
  return bounds;
}

std::vector<double> logarithmic_bounds(double smallest, double largest) {
  const double decades = std::log10(largest / smallest);
  std::vector<double> factors{1.0};
  if (decades <= 6.0) factors = {1.0, 3.0};
  if (decades <= 3.5) factors = {1.0, 2.0, 5.0};
  std::vector<double> bounds;
  for (double decade = std::floor(std::log10(smallest) + 1e-9); bounds.empty() || bounds.back() < largest;
       ++decade) {
    for (const double factor : factors) {
      const double bound = factor * std::pow(10.0, decade);
      if (!bounds.empty() && bounds.back() >= largest) break;
      if (!bounds.empty() && bounds.size() == 1 && bound <= smallest) bounds.clear();
      bounds.push_back(bound);
    }
  }
  return bounds;
}

}  // namespace

std::size_t ColourSteps::step_of(double value) const noexcept {
  const auto above = std::upper_bound(bounds.begin() + 1, bounds.end() - 1, value);
  return static_cast<std::size_t>(above - bounds.begin()) - 1;
}

std::string ColourSteps::colour_of_step(std::size_t step) const {
  const Rgb colour = colour_at(step, steps(), lightest);
  return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(std::lround(colour.red)),
                     static_cast<int>(std::lround(colour.green)), static_cast<int>(std::lround(colour.blue)));
}

std::string ColourSteps::ink_on_step(std::size_t step) const {
  // Where black and white have the same contrast.
  return luminance(colour_at(step, steps(), lightest)) > 0.179 ? "#000000" : "#ffffff";
}

ColourSteps round_steps(std::string label, double smallest, double largest) {
  if (!(smallest < largest)) {
    const double room = smallest == 0.0 ? 1.0 : 0.5 * std::abs(smallest);
    return {.label = std::move(label), .bounds = {smallest - room, smallest + room}};
  }
  const bool logarithmic = smallest > 0.0 && largest / smallest > 100.0;
  return {.label = std::move(label),
          .bounds = logarithmic ? logarithmic_bounds(smallest, largest) : linear_bounds(smallest, largest)};
}

ColourSteps share_steps(std::string label) {
  ColourSteps steps{.label = std::move(label), .bounds = {}};
  for (int tenth = 0; tenth <= 10; ++tenth) steps.bounds.push_back(0.1 * tenth);
  return steps;
}

}  // namespace kerf::bench
