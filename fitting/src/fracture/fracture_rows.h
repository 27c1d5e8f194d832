#pragma once

#include <limits>
#include <vector>

#include <kerf/models/fracture.h>

#include "fracture/deformed_rows.h"
#include "fracture/fracture_coordinates.h"

namespace kerf::fitting {

/// A row of a path, and what the law made of it.
struct FractureRow {
  using Mode = models::Fracture<double>::Mode;
  std::size_t at;
  Mode mode;
  bool pushes;   ///< there is a force
  double tip;    ///< before it [m]
  double depth;  ///< of the tool below that tip [m]
  double moves;  ///< by how many cracks that ran ahead of the tool the tip had come there
};

/// Tissue of one newton, however deep: which rows break does not depend on how stiff the tissue is, and
/// its energy costs next to nothing.
struct LightTissue {
  double yields_at_m;
  [[nodiscard]] static double growth(double depth_m) { return depth_m; }
  [[nodiscard]] static double energy(double depth_m) { return depth_m; }
  [[nodiscard]] static double force(double) { return 1.0; }
  [[nodiscard]] double yield_depth() const { return yields_at_m; }
};

/// Runs the law along the samples, at one depth of yielding and one length of crack, and shows every row to
/// `take`.
template <typename Take>
void walk(const Problem& problem, const Samples& samples, double depth_m, double crack_m, Take&& take) {
  constexpr double width_m = 0.01;
  const LightTissue tissue{depth_m};
  const double energy_j = LightTissue::energy(depth_m);
  const auto law = models::Fracture<double>::make(
      std::vector{1.0, 1.0, energy_j, energy_j / (crack_m * width_m), width_m}, problem.law_options);
  for (const Run& run : samples.runs) {
    models::Fracture<double>::State state;
    double moves = 0.0;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const double tip = state.surface;
      const double x = samples.motion[i].penetration;
      const double force = law.step_through(state, samples.motion[i], tissue);
      take(FractureRow{i, state.mode, force > 0.0, tip, x - tip, moves});
      if (state.surface != tip) moves = state.surface > x ? moves + 1.0 : 0.0;
    }
  }
}

/// Where a search stands, and the sum of squares there.
struct FracturePlace {
  Eigen::VectorXd at;
  double squares = std::numeric_limits<double>::infinity();
};

/// The samples by what a path makes of them: whole, cutting, or without a force. While no row changes sides
/// the sum of squares is smooth.
class FractureRows {
 public:
  FractureRows(const RobustLoss& loss, double crack_m, std::size_t most_rows);

  void add(const FractureRow& row, double force_n, double weight) {
    if (row.pushes && row.mode == FractureRow::Mode::deformation) {
      whole_.add(row.depth, row.moves, force_n, weight);
    } else if (row.pushes) {
      cut_.force.push_back(force_n);
      cut_.weight.push_back(weight);
    } else {
      const double square = weight * force_n * force_n;
      without_force_ += loss_.kind == Loss::squares ? square : loss_(square).rho;
    }
  }
  void end();

  /// By all four coordinates, of which depth and crack leave every row on its side.
  [[nodiscard]] Sums sums(const FractureCoordinates& coordinates, const Eigen::VectorXd& at) const;
  /// Amplitude and exponent of least squares, from those of `at` on. Under another loss: `at`.
  [[nodiscard]] FracturePlace with_best_tissue(const FractureCoordinates& coordinates,
                                               const Eigen::VectorXd& at) const;
  /// The same by whole rows alone, and the crack by the force of cutting: of cracks that end behind the tool,
  /// where no row's side depends on their length. Infinite where they do not.
  [[nodiscard]] FracturePlace with_short_crack(const FractureCoordinates& coordinates,
                                               const Eigen::VectorXd& at) const;

 private:
  /// Rows of one force.
  struct Cut {
    std::vector<double> force, weight;
    double weights = 0.0, mean = 0.0, about_the_mean = 0.0;
  };
  enum class Fitted { whole, whole_and_cut };
  [[nodiscard]] FracturePlace tissue(const FractureCoordinates& coordinates, const Eigen::VectorXd& at,
                                     Fitted which) const;
  [[nodiscard]] Sums robust_sums(const Eigen::VectorXd& at, double rate, double shift,
                                 const Eigen::Vector4d& cutting) const;

  RobustLoss loss_;
  double crack_m_;
  wide::DeformedRows whole_;
  Cut cut_;
  double without_force_ = 0.0;  ///< sum of squares of rows that the law gives no force
};

}  // namespace kerf::fitting
