#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "fitting/uncertainty/coverage.h"
#include "uncertainty/uncertainty.h"

// How often intervals of 95 % hold what they should, over simulated recordings: laws that are the tissue's
// and laws that misfit it, along a hold and along strokes, under noise of several kinds. A table on the
// terminal, and all numbers as JSON. The trials are numbered, and each draws its noise from a seed of its
// own, so that the result does not depend on the number of processors.
//
//     kerf_coverage_study [trials, 0: name the cells alone] [FILE.json] [seconds of recording, 0: all]
//                         [first trial] [number of a cell]

namespace kerf::test {
namespace {

constexpr double noise_n = 0.02;

struct Row {
  std::string scenario, noise, parameter;
  std::size_t cell = 0;
  double duration_s = 0.0;
  std::size_t held = 0;         ///< trials whose interval holds the target
  std::size_t open = 0;         ///< whose interval has no limit on a side
  double true_deviation = 0.0;  ///< of the estimates, over the target
  double half_width = 0.0;      ///< median of half the intervals, over the target
};

using Estimates = std::vector<fitting::Estimate>;

std::vector<Estimates> trials_of(const Scenario& scenario, const Noise& noise, std::size_t count,
                                 std::uint64_t seed) {
  std::vector<Estimates> trials(count);
  const std::size_t workers = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::thread> threads;
  for (std::size_t worker = 0; worker < workers; ++worker) {
    threads.emplace_back([&, worker] {
      for (std::size_t i = worker; i < count; i += workers) {
        const auto rows = static_cast<Eigen::Index>(scenario.path.size());
        trials[i] = run_trial(scenario, noise.draw(rows, noise_n, seed + i));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  return trials;
}

Row row_of(const std::vector<Estimates>& trials, std::size_t k, double target) {
  Row row{.parameter = trials[0][k].info.name};
  std::vector<double> halves;
  for (const Estimates& trial : trials) {
    const fitting::Estimate& estimate = trial[k];
    row.held += holds(estimate, target) ? 1 : 0;
    row.open += std::isfinite(estimate.lower) && std::isfinite(estimate.upper) ? 0 : 1;
    row.true_deviation += std::pow(estimate.value / target - 1.0, 2) / static_cast<double>(trials.size());
    halves.push_back(0.5 * (estimate.upper - estimate.lower) / std::abs(target));
  }
  row.true_deviation = std::sqrt(row.true_deviation);
  const auto middle = halves.begin() + static_cast<std::ptrdiff_t>(halves.size() / 2);
  std::nth_element(halves.begin(), middle, halves.end());
  row.half_width = *middle;
  return row;
}

std::vector<Row> rows_of(const Scenario& scenario, const Noise& noise, std::size_t count,
                         std::uint64_t seed) {
  std::vector<Row> rows(1);
  if (count > 0) {
    const std::vector<double> target = targets(scenario);
    const std::vector<Estimates> trials = trials_of(scenario, noise, count, seed);
    rows.resize(target.size());
    for (std::size_t k = 0; k < target.size(); ++k) rows[k] = row_of(trials, k, target[k]);
  }
  for (Row& row : rows) {
    row.scenario = scenario.name;
    row.noise = noise.name;
    row.duration_s = tick_s * static_cast<double>(scenario.path.size());
  }
  return rows;
}

void print(const std::vector<Row>& rows, std::size_t trials) {
  std::printf("%-34s %-18s %3.0f s", rows[0].scenario.c_str(), rows[0].noise.c_str(), rows[0].duration_s);
  for (const Row& row : rows) {
    std::printf("  %s %.2f %% (%.2f)", row.parameter.c_str(),
                100.0 * static_cast<double>(row.held) / static_cast<double>(trials),
                row.half_width / (1.96 * row.true_deviation));
  }
  std::printf("\n");
  std::fflush(stdout);
}

void write(const std::vector<Row>& rows, std::size_t trials, const std::string& path) {
  std::ofstream file(path);
  file << "{\"confidence\": 0.95, \"trials\": " << trials << ", \"rows\": [";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    file << (i == 0 ? "\n" : ",\n") << "  {\"cell\": " << row.cell << ", \"scenario\": \"" << row.scenario
         << "\", \"noise\": \"" << row.noise << "\", \"duration_s\": " << row.duration_s
         << ", \"parameter\": \"" << row.parameter << "\", \"held\": " << row.held
         << ", \"open\": " << row.open << ", \"true_deviation\": " << row.true_deviation
         << ", \"half_width\": ";
    if (std::isfinite(row.half_width)) {
      file << row.half_width << "}";
    } else {
      file << "null}";
    }
  }
  file << "\n]}\n";
  file.close();
  if (!file) throw std::runtime_error("cannot write '" + path + "'");
}

/// Processor time, the least of several.
double cost_ms(const fitting::Linearisation& linearisation) {
  double least = 1e9;
  for (int i = 0; i < 9; ++i) {
    const std::clock_t begin = std::clock();
    (void)fitting::uncertainty_of(linearisation, 0.95);
    least = std::min(least, 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return least;
}

void print_costs(const std::vector<Noise>& noises) {
  constexpr Eigen::Index rows = 60'000;
  const Path hold = ramp_and_hold(60.0, 0.1);
  const Rendered smooth = render_kelvin({std::log(8.0), std::log(7.0), std::log(14.0)}, hold);
  const Rendered clipped = render_kelvin({std::log(8.0), std::log(7.0), std::log(2.0)}, strokes(60.0, 0.1));
  Eigen::MatrixXd many(rows, 30);
  for (Eigen::Index k = 0; k < 30; ++k) {
    for (Eigen::Index i = 0; i < rows; ++i) many(i, k) = std::cos(1e-4 * static_cast<double>((k + 1) * i));
  }
  for (const Noise& noise : noises) {
    const Eigen::VectorXd residuals = noise.draw(rows, noise_n, 1);
    std::printf("60,000 rows, %-20s hold %.2f ms, strokes %.2f ms, 30 parameters %.1f ms\n",
                noise.name.c_str(), cost_ms({.jacobian = smooth.jacobian, .residuals = residuals}),
                cost_ms({.jacobian = clipped.jacobian, .residuals = residuals}),
                cost_ms({.jacobian = many, .residuals = residuals}));
  }
}

std::vector<Scenario> scenarios(double duration_s) {
  const Path hold = ramp_and_hold(duration_s, 0.1);
  const HandStrokes hand(duration_s, 0.1);
  const Path even = strokes(duration_s, 0.1);
  const double time_s = std::min(2.0, 0.2 * duration_s);
  std::vector<Scenario> all{{"kelvin, hold", "kelvin", kelvin(time_s), hold, {}},
                            {"kelvin, strokes", "kelvin", kelvin(0.3), even, {}},
                            {"exponential, hold", "exponential", exponential(), hold, {}},
                            {"exponential, strokes", "exponential", exponential(), even, {}},
                            {"kelvin, cycles", "kelvin", kelvin(0.3), hand.path, hand.cycle},
                            {"exponential, cycles", "exponential", exponential(), hand.path, hand.cycle}};
  for (const Scenario& sound : std::vector<Scenario>(all)) {
    Scenario quantised(sound);
    quantised.name += ", quantum of 0.05 N";
    quantised.quantum_n = 0.05;
    all.push_back(quantised);
  }
  all.push_back({"kelvin on two times, hold", "kelvin", two_times(time_s), hold, {}});
  all.push_back({"kelvin on two times, cycles", "kelvin", two_times(0.3), hand.path, hand.cycle});
  all.push_back({"exponential on a power, hold", "exponential", power(), hold, {}});
  all.push_back({"exponential on a power, cycles", "exponential", power(), hand.path, hand.cycle});
  return all;
}

void run(std::size_t count, const std::string& path, double only_s, std::uint64_t first,
         std::size_t only_cell) {
  const std::vector<Noise> noises{Noise::white(),
                                  Noise::first_order("AR(1) 0.9", 0.9),
                                  Noise::first_order("AR(1) 0.99", 0.99),
                                  Noise::resonant(),
                                  Noise::low_passed(),
                                  Noise::pink()};
  constexpr std::size_t of_variants = 2;  // quantised and misspecified: white noise and noise with a memory
  if (only_cell == 0 && count > 0) print_costs(noises);
  std::printf("coverage of 95 %% (half the interval over 1.96 true standard errors), %zu trials\n", count);
  std::vector<Row> all;
  std::uint64_t seed = 1;
  std::size_t cell = 0;
  for (const double duration_s : {2.0, 10.0, 60.0}) {
    for (const Scenario& scenario : scenarios(duration_s)) {
      const bool sound = scenario.model == scenario.tissue.model() && scenario.quantum_n == 0.0;
      for (std::size_t i = 0; i < (sound ? noises.size() : of_variants); ++i) {
        seed += 1'000'000;
        ++cell;
        if ((only_s > 0.0 && only_s != duration_s) || (only_cell > 0 && only_cell != cell)) continue;
        std::vector<Row> rows = rows_of(scenario, noises[i], count, seed + first);
        for (Row& row : rows) row.cell = cell;
        if (count > 0) print(rows, count);
        all.insert(all.end(), rows.begin(), rows.end());
      }
    }
  }
  if (!path.empty()) write(all, count, path);
}

}  // namespace
}  // namespace kerf::test

int main(int argc, char** argv) {
  try {
    kerf::test::run(argc > 1 ? std::stoul(argv[1]) : 2000, argc > 2 ? argv[2] : "",
                    argc > 3 ? std::stod(argv[3]) : 0.0, argc > 4 ? std::stoul(argv[4]) : 0,
                    argc > 5 ? std::stoul(argv[5]) : 0);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kerf_coverage_study: %s\n", error.what());
    return 1;
  }
}
