#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Core>

namespace kerf::fitting {

/// What a sum of squares is near a point: all that a step of Gauss and Newton needs.
struct Sums {
  double squares = 0.0;    ///< r'r
  Eigen::VectorXd score;   ///< J'r
  Eigen::MatrixXd normal;  ///< J'J
};

/// The same in the form of a triangle, J = Q R: what is left of r besides its part along J.
struct Triangle {
  Eigen::MatrixXd r;  ///< R, p x p
  Eigen::VectorXd z;  ///< Q'r
  double rest = 0.0;  ///< norm of r - Q Q'r
};

/// The triangle with the given sums. Directions that J'J does not tell from nothing are left out.
[[nodiscard]] Triangle triangle_of(const Sums& sums);

/// A least-squares problem, seen from one point after another.
class Objective {
 public:
  Objective() = default;
  Objective(const Objective&) = delete;
  Objective& operator=(const Objective&) = delete;
  virtual ~Objective() = default;
  [[nodiscard]] virtual Eigen::Index size() const = 0;
  /// False where there is nothing at this point: the search steps back.
  [[nodiscard]] virtual bool evaluate(const Eigen::VectorXd& at, Sums& sums) const = 0;
  /// The sums and their triangle.
  [[nodiscard]] virtual bool factor(const Eigen::VectorXd& at, Sums& sums, Triangle& triangle) const;
};

/// One with few enough residuals to hold. Its triangle comes of the residuals themselves, not of J'J, whose
/// condition is the square of theirs.
class DenseObjective : public Objective {
 public:
  /// False where there is nothing at this point.
  [[nodiscard]] virtual bool rows(const Eigen::VectorXd& at, Eigen::VectorXd& residual,
                                  Eigen::MatrixXd& jacobian) const = 0;
  [[nodiscard]] bool evaluate(const Eigen::VectorXd& at, Sums& sums) const final;
  [[nodiscard]] bool factor(const Eigen::VectorXd& at, Sums& sums, Triangle& triangle) const final;
};

struct Bounds {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

struct MinimiseOptions {
  int iterations = 100;
  double function_tolerance = 1e-13;  ///< relative change of the sum of squares that still counts
  /// Where the search has ended, steps of Gauss and Newton go on until none changes a parameter by more than
  /// this share of it, or they no longer shrink: a sum of squares shows but half of the digits of where its
  /// minimum is. 0: no such steps.
  double parameter_tolerance = 0.0;
};

/// Where a search ended.
struct Minimum {
  Eigen::VectorXd at;
  Sums sums;
  bool converged = false;
  int iterations = 0;
  std::string message;
};

/// Least squares by the trust region of Ceres. However many residuals there are, Ceres sees p + 1 of them:
/// those whose J'J, J'r and r'r are the sums over all, which one pass over the samples gives.
[[nodiscard]] Minimum minimise(const Objective& objective, const Eigen::VectorXd& start, const Bounds& bounds,
                               const MinimiseOptions& options = {});

/// The least of the minima that are reached from the start and from copies of it: all parameters, and each
/// alone, a tenth, ten, a hundredth and a hundred times as large. Of the copies, only the `most` with the
/// least sums of squares are gone on from, and of these the best three to the end. For a start that is right
/// in its signs and little else.
[[nodiscard]] Minimum minimise_from_many(const Objective& objective, const Eigen::VectorXd& start,
                                         const Bounds& bounds, const MinimiseOptions& options = {},
                                         std::size_t most = 12);

/// The x of least |A x - b|, and the shortest where A leaves a choice, each x being measured by the norm of
/// its column. Decompositions are slow to compile, so that each is compiled once, here.
[[nodiscard]] Eigen::VectorXd shortest_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// The same from the normal equations A'A x = A'b; the shortest x where they leave a choice.
[[nodiscard]] Eigen::VectorXd solve_normal(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right);

/// The x of A x = b for a symmetric A; none where A is not positive.
[[nodiscard]] std::optional<Eigen::VectorXd> solve_positive(const Eigen::MatrixXd& a,
                                                            const Eigen::VectorXd& b);

/// The bounded one of the normal equations, lower <= x <= upper, by going round the parameters one at a time
/// until nothing moves.
[[nodiscard]] Eigen::VectorXd solve_bounded(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right,
                                            const Bounds& bounds);

}  // namespace kerf::fitting
