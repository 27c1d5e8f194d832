#include "ruptures/rupture_rows.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <kerf/models/kelvin.h>

#include "infinite.h"

namespace kerf::fitting {
namespace {

double option(const Problem& problem, const char* name) {
  return std::get<double>(problem.law_options.at(name));
}

/// The element since the last rupture, row by row.
class Stretched {
 public:
  Stretched(const Samples& samples, const ElementValues& element)
      : samples_(samples),
        element_{.parallel_stiffness = element[0], .series_stiffness = element[1], .damping = element[2]} {}

  void begin_run() {
    state_ = {};
    reference_ = 0.0;
  }
  double force_at(std::size_t i) {
    return element_.step(state_, {samples_.motion[i].penetration - reference_, samples_.motion[i].velocity},
                         samples_.period_s[i]);
  }
  void rupture_at(std::size_t i) {
    reference_ = samples_.motion[i].penetration;
    state_.started = true;
    state_.rupture();
  }

 private:
  const Samples& samples_;
  models::Kelvin<double> element_;
  models::Kelvin<double>::State state_;
  double reference_ = 0.0;
};

/// Runs the law, a rupture being where `breaks(row, force)` says so; `take(row, force)` has what it gives.
template <typename Breaks, typename Take>
void run_through(const Samples& samples, const ElementValues& element, Breaks&& breaks, Take&& take) {
  Stretched stretched(samples, element);
  for (const Run& run : samples.runs) {
    stretched.begin_run();
    for (std::size_t i = run.begin; i < run.end; ++i) {
      double force = stretched.force_at(i);
      if (breaks(i, force)) {
        stretched.rupture_at(i);
        force = 0.0;
      }
      take(i, force);
    }
  }
}

bool is_beyond(double force, double speed, const RuptureLine& line) {
  return force > 0.0 && force >= line.per_speed * speed + line.constant;
}

/// What an element leaves between ruptures that are tried.
class LeftBetween {
 public:
  LeftBetween(const BreakingSamples& data, const ElementValues& element)
      : data_(data), stretched_(data.samples, element) {}

  /// Squares of rows from one rupture (or the begin of a run) to before the next, infinite once they are more
  /// than `most`.
  double squares(std::size_t from, bool ruptures, std::size_t to, double most = infinite) {
    stretched_.begin_run();
    double sum = 0.0;
    std::size_t i = from;
    if (ruptures) {
      stretched_.rupture_at(i);
      sum += square(i, 0.0);
      ++i;
    }
    for (; i < to; ++i) {
      sum += square(i, stretched_.force_at(i));
      if (sum > most) return infinite;
    }
    return sum;
  }

 private:
  [[nodiscard]] double square(std::size_t i, double force) const {
    const double residual = force - data_.samples.force[i];
    return data_.weights[i] > 0.0 ? data_.loss(data_.weights[i] * residual * residual).rho : 0.0;
  }

  const BreakingSamples& data_;
  Stretched stretched_;
};

/// A run's ruptures with its ends, and ruptures moved among them.
class RunOfRuptures {
 public:
  RunOfRuptures(LeftBetween& left, const Run& run, RuptureRows rows)
      : left_(left), run_(run), rows_(std::move(rows)) {}

  [[nodiscard]] const RuptureRows& rows() const { return rows_; }

  /// What is left on both sides of a rupture: from the one before to the one after.
  [[nodiscard]] double around(std::size_t k) { return around(k, rows_[k]); }
  [[nodiscard]] double around(std::size_t k, std::size_t row, double most = infinite) {
    const double before = squares(k, row, most);
    return before > most ? infinite : before + left_.squares(row, true, end_of(k), most - before);
  }
  [[nodiscard]] double without(std::size_t k, double most = infinite) { return squares(k, end_of(k), most); }
  [[nodiscard]] bool is_between(std::size_t k, std::size_t row) const {
    return row > begin_of(k) && row < end_of(k);
  }

  /// Whether one of the ruptures was moved to where less is left.
  bool move(double worth) {
    bool moved = false;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      double least = around(k);
      const std::size_t at = rows_[k];
      for (const std::ptrdiff_t way : {-1, 1, -2, 2}) {
        const std::size_t row = at + static_cast<std::size_t>(way);
        if (!is_between(k, row)) continue;
        const double squares = around(k, row, least);
        if (squares < least - worth) {
          least = squares;
          rows_[k] = row;
          moved = true;
        }
      }
    }
    return moved;
  }
  /// What is left of the run.
  [[nodiscard]] double all() {
    if (rows_.empty()) return left_.squares(run_.begin, false, run_.end);
    double sum = 0.0;
    for (std::size_t k = 0; k <= rows_.size(); ++k)
      sum += squares(k, k < rows_.size() ? rows_[k] : run_.end, infinite);
    return sum;
  }

 private:
  [[nodiscard]] std::size_t begin_of(std::size_t k) const { return k > 0 ? rows_[k - 1] : run_.begin; }
  [[nodiscard]] std::size_t end_of(std::size_t k) const {
    return k + 1 < rows_.size() ? rows_[k + 1] : run_.end;
  }
  [[nodiscard]] double squares(std::size_t k, std::size_t to, double most) {
    return left_.squares(begin_of(k), k > 0, to, most);
  }

  LeftBetween& left_;
  const Run& run_;
  RuptureRows rows_;
};

RuptureRows those_in(const RuptureRows& rows, const Run& run) {
  RuptureRows those;
  std::ranges::copy_if(rows, std::back_inserter(those),
                       [&](std::size_t row) { return row >= run.begin && row < run.end; });
  return those;
}

}  // namespace

BreakingSamples::BreakingSamples(const Problem& problem, const Samples& all, const Weights& seen,
                                 const RobustLoss& robust)
    : samples(all), weights(seen), loss(robust) {
  const double least = option(problem, "least_speed");
  const double most = option(problem, "most_speed");
  for (const models::Motion& motion : samples.motion)
    speed.push_back(std::min(std::max(std::abs(motion.velocity), least), most));
}

RuptureRows moved_to_least(const BreakingSamples& data, const ElementValues& element,
                           const RuptureRows& rows) {
  constexpr double worth = 10.0;  // of the mean square: what a rupture has to be worth, or its place
  constexpr int most_rounds = 4;
  LeftBetween left(data, element);
  RuptureRows all;
  for (const Run& run : data.samples.runs) {
    RunOfRuptures ruptures(left, run, those_in(rows, run));
    const double mean = ruptures.all() / static_cast<double>(run.end - run.begin);
    for (int round = 0; round < most_rounds && ruptures.move(worth * mean); ++round) {
    }
    all.insert(all.end(), ruptures.rows().begin(), ruptures.rows().end());
  }
  return all;
}

Broken broken_at(const BreakingSamples& data, const ElementValues& element, const RuptureLine& line) {
  Broken broken;
  run_through(
      data.samples, element,
      [&](std::size_t i, double force) {
        const bool breaks = is_beyond(force, data.speed[i], line);
        if (breaks) broken.rows.push_back(i);
        return breaks;
      },
      [&](std::size_t i, double force) {
        const double residual = force - data.samples.force[i];
        broken.squares += data.loss(data.weights[i] * residual * residual).rho;
      });
  if (!std::isfinite(broken.squares)) broken.squares = infinite;
  return broken;
}

namespace {

/// Ruptures among samples that are not seen, by a line and by what is seen after them.
class Completion {
 public:
  Completion(const BreakingSamples& data, const ElementValues& element, const RuptureLine& line,
             const RuptureRows& seen)
      : data_(data), element_(element), line_(line), seen_(seen) {}

  [[nodiscard]] RuptureRows rows() {
    constexpr int most_corrections = 20;
    for (int i = 0; i < most_corrections && !run(); ++i) {
    }
    return all_;
  }

 private:
  /// False where what comes next in the samples that are seen does not fit, which is then set right.
  bool run() {
    all_.clear();
    last_unseen_ = none;
    right_ = true;
    run_through(
        data_.samples, element_,
        [this](std::size_t i, double force) {
          const bool breaks = data_.weights[i] > 0.0 ? breaks_in_sight(i, force) : breaks_unseen(i, force);
          if (breaks) all_.push_back(i);
          return breaks;
        },
        [](std::size_t, double) {});
    return right_;
  }
  bool breaks_unseen(std::size_t i, double force) {
    last_unseen_ = i;
    const auto is_spared = [&](const Run& rows) { return rows.begin <= i && i < rows.end; };
    return std::ranges::find(added_, i) != added_.end() ||
           (is_beyond(force, data_.speed[i], line_) && std::ranges::none_of(spared_, is_spared));
  }
  bool breaks_in_sight(std::size_t i, double force) {
    constexpr double too_little = 0.5;  // of the threshold, to have ruptured again
    constexpr double too_much = 1.3;    // to be whole
    const bool breaks = std::ranges::binary_search(seen_, i);
    const double threshold = line_.per_speed * data_.speed[i] + line_.constant;
    if (!right_ || !(threshold > 0.0)) return breaks;
    const bool before_unseen = !all_.empty() && !(data_.weights[all_.back()] > 0.0);
    if (breaks && before_unseen && force < too_little * threshold) {
      spared_.push_back({.begin = all_.back(), .end = i});
      right_ = false;
    } else if (!breaks && last_unseen_ != none && (all_.empty() || all_.back() < last_unseen_) &&
               force > too_much * threshold) {
      added_.push_back(last_unseen_);
      right_ = false;
    }
    return breaks;
  }

  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  const BreakingSamples& data_;
  const ElementValues& element_;
  const RuptureLine& line_;
  const RuptureRows& seen_;
  RuptureRows all_, added_;
  std::vector<Run> spared_;
  std::size_t last_unseen_ = none;
  bool right_ = true;
};

}  // namespace

RuptureRows completed(const BreakingSamples& data, const ElementValues& element, const RuptureLine& line,
                      const RuptureRows& seen) {
  return Completion(data, element, line, seen).rows();
}

double rise_of_other_rows(const BreakingSamples& data, const ElementValues& element,
                          const RuptureRows& rows) {
  LeftBetween left(data, element);
  double least = infinite;
  for (const Run& run : data.samples.runs) {
    RunOfRuptures ruptures(left, run, those_in(rows, run));
    for (std::size_t k = 0; k < ruptures.rows().size(); ++k) {
      const double now = ruptures.around(k);
      const std::size_t row = ruptures.rows()[k];
      least = std::min(least, ruptures.without(k) - now);
      for (const std::size_t other : {row - 1, row + 1}) {
        if (ruptures.is_between(k, other)) least = std::min(least, ruptures.around(k, other) - now);
      }
    }
  }
  return least;
}

}  // namespace kerf::fitting
