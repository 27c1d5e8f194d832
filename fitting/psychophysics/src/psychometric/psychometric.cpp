#include <cmath>

#include <kerf/psychophysics/psychometric.h>

#include "checks.h"
#include "psychometric/shape.h"

namespace kerf::psychophysics {
namespace {

void require_curve(const Psychometric& curve) {
  const bool is_logarithmic = curve.axis == Axis::logarithmic;
  require(curve.shape != Shape::weibull || is_logarithmic, "a Weibull curve has a logarithmic axis");
  require(std::isfinite(curve.threshold) && (!is_logarithmic || curve.threshold > 0.0),
          "the threshold must be finite, and above zero on a logarithmic axis");
  require(std::isfinite(curve.slope) && curve.slope > 0.0, "the slope must be above zero");
  require(curve.guess >= 0.0 && curve.lapse >= 0.0 && curve.guess + curve.lapse < 1.0,
          "guess and lapse rates must be at least zero and together less than one");
}

}  // namespace

double Psychometric::probability(double intensity) const {
  require_curve(*this);
  const bool is_logarithmic = axis == Axis::logarithmic;
  require(!std::isnan(intensity) && (!is_logarithmic || intensity >= 0.0),
          "the intensity must be a number, and not below zero on a logarithmic axis");
  const double distance = is_logarithmic ? std::log(intensity) - std::log(threshold) : intensity - threshold;
  return guess + (1.0 - guess - lapse) * shape_at(shape, slope * distance).below;
}

double Psychometric::intensity_at(double probability) const {
  require_curve(*this);
  require(probability > guess && probability < 1.0 - lapse,
          "the curve reaches only what lies between the guess rate and one less the lapse rate");
  const double distance = shape_quantile(shape, (probability - guess) / (1.0 - guess - lapse)) / slope;
  return axis == Axis::logarithmic ? threshold * std::exp(distance) : threshold + distance;
}

}  // namespace kerf::psychophysics
