#pragma once

namespace kerf::psychophysics {

enum class Shape { weibull, logistic, gaussian };

/// Whether a curve is a function of the intensity or of its logarithm.
enum class Axis { linear, logarithmic };

/// Probability of an answer against the intensity x of what is felt (a difference of forces, of stiffness,
/// ...).
///
///     psi(x) = guess + (1 - guess - lapse) F(z),   z = slope (x - threshold), or slope (ln x - ln threshold)
///
///     weibull: F = 1 - exp(-exp(z))    logistic: F = 1 / (1 + exp(-z))    gaussian: F = P(z), the normal
///     distribution
///
/// The Weibull curve is that of 1 - exp(-(x / threshold)^slope): its axis is logarithmic. At the threshold F
/// is 63.2 % (Weibull) or 50 %. The slope is per unit of x on a linear axis, and a pure number on a
/// logarithmic one, where x = 0 is allowed and gives `guess`. [WichmannHill2001], eq. 1; [Strasburger2001]
/// on the slopes.
struct Psychometric {
  Shape shape = Shape::weibull;
  Axis axis = Axis::logarithmic;
  double threshold = 1.0;  ///< alpha, unit of x; > 0 on a logarithmic axis
  double slope = 3.5;      ///< beta, > 0
  double guess = 0.5;      ///< gamma in [0, 1): 1 / m in a forced choice
  double lapse = 0.02;     ///< lambda in [0, 1 - gamma)

  [[nodiscard]] double probability(double intensity) const;

  /// The other way, for guess < probability < 1 - lapse.
  [[nodiscard]] double intensity_at(double probability) const;
};

}  // namespace kerf::psychophysics
