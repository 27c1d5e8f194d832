#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <future>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <malloc.h>

#include <kerf/fitting/fit.h>

#include "fitting/nist/nist.h"

// Makes a recording, fits it, and prints what came out and how long the fit alone took, as JSON.
//
//     kerf_fit_benchmark make LAW FILE [ROWS]
//         60,000 rows at 1 kHz: time, penetration, velocity, force, as float64
//     kerf_fit_benchmark fit LAW FILE [TURNS [white]]
//         parameters, covariance and intervals
//     kerf_fit_benchmark laws FILE [together]
//         every law, with cross-validation by cycle: one after another, or beside each other
//     kerf_fit_benchmark nist FOLDER [TURNS]
//         the hardest problems of NIST StRD

namespace kerf {
namespace {

constexpr int usual_rows = 60000;
constexpr double period_s = 1e-3;
constexpr double noise_n = 0.02;
constexpr double stroke_hz = 0.7;
constexpr std::size_t threads = 2;

struct Recording {
  std::vector<double> time_s, penetration, velocity, force;
  std::vector<std::uint32_t> cycle;

  [[nodiscard]] fitting::Series series(bool with_cycles) const {
    return {.time_s = time_s,
            .penetration = penetration,
            .velocity = velocity,
            .force = force,
            .cycle = with_cycles ? std::span<const std::uint32_t>(cycle) : std::span<const std::uint32_t>()};
  }
};

/// The laws whose force can be made, and what a fit of them is told.
struct Truth {
  std::string name;
  std::vector<double> values;
  models::Options options;
};
const std::vector<Truth> truths{{"kelvin", {500.0, 800.0, 160.0}, {}},
                                {"exponential", {0.3, 2.5, 4.0}, {{"thickness", 0.01}}}};

models::Law truth_of(const std::string& name) {
  const auto found = std::ranges::find(truths, name, &Truth::name);
  if (found == truths.end()) throw std::invalid_argument("there is no force of '" + name + "' to be made");
  return models::Law::make(name, found->values, found->options);
}

/// Strokes of a hand, 12 mm deep, and the force of a law there, with white noise.
Recording made(const std::string& law_name, int rows) {
  const models::Law law = truth_of(law_name);
  models::Law::State state = law.initial_state();
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal(0.0, noise_n);
  Recording made;
  for (int i = 0; i < rows; ++i) {
    const double t = period_s * i;
    const double phase = 2.0 * std::numbers::pi * stroke_hz * t;
    const double depth = 0.006 * (1.0 - std::cos(phase));
    const double speed = 0.006 * 2.0 * std::numbers::pi * stroke_hz * std::sin(phase);
    made.time_s.push_back(t);
    made.penetration.push_back(depth);
    made.velocity.push_back(speed);
    made.force.push_back(law.step(state, models::Motion{depth, speed}, period_s).force + normal(random));
  }
  return made;
}

void write(const Recording& recording, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  for (const auto* column :
       {&recording.time_s, &recording.penetration, &recording.velocity, &recording.force}) {
    file.write(reinterpret_cast<const char*>(column->data()),
               static_cast<std::streamsize>(column->size() * sizeof(double)));
  }
  file.close();
  if (!file) throw std::invalid_argument("cannot write " + path);
}

Recording read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::size_t rows = std::filesystem::file_size(path) / (4 * sizeof(double));
  Recording recording;
  for (auto* column : {&recording.time_s, &recording.penetration, &recording.velocity, &recording.force}) {
    column->resize(rows);
    file.read(reinterpret_cast<char*>(column->data()), static_cast<std::streamsize>(rows * sizeof(double)));
  }
  if (!file) throw std::invalid_argument("cannot read " + path);
  for (const double t : recording.time_s) {
    recording.cycle.push_back(1 + static_cast<std::uint32_t>(stroke_hz * t));
  }
  return recording;
}

template <typename Work>
double seconds_of(Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <typename Values>
void print(const Values& values) {
  std::cout << '[';
  for (std::size_t i = 0; i < values.size(); ++i) std::cout << (i > 0 ? ", " : "") << values[i];
  std::cout << ']';
}

double squares_of(const fitting::FitResult& result) {
  return result.rmse * result.rmse * static_cast<double>(result.samples);
}

void fit_one(const std::string& law, const std::string& path, int turns, bool white) {
  const Recording recording = read(path);
  fitting::FitOptions options{.folds = 0};
  if (white) options.intervals = fitting::Intervals::white;
  if (const auto told = std::ranges::find(truths, law, &Truth::name); told != truths.end()) {
    options.law_options = told->options;
  }
  fitting::FitResult result;
  std::vector<double> seconds;
  for (int i = 0; i < turns; ++i) {
    seconds.push_back(seconds_of([&] { result = fitting::fit(law, recording.series(false), options); }));
  }
  std::vector<double> values, errors;
  for (const auto& estimate : result.parameters) {
    values.push_back(estimate.value);
    errors.push_back(estimate.std_error);
  }
  std::cout << "{\"sum_of_squares\": " << squares_of(result)
            << ", \"converged\": " << (result.converged ? "true" : "false")
            << ", \"iterations\": " << result.iterations << ", \"values\": ";
  print(values);
  std::cout << ", \"std_errors\": ";
  print(errors);
  std::cout << ", \"seconds\": ";
  print(seconds);
  std::cout << "}\n";
}

/// A law with its folds, in words of JSON.
std::string fit_with_folds(std::string_view law, const Recording& recording) {
  std::ostringstream text;
  text << std::setprecision(17) << "{\"law\": \"" << law << '"';
  try {
    fitting::FitResult result;
    const double seconds =
        seconds_of([&] { result = fitting::fit(law, recording.series(true), {.threads = threads}); });
    text << ", \"parameters\": " << result.free_parameters << ", \"rmse\": " << result.rmse
         << ", \"cv_rmse\": " << (std::isfinite(result.cv_rmse) ? result.cv_rmse : -1.0)
         << ", \"converged\": " << (result.converged ? "true" : "false") << ", \"seconds\": " << seconds
         << '}';
  } catch (const std::invalid_argument& refusal) {
    text << ", \"refused\": \"" << refusal.what() << "\"}";
  }
  return text.str();
}

/// One law after another, or all beside each other, from the last on, as the program has them.
void fit_all(const std::string& path, bool beside_each_other) {
  const Recording recording = read(path);
  const auto laws = fitting::fitted_laws();
  std::vector<std::string> told(laws.size());
  const double seconds = seconds_of([&] {
    std::atomic<std::size_t> next{0};
    const auto take = [&] {
      for (std::size_t k = next++; k < laws.size(); k = next++) {
        const std::size_t law = beside_each_other ? laws.size() - 1 - k : k;
        told[law] = fit_with_folds(laws[law], recording);
      }
    };
    std::vector<std::future<void>> helpers;
    for (std::size_t i = 1; beside_each_other && i < threads; ++i)
      helpers.push_back(std::async(std::launch::async, take));
    take();
    for (auto& helper : helpers) helper.get();
  });
  std::cout << "{\"seconds\": " << seconds << ", \"laws\": [";
  for (const std::string& law : told) std::cout << (law == told.front() ? "\n " : ",\n ") << law;
  std::cout << "\n]}\n";
}

void solve_all(const std::string& folder, int turns) {
  std::cout << '[';
  for (const std::string& name : test::nist_names()) {
    const test::NistProblem problem = test::read_nist(folder, name);
    for (std::size_t start = 0; start < problem.starts.size(); ++start) {
      fitting::Minimum minimum;
      std::vector<double> seconds;
      for (int i = 0; i < turns; ++i) {
        seconds.push_back(seconds_of([&] { minimum = test::solve_nist(problem, problem.starts[start]); }));
      }
      std::cout << (name == test::nist_names().front() && start == 0 ? "\n" : ",\n") << " {\"problem\": \""
                << name << "\", \"start\": " << start + 1
                << ", \"digits\": " << test::digits(minimum.at, problem.certified)
                << ", \"digits_of_squares\": " << test::digits(minimum.sums.squares, problem.squares)
                << ", \"converged\": " << (minimum.converged ? "true" : "false") << ", \"seconds\": ";
      print(seconds);
      std::cout << '}';
    }
  }
  std::cout << "]\n";
}

void run(const std::vector<std::string>& given) {
  const std::string what = given.empty() ? "" : given[0];
  const auto number_at = [&](std::size_t i, int usual = 1) {
    return given.size() > i ? std::stoi(given[i]) : usual;
  };
  std::cout << std::setprecision(17);
  if (what == "make" && given.size() >= 3) return write(made(given[1], number_at(3, usual_rows)), given[2]);
  if (what == "fit" && given.size() >= 3)
    return fit_one(given[1], given[2], number_at(3), given.size() > 4 && given[4] == "white");
  if (what == "laws" && given.size() >= 2)
    return fit_all(given[1], given.size() > 2 && given[2] == "together");
  if (what == "nist" && given.size() >= 2) return solve_all(given[1], number_at(2));
  throw std::invalid_argument(
      "usage: kerf_fit_benchmark make LAW FILE [ROWS] | fit LAW FILE [TURNS [white]] | laws FILE [together] "
      "| "
      "nist FOLDER [TURNS]");
}

}  // namespace
}  // namespace kerf

int main(int count, char** values) {
  mallopt(M_MMAP_THRESHOLD, 1 << 28);  // as kerf itself does
  mallopt(M_TRIM_THRESHOLD, 1 << 28);
  try {
    kerf::run({values + 1, values + count});
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
