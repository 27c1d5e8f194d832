// The renderer of spring.cpp, asked tick by tick by kerf regress over its standard input and output: it is
// started once a case, says what it answers, and gives a line for each line. It needs nothing of Kerf.
//
//     c++ -O2 -ffp-contract=off lockstep.cpp -o lockstep

#include <chrono>
#include <cstdio>
#include <cstring>

namespace {

constexpr double surface = 0.01;  // x0 [m]
constexpr double tau = 0.05;      // [s]

}  // namespace

int main() {
  char line[4096];
  if (std::fgets(line, sizeof line, stdin) == nullptr || std::strstr(line, "\"version\":1,") == nullptr) {
    std::fputs("lockstep: expected the hello of kerf regress, version 1\n", stderr);
    return 2;
  }
  std::puts(
      R"({"hello":"kerf lockstep","version":1,"sign":"resisting","columns":["tick","fx[N]","fy[N]","compute_time[s]"]})");
  std::fflush(stdout);
  double lag = 0.0;
  double last = 0.0;
  while (std::fgets(line, sizeof line, stdin) != nullptr) {
    unsigned long tick;
    double now, x, vx, y, vy;
    if (std::sscanf(line, "%lu,%lf,%lf,%lf,%lf,%lf", &tick, &now, &x, &vx, &y, &vy) != 6) return 2;
    const auto begin = std::chrono::steady_clock::now();
    const double period = now - last;
    last = now;
    const double depth = x - surface;
    lag = depth > 0.0 ? lag + period * (vx - lag / tau) : 0.0;
    const double fx = depth > 0.0 ? 400.0 * depth + 200.0 * lag : 0.0;
    const double fy = depth > 0.0 ? 100.0 * depth * vy / 0.1 : 0.0;
    const std::chrono::duration<double> cost = std::chrono::steady_clock::now() - begin;
    std::printf("%lu,%.17g,%.17g,%.3g\n", tick, fx, fy, cost.count());
    std::fflush(stdout);  // the next tick is asked for once this one is answered
  }
  return 0;
}
