#pragma once

#include <algorithm>
#include <random>
#include <string>

#include <fmt/core.h>

#include "support/recordings.h"

namespace kerf::test {

/// A punch whose tool rubs on itself with so much force against the motion, a fifth more where it is deepest,
/// which turns with the motion within the tenth of the way at either end, and some noise.
inline schema::Recording rubbed_punch(const Tissue& tissue, double friction_n) {
  schema::Recording recording = punch(tissue);
  std::mt19937 generator(tissue.seed + 100);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < recording.rows(); ++i) {
    const double v = recording.velocity[i];
    const double fastest = 0.5 * tissue.depth_m * 3.14159265358979 * (1.0 + recording.time[i]);
    const double against = std::clamp(v / (0.4 * fastest), -1.0, 1.0);
    recording.force_measured[i] +=
        friction_n * (1.0 + 40.0 * recording.position[i]) * against + 0.002 * normal(generator);
  }
  return recording;
}

/// Every other row as text, with headings that name the units.
inline std::string as_text(const schema::Recording& recording, double force_factor = 1.0) {
  std::string text = "Time [s]\tPosition [mm]\tForce [N]\n";
  for (std::size_t i = 0; i < recording.rows(); i += 2)
    text += fmt::format("{:.3f}\t{:.6f}\t{:.6f}\n", recording.time[i], 1e3 * recording.position[i],
                        force_factor * recording.force_measured[i]);
  return text;
}

}  // namespace kerf::test
