// The renderer of spring.cpp, asked tick by tick by kerf regress over its standard input and output: it is
// started once a case, says what it answers, and gives a line for each line. It needs nothing of Kerf.
//
//     c++ -O2 -ffp-contract=off lockstep.cpp -o lockstep

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

constexpr double surface = 0.01;  // x0 [m]
constexpr double tau = 0.05;      // [s]

// The next number of a row.
double next(char*& at) {
  const double value = std::strtod(at, &at);
  if (*at == ',') ++at;
  return value;
}

}  // namespace

int main() {
  char line[4096];
  if (std::fgets(line, sizeof line, stdin) == nullptr || std::strstr(line, "\"version\":1,") == nullptr) {
    std::fputs("lockstep: expected the hello of kerf regress, version 1\n", stderr);
    return 2;
  }
  std::puts(
      R"({"hello":"kerf lockstep","version":1,"sign":"resisting","columns":["tick","fx[N]","fy[N]","compute_time[s]"]})");
  if (std::fflush(stdout) != 0) return 4;
  double lag = 0.0;
  double last = 0.0;
  while (std::fgets(line, sizeof line, stdin) != nullptr) {
    char* at = line;
    const double tick = next(at);
    const double now = next(at);
    const double x = next(at);
    const double vx = next(at);
    next(at);  // y
    const double vy = next(at);
    const auto begin = std::chrono::steady_clock::now();
    const double period = now - last;
    last = now;
    const double depth = x - surface;
    lag = depth > 0.0 ? lag + period * (vx - lag / tau) : 0.0;
    const double fx = depth > 0.0 ? 400.0 * depth + 200.0 * lag : 0.0;
    const double fy = depth > 0.0 ? 100.0 * depth * vy / 0.1 : 0.0;
    const std::chrono::duration<double> cost = std::chrono::steady_clock::now() - begin;
    std::printf("%.0f,%.17g,%.17g,%.3g\n", tick, fx, fy, cost.count());
    // The next tick is asked for once this one is answered.
    if (std::fflush(stdout) != 0) return 4;
  }
  return 0;
}
