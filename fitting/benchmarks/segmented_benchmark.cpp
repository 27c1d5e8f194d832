#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <kerf/fitting/segmented.h>

// Fits the curve of a CSV file (position,force[,weight[,branch]] after one line of names) with every number
// of segments and prints a JSON object of what came out and how long it took. In place of a file,
// `made:POINTS[:loop][:sorted][:noise]` makes a noisy curve of that many points, or nothing but noise.
//
//     kerf_segmented_benchmark FILE [MOST_SEGMENTS [FEWEST_POINTS [CELLS]]]

namespace {

struct Columns {
  std::vector<double> position, force, weight;
  std::vector<std::uint8_t> branch;
};

Columns read(const std::string& name) {
  std::ifstream file(name);
  if (!file) throw std::invalid_argument("cannot read " + name);
  Columns columns;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    if (row.size() < 2) throw std::invalid_argument("a row needs a position and a force: " + line);
    columns.position.push_back(row[0]);
    columns.force.push_back(row[1]);
    if (row.size() > 2) columns.weight.push_back(row[2]);
    if (row.size() > 3) columns.branch.push_back(static_cast<std::uint8_t>(row[3]));
  }
  return columns;
}

/// A hand's stroke over a curve that bends and jumps, with noise.
Columns made(const std::string& what) {
  const auto points = static_cast<std::size_t>(std::stod(what.substr(5)));
  const bool loop = what.find(":loop") != std::string::npos;
  const bool sorted = what.find(":sorted") != std::string::npos;
  const bool noise_only = what.find(":noise") != std::string::npos;
  std::mt19937_64 random(6);
  std::normal_distribution<double> noise(0.0, 0.05);
  Columns columns;
  for (std::size_t i = 0; i < points; ++i) {
    const double phase = static_cast<double>(i) / 3000.0;
    const double x = sorted ? static_cast<double>(i) / static_cast<double>(points)
                            : 0.5 - 0.5 * std::cos(phase) + 1e-4 * noise(random);
    const bool opening = loop && std::sin(phase) < 0.0;
    const double f = noise_only ? 0.0 : std::sin(9.0 * x) * std::exp(x) + (x > 0.62 ? 0.8 : 0.0);
    columns.position.push_back(x);
    columns.force.push_back((opening ? -0.4 : 1.0) * f + noise(random));
    if (loop) columns.branch.push_back(opening ? 1 : 0);
  }
  return columns;
}

void print(std::ostream& out, const std::vector<double>& values) {
  out << '[';
  for (std::size_t i = 0; i < values.size(); ++i) out << (i > 0 ? ", " : "") << values[i];
  out << ']';
}

int run(const std::vector<std::string>& arguments) {
  const std::string& name = arguments.at(0);
  const Columns columns = name.starts_with("made:") ? made(name) : read(name);
  kerf::fitting::SegmentedOptions options;
  if (arguments.size() > 1) options.max_segments = std::stoul(arguments[1]);
  if (arguments.size() > 2) options.fewest_points = std::stoul(arguments[2]);
  if (arguments.size() > 3) options.cells = std::stoul(arguments[3]);
  const std::clock_t begin_cpu = std::clock();
  const auto begin = std::chrono::steady_clock::now();
  const auto curves = kerf::fitting::fit_segments({.position = columns.position,
                                                   .force = columns.force,
                                                   .weight = columns.weight,
                                                   .branch = columns.branch},
                                                  options);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  const double cpu_seconds = static_cast<double>(std::clock() - begin_cpu) / CLOCKS_PER_SEC;
  std::cout << std::setprecision(17) << "{\"seconds\": " << seconds.count()
            << ", \"cpu_seconds\": " << cpu_seconds << ", \"points\": " << columns.position.size()
            << ", \"curves\": [";
  for (const auto& curve : curves) {
    std::cout << (&curve == curves.data() ? "\n" : ",\n") << " {\"segments\": " << curve.segments()
              << ", \"sum_of_squares\": " << curve.sum_of_squares
              << ", \"sum_of_squares_on_grid\": " << curve.sum_of_squares_on_grid
              << ", \"bic\": " << curve.bic
              << ", \"optimal_on_grid\": " << (curve.optimal_on_grid ? "true" : "false")
              << ", \"converged\": " << (curve.converged ? "true" : "false")
              << ", \"iterations\": " << curve.iterations << ", \"knots\": ";
    print(std::cout, curve.knots);
    std::cout << '}';
  }
  std::cout << "]}\n";
  return 0;
}

}  // namespace

int main(int count, char** values) {
  try {
    if (count < 2)
      throw std::invalid_argument("usage: kerf_segmented_benchmark FILE [SEGMENTS [POINTS [CELLS]]]");
    return run({values + 1, values + count});
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
