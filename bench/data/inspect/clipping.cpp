#include "inspect/clipping.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "inspect/signal_facts.h"

namespace kerf::bench {
namespace {

constexpr std::uint64_t shortest_run = 10;
constexpr std::uint64_t times_longer = 3;
constexpr double noises_moved = 4.0;

void add_run(EndOfRange& end, RowSpan run) {
  const std::uint64_t length = run.end - run.begin;
  end.rows += length;
  end.longest = std::max<std::uint64_t>(end.longest, length);
  if (length < shortest_run) return;
  ++end.runs;
  if (end.first_runs.size() < EndOfRange::most_runs) end.first_runs.push_back(run);
}

double range_within(const BlockedValues& values, RowSpan span) {
  double least = values[span.begin];
  double most = least;
  for (std::size_t row = span.begin; row < span.end; ++row) {
    least = std::min(least, values[row]);
    most = std::max(most, values[row]);
  }
  return most - least;
}

void judge(EndOfRange& end, std::uint64_t longest_between, const BlockedValues& position, double noise) {
  if (end.value == 0.0 || end.longest < std::max(shortest_run, times_longer * longest_between)) return;
  const bool moved = std::ranges::any_of(
      end.first_runs, [&](const RowSpan& run) { return range_within(position, run) > noises_moved * noise; });
  end.is_clipped = moved ? std::optional(true) : std::nullopt;
}

}  // namespace

EndsOfRange ends_of_range(const BlockedValues& values, double least, double most,
                          const BlockedValues& position, double position_noise) {
  EndsOfRange ends;
  ends.least.value = least;
  ends.most.value = most;
  if (!(least < most)) return ends;  // a constant ends nowhere
  for (std::uint64_t begin = 0; begin < values.size();) {
    std::uint64_t end = begin + 1;
    const double value = values[begin];
    while (end < values.size() && values[end] == value) ++end;
    if (value == least) {
      add_run(ends.least, {.begin = begin, .end = end});
    } else if (value == most) {
      add_run(ends.most, {.begin = begin, .end = end});
    } else if (value != 0.0) {
      ends.longest_between = std::max(ends.longest_between, end - begin);
    }
    begin = end;
  }
  judge(ends.least, ends.longest_between, position, position_noise);
  judge(ends.most, ends.longest_between, position, position_noise);
  return ends;
}

EndsOfRange ends_of_force(const BlockedValues& force, const BlockedValues& position) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (std::size_t row = 0; row < force.size(); ++row) {
    const double value = force[row];
    if (!std::isfinite(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  return ends_of_range(force, least, most, position, noise_of(position, quantum_of(position)).value_or(0.0));
}

}  // namespace kerf::bench
