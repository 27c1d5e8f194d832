#include <cmath>
#include <cstdint>
#include <vector>

#include <boost/math/distributions/students_t.hpp>

#include <kerf/psychophysics/comparisons.h>
#include <kerf/psychophysics/random.h>

#include "checks.h"
#include "ranking.h"

namespace kerf::psychophysics {
namespace {

constexpr std::size_t most_subjects_counted = 14;

Wins added_up(std::span<const Wins> subjects) {
  Wins all = subjects.front();
  for (std::size_t subject = 1; subject < subjects.size(); ++subject) {
    require(subjects[subject].size() == all.size(), "subjects of one ranking compare the same items");
    for (std::size_t i = 0; i < all.size(); ++i) {
      require(subjects[subject][i].size() == all.size(),
              "wins must be a square table: one row and one column an item");
      for (std::size_t j = 0; j < all.size(); ++j) all[i][j] += subjects[subject][i][j];
    }
  }
  return all;
}

std::vector<double> product(const Matrix& matrix, const std::vector<double>& vector) {
  std::vector<double> result(vector.size(), 0.0);
  for (std::size_t i = 0; i < vector.size(); ++i) {
    for (std::size_t j = 0; j < vector.size(); ++j) result[i] += matrix[i][j] * vector[j];
  }
  return result;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

Matrix covariance_over(std::span<const Wins> subjects, const Ranking& pooled, const Wins& all) {
  const std::size_t items = all.size();
  const auto n = static_cast<double>(subjects.size());
  const Matrix information = derivatives(all, pooled.scale, pooled.worth).information;
  Matrix covariance(items, std::vector<double>(items, 0.0));
  for (const Wins& wins : subjects) {
    const RankingDerivatives own = derivatives(wins, pooled.scale, pooled.worth);
    Matrix others = information;
    for (std::size_t i = 0; i < items; ++i) {
      for (std::size_t j = 0; j < items; ++j) others[i][j] -= own.information[i][j];
    }
    const std::vector<double> step = product(covariance_of(std::move(others)), own.gradient);
    for (std::size_t i = 0; i < items; ++i) {
      require(std::isfinite(step[i]) && std::abs(step[i]) < 1e6,
              "without one of the subjects the items cannot be ranked: let each pair be compared by several");
      for (std::size_t j = 0; j < items; ++j) covariance[i][j] += (n - 1.0) / n * step[i] * step[j];
    }
  }
  return covariance;
}

/// T of one way to turn the subjects round, of the scores g_s.
class FlippedScore {
 public:
  FlippedScore(std::span<const Wins> subjects, const Wins& all, Scale scale) {
    const std::vector<double> equal(all.size(), 0.0);
    inverse_ = covariance_of(derivatives(all, scale, equal).information);
    for (const Wins& wins : subjects) scores_.push_back(derivatives(wins, scale, equal).gradient);
  }

  [[nodiscard]] std::size_t subjects() const { return scores_.size(); }

  template <typename IsTurned>
  [[nodiscard]] double value(const IsTurned& is_turned) const {
    std::vector<double> sum(scores_.front().size(), 0.0);
    for (std::size_t subject = 0; subject < scores_.size(); ++subject) {
      const double sign = is_turned(subject) ? -1.0 : 1.0;
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += sign * scores_[subject][i];
    }
    return dot(sum, product(inverse_, sum));
  }

 private:
  Matrix inverse_;
  Matrix scores_;
};

void test_equality(const FlippedScore& score, const SignFlipOptions& options, SubjectsRanking& result) {
  const std::size_t n = score.subjects();
  const double seen = score.value([](std::size_t) { return false; }) * (1.0 - 1e-12);
  result.is_exact = n <= most_subjects_counted;
  if (result.is_exact) {
    // The last subject is never turned: all turned round is the same as none.
    const std::uint32_t flips = 1U << (n - 1);
    std::uint32_t as_large = 0;
    for (std::uint32_t flip = 0; flip < flips; ++flip)
      as_large +=
          score.value([&](std::size_t subject) { return ((flip >> subject) & 1U) != 0; }) >= seen ? 1 : 0;
    result.p = static_cast<double>(as_large) / flips;
    result.least_p = 1.0 / flips;
    return;
  }
  Random random(options.seed);
  int as_large = 1;
  for (int sample = 0; sample < options.samples; ++sample)
    as_large += score.value([&](std::size_t) { return random.below(2) == 1; }) >= seen ? 1 : 0;
  result.least_p = 1.0 / (1.0 + options.samples);
  result.p = as_large * result.least_p;
}

}  // namespace

SubjectsRanking rank_over_subjects(std::span<const Wins> subjects, const SignFlipOptions& options,
                                   Scale scale) {
  require(subjects.size() >= 2, "a ranking over subjects needs two of them at least");
  require(options.samples >= 99, "flips that are drawn must be 99 or more");
  const Wins all = added_up(subjects);
  SubjectsRanking result;
  result.pooled = rank(all, scale);
  result.subjects = subjects.size();
  result.covariance = covariance_over(subjects, result.pooled, all);
  test_equality(FlippedScore(subjects, all, scale), options, result);
  return result;
}

Difference difference(const SubjectsRanking& ranking, std::size_t first, std::size_t second) {
  Difference result = difference(ranking.pooled, first, second);
  const auto& c = ranking.covariance;
  result.standard_error = std::sqrt(c[first][first] + c[second][second] - 2.0 * c[first][second]);
  const boost::math::students_t student(static_cast<double>(ranking.subjects) - 1.0);
  const double t = std::abs(result.value) / result.standard_error;
  // All subjects exactly alike: no spread to hold a difference against.
  result.p = std::isfinite(t) ? 2.0 * boost::math::cdf(boost::math::complement(student, t))
                              : (result.value == 0.0 ? 1.0 : 0.0);
  return result;
}

}  // namespace kerf::psychophysics
