#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace kerf::bench {

/// What a Pareto front is made of: a cost, an error, and what tells points apart that have both alike.
struct ParetoEntry {
  double cost_ns = 0.0;
  double error = 0.0;  ///< [JND]
  std::size_t parameters = 0;
  std::string name;      ///< of the law
  bool competes = true;  ///< false: not stable, or not comparable
};

/// When two measured costs count as equal.
struct ParetoTolerance {
  double cost_share = 0.15;
  double cost_ns = 3.0;
};

/// Whether one entry's error is as good as that of another, by their places.
using AsGood = std::function<bool(std::size_t one, std::size_t other)>;

/// Which entries are worth their cost, in order of rising cost.
///
/// The front begins with the cheapest class: the cheapest entry and all whose cost counts as equal to it. Of
/// a class the least error is taken; among those that count as equal to that one in cost and are as good the
/// one with the fewest parameters, then the first by name, then the first given. Then again among the entries
/// with a smaller error than the last one's that the last one is not as good as, until there are none. So a
/// few nanoseconds of a busy machine do not decide between two laws, unless one lies at the very edge of a
/// class.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const ParetoEntry> entries,
                                                    const AsGood& as_good,
                                                    const ParetoTolerance& tolerance = {});

/// As good is what leaves out no more than a JND against the other (fitting::left_out()).
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const ParetoEntry> entries);

}  // namespace kerf::bench
