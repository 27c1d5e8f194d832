#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "diagnosis/pair.h"
#include "lag.h"
#include "least_squares.h"

namespace kerf::compare {
namespace {

using Columns = std::vector<std::vector<double>>;

/// A signal from its mean, over its spread.
std::vector<double> standardised(const std::vector<double>& values) {
  double mean = 0.0;
  for (const double one : values) mean += one / static_cast<double>(values.size());
  double square = 0.0;
  for (const double one : values) square += (one - mean) * (one - mean) / static_cast<double>(values.size());
  std::vector<double> result;
  result.reserve(values.size());
  for (const double one : values) result.push_back(square > 0.0 ? (one - mean) / std::sqrt(square) : 0.0);
  return result;
}

std::vector<double> slopes_of(const std::vector<double>& values) {
  std::vector<double> slopes(values.size(), 0.0);
  for (std::size_t i = 1; i + 1 < values.size(); ++i) slopes[i] = 0.5 * (values[i + 1] - values[i - 1]);
  if (values.size() > 2) {
    slopes.front() = slopes[1];
    slopes.back() = slopes[values.size() - 2];
  }
  return slopes;
}

/// What an arm of a law remembers of its input over a time, from zero at each contact.
std::vector<double> remembered(const std::vector<double>& input, const std::vector<char>& contact,
                               double ticks) {
  std::vector<double> memory(input.size(), 0.0);
  const double kept = std::exp(-1.0 / ticks);
  double state = 0.0;
  for (std::size_t i = 0; i < input.size(); ++i) {
    state = contact[i] != 0 ? kept * state + (1.0 - kept) * input[i] : 0.0;
    memory[i] = state;
  }
  return memory;
}

/// What the force of a law may be made of: depth and its powers, speed, both, what it remembers, and the
/// expected force with them. All in contact alone.
Columns made_of(const Series& series, const ForcePair& pair) {
  Columns columns;
  columns.emplace_back(pair.rows(), 1.0);
  const std::vector<double> force(pair.expected.begin(), pair.expected.end());
  columns.push_back(force);
  const bool own_axis = series.positions.size() == series.channels.size();
  for (std::size_t axis = 0; axis < series.positions.size(); ++axis) {
    const bool own = !own_axis || axis == pair.channel;
    const std::vector<double> x = standardised(series.positions[axis].value);
    const bool measured = axis < series.velocities.size();
    const std::vector<double> v =
        standardised(measured ? series.velocities[axis].value : slopes_of(series.positions[axis].value));
    const auto add = [&](const auto& term) {
      std::vector<double> column(pair.rows());
      for (std::size_t row = 0; row < pair.rows(); ++row) column[row] = term(row);
      columns.push_back(std::move(column));
    };
    add([&](std::size_t row) { return x[row]; });
    add([&](std::size_t row) { return v[row]; });
    if (!own) continue;
    add([&](std::size_t row) { return x[row] * x[row]; });
    add([&](std::size_t row) { return x[row] * x[row] * x[row]; });
    add([&](std::size_t row) { return v[row] * std::abs(v[row]); });
    add([&](std::size_t row) { return x[row] * v[row]; });
    add([&](std::size_t row) { return x[row] * x[row] * v[row]; });
    add([&](std::size_t row) { return x[row] * force[row]; });
    add([&](std::size_t row) { return v[row] * force[row]; });
    add([&](std::size_t row) { return std::tanh(10.0 * v[row]); });
    for (const double seconds : {0.003, 0.01, 0.03, 0.1, 0.3, 1.0}) {
      columns.push_back(remembered(v, pair.contact, seconds / pair.period_s));
      columns.push_back(remembered(x, pair.contact, seconds / pair.period_s));
    }
  }
  for (std::vector<double>& column : columns) {
    for (std::size_t row = 0; row < pair.rows(); ++row) {
      if (pair.contact[row] == 0) column[row] = 0.0;
    }
  }
  return columns;
}

bool positions_differ(const Series& expected, const Series& got) {
  for (std::size_t axis = 0; axis < expected.positions.size(); ++axis) {
    const auto& a = expected.positions[axis].value;
    const auto& b = got.positions[axis].value;
    const auto [least, most] = std::ranges::minmax(a);
    for (std::size_t row = 0; row < std::min(a.size(), b.size()); ++row) {
      if (std::abs(a[row] - b[row]) > 1e-9 * std::max(most - least, 1e-12)) return true;
    }
  }
  return false;
}

/// In which part of contact the difference is a sum of what the force of a law may be made of. Half of the
/// ticks say how much of each, the other half whether that is so.
void find_parameters(const ForcePair& pair, const Series& series, const Facts& facts, Findings& found) {
  const Columns columns = made_of(series, pair);
  const auto contacts = static_cast<std::size_t>(std::ranges::count(pair.contact, 1));
  if (contacts < 12 * columns.size()) return;
  std::vector<std::size_t> rows;
  for (const std::size_t row : rows_for_all(0, pair.rows())) {
    if (pair.contact[row] != 0 && row % 2 == 0) rows.push_back(row);
  }
  Columns taken;
  for (const std::vector<double>& column : columns) {
    std::vector<double> some;
    some.reserve(rows.size());
    for (const std::size_t row : rows) some.push_back(column[row]);
    taken.push_back(std::move(some));
  }
  std::vector<double> target;
  for (const std::size_t row : rows) target.push_back(pair.difference[row]);
  if (rows.size() < 2 * taken.size()) return;
  const auto weights = nearest_sum(taken, target);
  const double remainder = pair.remainder([&](std::size_t row) {
    double sum = pair.expected[row];
    for (std::size_t i = 0; i < columns.size(); ++i) sum += weights[i] * columns[i][row];
    return sum;
  });
  const bool in_file = facts.law_changed.value_or(false);
  add_finding(
      found, pair,
      {.change = Change::parameters,
       .remainder = remainder,
       .sentence = in_file ? "the parameters of the law: its file has changed, and the difference is a "
                             "function of the same motion"
                           : "another function of the same motion: parameters, or the law's code"});
}

}  // namespace

void find_motion(const ForcePair& pair, const Series& expected, const Series& got, const Facts& facts,
                 Findings& found) {
  const bool known = !expected.positions.empty() && expected.positions.size() == got.positions.size();
  const bool changed = facts.trajectory_changed.value_or(known && positions_differ(expected, got));
  if (changed) {
    // Forces at other positions are other forces: no tick is comparable with its own.
    add_finding(found, pair,
                {.change = Change::trajectory,
                 .remainder = 0.0,
                 .sentence = "the trajectory has changed, so that the force was asked for elsewhere"});
    return;
  }
  if (known) find_parameters(pair, expected, facts, found);
}

}  // namespace kerf::compare
