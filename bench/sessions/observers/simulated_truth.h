#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "observers/experiment.h"

// What a simulated experiment should find: the same observers, exactly, without a draw.

namespace kerf::bench {

/// Of a pair of samples, or of a level.
struct CellTruth {
  std::string name;
  std::string tissue;
  std::array<std::size_t, 2> pair{};
  double level = std::numeric_limits<double>::quiet_NaN();
  double jnds = 0.0;     ///< how far apart they are
  double d_prime = 0.0;  ///< for a subject of the observer's own JND
  /// Share of right answers; of a preference of those for the first sample, where levels lie on both sides
  /// of those that name the comparison. Over all arrangements and, where they differ, all subjects.
  double share = 0.5;
};

struct SimulatedTruth {
  std::vector<CellTruth> cells;
  double chance = 0.5;
  bool one_sided = true;  ///< the main test
  bool is_of_levels = false;
  /// Share of what the main test counts, over all trials alike; NaN where levels follow the answers.
  double share = std::numeric_limits<double>::quiet_NaN();
  /// What the analysis estimates where it does not know of lapses and bias: that of `share`. NaN: none.
  double d_prime = std::numeric_limits<double>::quiet_NaN();
  double criterion = 0.75;  ///< of the JND: share at which it is read off, or 25 to 75 % of both sides
  double jnd = std::numeric_limits<double>::quiet_NaN();       ///< a level; NaN: none, or `note` says why
  double exponent = std::numeric_limits<double>::quiet_NaN();  ///< of magnitudes, mean of people
  std::string note;
};

/// Exact shares of a protocol's observers.
class AnswerModel {
 public:
  AnswerModel(const Protocol& protocol, const Sensation& sensation, const Observer& observer);

  /// As in CellTruth; `lapses` left out on demand.
  [[nodiscard]] double share(const std::array<std::size_t, 2>& pair, double level, bool lapses = true) const;
  /// Of trials whose slots are filled in one of these ways.
  using Arrangements = std::vector<std::array<std::uint8_t, max_slots>>;
  [[nodiscard]] double share_of(const Arrangements& arrangements, const std::array<std::size_t, 2>& pair,
                                double level, bool lapses = true) const;
  [[nodiscard]] SimulatedTruth truth(std::optional<double> criterion) const;

 private:
  [[nodiscard]] double level_at(double share, double from, double to, bool lapses) const;
  [[nodiscard]] double d_prime_of_two_rates(const std::vector<CellTruth>& cells,
                                            const psychophysics::Task& task) const;
  void find_jnd(std::optional<double> criterion, SimulatedTruth& truth) const;
  [[nodiscard]] std::vector<CellTruth> cells() const;

  const Protocol* protocol_;
  const Sensation* sensation_;
  Observer observer_;
  double per_jnd_;
  std::vector<double> sensitivities_;  ///< of subjects that stand for all who feel anything
  std::vector<double> preferences_;    ///< of subjects that stand for all alike
};

}  // namespace kerf::bench
