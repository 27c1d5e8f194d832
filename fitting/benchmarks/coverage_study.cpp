#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "fitting/coverage.h"

// How often intervals of 95 % cover the truth, over simulated recordings of two laws along two motions under
// six kinds of noise: a table on the terminal, and all numbers as JSON. The trials are numbered, and each
// draws its noise from a seed of its own, so that the result does not depend on the number of processors.
//
//     kerf_coverage_study [trials] [FILE.json] [seconds of recording]

namespace kerf::test {
namespace {

constexpr double noise_n = 0.02;

struct Row {
  std::string scenario, noise, parameter;
  double duration_s = 0.0;
  double coverage = 0.0;
  double true_deviation = 0.0;       ///< of the estimates, on the search scale
  double estimated_deviation = 0.0;  ///< root of the mean of the estimated variances
  double quantile = 0.0;             ///< mean
};

std::vector<Trial> trials_of(const Scenario& scenario, const Noise& noise, std::size_t count,
                             std::uint64_t seed) {
  std::vector<Trial> trials(count);
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

std::vector<Row> rows_of(const Scenario& scenario, const Noise& noise, const std::vector<Trial>& trials) {
  const auto n = static_cast<double>(trials.size());
  std::vector<Row> rows;
  for (std::size_t k = 0; k < 3; ++k) {
    Row row{.scenario = scenario.name,
            .noise = noise.name,
            .parameter = scenario.names[k],
            .duration_s = period_s * static_cast<double>(scenario.path.size())};
    for (const Trial& trial : trials) {
      row.coverage += (trial.covered[k] ? 1.0 : 0.0) / n;
      row.true_deviation += trial.error[k] * trial.error[k] / n;
      row.estimated_deviation += trial.deviation[k] * trial.deviation[k] / n;
      row.quantile += trial.quantile[k] / n;
    }
    row.true_deviation = std::sqrt(row.true_deviation);
    row.estimated_deviation = std::sqrt(row.estimated_deviation);
    rows.push_back(row);
  }
  return rows;
}

void print(const std::vector<Row>& rows) {
  std::printf("%-21s %-20s %3.0f s", rows[0].scenario.c_str(), rows[0].noise.c_str(), rows[0].duration_s);
  for (const Row& row : rows) {
    std::printf("  %5s %5.1f %% (%.2f)", row.parameter.c_str(), 100.0 * row.coverage,
                row.estimated_deviation / row.true_deviation);
  }
  std::printf("\n");
  std::fflush(stdout);
}

void write(const std::vector<Row>& rows, std::size_t trials, const std::string& path) {
  std::ofstream file(path);
  file << "{\"confidence\": 0.95, \"trials\": " << trials << ", \"rows\": [";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    file << (i == 0 ? "\n" : ",\n") << "  {\"scenario\": \"" << row.scenario << "\", \"noise\": \""
         << row.noise << "\", \"duration_s\": " << row.duration_s << ", \"parameter\": \"" << row.parameter
         << "\", \"coverage\": " << row.coverage << ", \"true_deviation\": " << row.true_deviation
         << ", \"estimated_deviation\": " << row.estimated_deviation << ", \"quantile\": " << row.quantile
         << "}";
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

void run(std::size_t count, const std::string& path, double only_s) {
  const std::vector<Noise> noises{Noise::white(),
                                  Noise::first_order("AR(1) 0.9", 0.9),
                                  Noise::first_order("AR(1) 0.99", 0.99),
                                  Noise::resonant(),
                                  Noise::low_passed(),
                                  Noise::pink()};
  print_costs(noises);
  std::printf("coverage of 95 %% (estimated over true standard error), %zu trials\n", count);
  std::vector<Row> all;
  std::uint64_t seed = 1;
  for (const double duration_s : {2.0, 10.0, 60.0}) {
    const Path hold = ramp_and_hold(duration_s, 0.1);
    const Path stroke = strokes(duration_s, 0.1);
    for (const Scenario& scenario :
         {kelvin("hold", hold, std::min(2.0, 0.2 * duration_s)), kelvin("strokes", stroke, 0.3),
          exponential("hold", hold), exponential("strokes", stroke)}) {
      for (const Noise& noise : noises) {
        seed += 1'000'000;
        if (only_s > 0.0 && only_s != duration_s) continue;
        const std::vector<Row> rows = rows_of(scenario, noise, trials_of(scenario, noise, count, seed));
        print(rows);
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
    kerf::test::run(argc > 1 ? std::stoul(argv[1]) : 500, argc > 2 ? argv[2] : "",
                    argc > 3 ? std::stod(argv[3]) : 0.0);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kerf_coverage_study: %s\n", error.what());
    return 1;
  }
}
