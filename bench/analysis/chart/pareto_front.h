#pragma once

#include <span>
#include <string>
#include <vector>

namespace kerf::bench {

/// What a Pareto front is made of: a cost, an error, and what tells points apart that have both alike.
struct ParetoEntry {
  double cost_ns = 0.0;
  double error = 0.0;
  std::size_t parameters = 0;
  std::string name;      ///< of the law
  bool competes = true;  ///< false: not stable, or not comparable
};

/// When two measured costs, and two errors, count as equal.
struct ParetoTolerance {
  double cost_share = 0.15;
  double cost_ns = 3.0;
  double error_share = 0.02;
  double error_floor = 0.0;  ///< smaller errors count as this one
};

/// Which entries are worth their cost, in order of rising cost.
///
/// The front begins with the cheapest class: the cheapest entry and all whose cost counts as equal to it. Of
/// a class the least error is taken; among those that count as equal to that one in cost and in error the one
/// with the fewest parameters, then the first by name, then the first given. Then again among the entries
/// with an error that is truly smaller than the last one's, until there are none. So a few nanoseconds of a
/// busy machine do not decide between two laws, unless one lies at the very edge of a class.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const ParetoEntry> entries,
                                                    const ParetoTolerance& tolerance = {});

}  // namespace kerf::bench
