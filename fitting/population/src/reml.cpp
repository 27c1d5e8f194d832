#include "reml.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kerf::population {
namespace {

using Two = std::array<double, 2>;

Variances variances_of(const Two& at) { return {.between = at[0], .within = at[1]}; }

/// -2 log likelihood, without its constant.
double loss_at(const std::vector<Specimen>& specimens, const Two& at) {
  const Fitted fit = fitted(specimens, variances_of(at));
  double loss = std::log(fit.weight) + fit.q + fit.within_q;
  for (std::size_t i = 0; i < specimens.size(); ++i) {
    for (const double error : specimens[i].variances) loss += std::log(error + at[1]);
    loss += std::log(fit.specimens[i].variance * fit.specimens[i].weight);
  }
  return loss;
}

/// The derivatives of the loss by both variances; the mean is at its best, so that it adds nothing.
Two slope_at(const std::vector<Specimen>& specimens, const Two& at) {
  const Fitted fit = fitted(specimens, variances_of(at));
  Two slope{0.0, 0.0};
  for (std::size_t i = 0; i < specimens.size(); ++i) {
    const SpecimenMean& of = fit.specimens[i];
    const double v = of.variance;
    const double r = of.mean - fit.mean;
    slope[0] += 1.0 / v - 1.0 / (v * v * fit.weight) - r * r / (v * v);
    const double by_within = of.squares / (of.weight * of.weight);
    slope[1] += by_within / v - of.squares / of.weight - by_within / (v * v * fit.weight);
    const double shared = at[0] * r / v;
    for (std::size_t j = 0; j < specimens[i].values.size(); ++j) {
      const double a = 1.0 / (specimens[i].variances[j] + at[1]);
      const double left = a * (specimens[i].values[j] - fit.mean - shared);
      slope[1] += a - left * left;
    }
  }
  return slope;
}

class Search {
 public:
  Search(const std::vector<Specimen>& specimens, const Model& model)
      : specimens_(specimens), model_(model), least_{model.least.between, model.least.within} {}

  Two best() {
    Two at = coarse();
    for (int i = 0; i < 100; ++i) {
      const double moved = step(at);
      if (moved < 1e-12) break;
    }
    return at;
  }

 private:
  /// The likelihood may have two hills: the search begins on the higher.
  Two coarse() const {
    constexpr std::array grid{0.0, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0};
    Two best = least_;
    double least_loss = std::numeric_limits<double>::infinity();
    for (const double b : grid) {
      for (const double w : grid) {
        if (!model_.has_within && w > 0.0) continue;
        const Two at{std::max(least_[0], b), std::max(least_[1], w)};
        const double loss = loss_at(specimens_, at);
        if (loss >= least_loss) continue;
        least_loss = loss;
        best = at;
      }
    }
    return best;
  }

  /// Column k of the second derivatives, by differences of the first that stay above the least values.
  Two curvature(const Two& at, std::size_t k) const {
    Two up = at;
    Two down = at;
    const double h = 1e-5 * (at[k] + 1e-4);
    up[k] += h;
    down[k] = std::max(least_[k], at[k] - h);
    const Two high = slope_at(specimens_, up);
    const Two low = slope_at(specimens_, down);
    const double width = up[k] - down[k];
    return {(high[0] - low[0]) / width, (high[1] - low[1]) / width};
  }

  Two direction(const Two& at) const {
    const Two g = slope_at(specimens_, at);
    const bool moves_b = at[0] > least_[0] || g[0] < 0.0;
    const bool moves_w = model_.has_within && (at[1] > least_[1] || g[1] < 0.0);
    const double hbb = moves_b ? curvature(at, 0)[0] : 1.0;
    const Two column = moves_w ? curvature(at, 1) : Two{0.0, 1.0};
    const double hbw = moves_b ? column[0] : 0.0;
    const double hww = column[1];
    const double gb = moves_b ? g[0] : 0.0;
    const double gw = moves_w ? g[1] : 0.0;
    const double determinant = hbb * hww - hbw * hbw;
    if (hbb > 0.0 && determinant > 0.0)
      return {(hbw * gw - hww * gb) / determinant, (hbw * gb - hbb * gw) / determinant};
    // Where the loss is not convex: downhill, by steps of the size of the variances.
    return {-std::copysign(0.3 * (at[0] + 1e-3), gb) * (gb != 0.0 ? 1.0 : 0.0),
            -std::copysign(0.3 * (at[1] + 1e-3), gw) * (gw != 0.0 ? 1.0 : 0.0)};
  }

  /// One step that does not lose; how far it went, relative to where it is.
  double step(Two& at) const {
    const Two to = direction(at);
    const double before = loss_at(specimens_, at);
    for (double length = 1.0; length > 1e-9; length *= 0.5) {
      const Two next{std::max(least_[0], at[0] + length * to[0]),
                     std::max(least_[1], at[1] + length * to[1])};
      if (loss_at(specimens_, next) > before + 1e-12 * (1.0 + std::abs(before))) continue;
      const double moved = std::abs(next[0] - at[0]) + std::abs(next[1] - at[1]);
      at = next;
      return moved;
    }
    return 0.0;
  }

  const std::vector<Specimen>& specimens_;
  Model model_;
  Two least_;
};

}  // namespace

Fitted fitted(const std::vector<Specimen>& specimens, const Variances& variances) {
  Fitted fit;
  fit.specimens.resize(specimens.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < specimens.size(); ++i) {
    const Specimen& specimen = specimens[i];
    SpecimenMean& of = fit.specimens[i];
    for (std::size_t j = 0; j < specimen.values.size(); ++j) {
      const double a = 1.0 / (specimen.variances[j] + variances.within);
      of.weight += a;
      of.squares += a * a;
      of.mean += a * specimen.values[j];
    }
    of.mean /= of.weight;
    for (std::size_t j = 0; j < specimen.values.size(); ++j) {
      const double left = specimen.values[j] - of.mean;
      of.about += left * left / (specimen.variances[j] + variances.within);
    }
    of.variance = variances.between + 1.0 / of.weight;
    fit.weight += 1.0 / of.variance;
    sum += of.mean / of.variance;
    fit.within_q += of.about;
  }
  fit.mean = sum / fit.weight;
  for (const SpecimenMean& of : fit.specimens)
    fit.q += (of.mean - fit.mean) * (of.mean - fit.mean) / of.variance;
  return fit;
}

Variances reml(const std::vector<Specimen>& specimens, const Model& model) {
  return variances_of(Search(specimens, model).best());
}

}  // namespace kerf::population
