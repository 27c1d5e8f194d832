#include "starts/prony.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>

namespace kerf::fitting {
namespace {

constexpr std::size_t times = 12;  ///< of the dictionary
constexpr std::size_t families_kept = 6;

/// Normal equations of a spring and one arm for each time of the dictionary, each of stiffness one.
struct Dictionary {
  std::vector<double> time_s;
  Eigen::MatrixXd normal;
  Eigen::VectorXd right;
  double squares = 0.0;
};

std::vector<double> times_over(const Decades& decades) {
  std::vector<double> all;
  for (std::size_t i = 0; i < times; ++i) {
    const double share = static_cast<double>(i) / (times - 1);
    all.push_back(decades.shortest_s * std::pow(decades.longest_s / decades.shortest_s, share));
  }
  return all;
}

Dictionary dictionary_of(const Samples& samples, const ArmProducts& products) {
  Dictionary all;
  all.time_s = times_over(decades_of(samples));
  const Eigen::Index terms = products.series.terms();
  Eigen::MatrixXd to_times = Eigen::MatrixXd::Zero(1 + static_cast<Eigen::Index>(times), 1 + terms);
  to_times(0, 0) = 1.0;
  for (std::size_t i = 0; i < times; ++i) {
    to_times.row(1 + static_cast<Eigen::Index>(i)).tail(terms) =
        products.series.at(std::log(all.time_s[i])).value;
  }
  all.normal = to_times * products.normal * to_times.transpose();
  all.right = to_times * products.right;
  all.squares = products.squares;
  return all;
}

/// The same of the law itself, which lets go where an arm and the spring would pull.
Dictionary dictionary_of(std::string_view model, const Samples& samples, const Weights& weights) {
  Dictionary all;
  all.time_s = times_over(decades_of(samples));
  const auto rows = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd columns(rows, static_cast<Eigen::Index>(times) + 1);
  Eigen::VectorXd force(rows);
  const models::Options one_arm{{"arms", 1.0}};
  for (std::size_t i = 0; i < times; ++i) {
    for (std::size_t run = 0; run < samples.runs.size(); ++run) {
      const auto begin = static_cast<Eigen::Index>(samples.runs[run].begin);
      const auto count = static_cast<Eigen::Index>(samples.runs[run].end) - begin;
      const std::vector<double> values{1.0, 1.0, all.time_s[i]};
      const std::vector<double> slope{1.0, 1.0, 0.0};
      Eigen::MatrixXd pair(count, 2);
      (void)kernel_of(model).rows({.values = values, .slope = slope, .options = one_arm},
                                  view_of(samples, weights, run), force.segment(begin, count), pair);
      columns.col(0).segment(begin, count) = pair.col(0);
      columns.col(static_cast<Eigen::Index>(i) + 1).segment(begin, count) = pair.col(1);
    }
  }
  const Eigen::Map<const Eigen::VectorXd> weight(weights.data(), rows);
  const Eigen::Map<const Eigen::VectorXd> measured(samples.force.data(), rows);
  const Eigen::MatrixXd weighed = weight.asDiagonal() * columns;
  all.normal = weighed.transpose() * columns;
  all.right = weighed.transpose() * measured;
  all.squares = measured.dot(weight.cwiseProduct(measured));
  return all;
}

/// What the best springs for these places of the dictionary leave.
double left_by(const Dictionary& dictionary, const std::vector<Eigen::Index>& places) {
  const Eigen::MatrixXd normal = dictionary.normal(places, places);
  const Eigen::VectorXd right = dictionary.right(places);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(right.size());
  const Eigen::VectorXd most = Eigen::VectorXd::Constant(right.size(), 1e9);
  const Eigen::VectorXd springs = solve_bounded(normal, right, {.lower = none, .upper = most});
  return dictionary.squares - 2.0 * springs.dot(right) + springs.dot(normal * springs);
}

/// The families of the best sets of times.
std::vector<LinearFamily> best_of(const Problem& problem, const Dictionary& dictionary) {
  const std::size_t arms = (problem.parameters.size() - 1) / 2;
  struct Set {
    std::vector<Eigen::Index> places;
    double left = 0.0;
  };
  // From the best sets of one arm fewer: every further time is tried with each of them.
  std::vector<Set> sets{{.places = {0}, .left = 0.0}};
  for (std::size_t arm = 0; arm < arms; ++arm) {
    std::vector<Set> larger;
    for (const Set& set : sets) {
      for (auto place = static_cast<Eigen::Index>(1); place <= static_cast<Eigen::Index>(times); ++place) {
        if (std::find(set.places.begin(), set.places.end(), place) != set.places.end()) continue;
        Set next{.places = set.places, .left = 0.0};
        next.places.push_back(place);
        std::sort(next.places.begin(), next.places.end());
        const bool known =
            std::any_of(larger.begin(), larger.end(), [&](const Set& s) { return s.places == next.places; });
        if (known) continue;
        next.left = left_by(dictionary, next.places);
        larger.push_back(std::move(next));
      }
    }
    std::stable_sort(larger.begin(), larger.end(),
                     [](const Set& a, const Set& b) { return a.left < b.left; });
    // While sets grow, more of them are kept than are handed on.
    larger.resize(std::min<std::size_t>(larger.size(), arm + 1 < arms ? 4 * families_kept : families_kept));
    sets = std::move(larger);
  }
  std::vector<LinearFamily> families;
  for (const Set& set : sets) {
    std::vector<double> values(problem.parameters.size(), 1.0);
    std::vector<bool> linear(values.size(), true);
    for (std::size_t arm = 0; arm < arms; ++arm) {
      values[1 + arms + arm] = dictionary.time_s[static_cast<std::size_t>(set.places[arm + 1]) - 1];
      linear[1 + arms + arm] = false;
    }
    families.push_back(family_of(problem, values, linear));
  }
  return families;
}

}  // namespace

std::vector<LinearFamily> prony_families(const Problem& problem, const Samples& samples,
                                         const ArmProducts& products) {
  return best_of(problem, dictionary_of(samples, products));
}

std::vector<LinearFamily> prony_families(const Problem& problem, const Samples& samples,
                                         const Weights& weights) {
  return best_of(problem, dictionary_of(problem.model, samples, weights));
}

}  // namespace kerf::fitting
