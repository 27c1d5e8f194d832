// A renderer for kerf regress in C++, which needs nothing of Kerf: a wall that relaxes across x, and friction
// along y.
//
//     e' = vx - e / tau,   fx = k (x - x0) + k2 e,   fy = mu k (x - x0) vy / 0.1
//
// while x > x0, else nothing; forces are resisting. The same as spring.py, to the last bit.
//
//     c++ -O2 -ffp-contract=off spring.cpp -o spring
//     ./spring TRAJECTORY FORCES

#include <cstdio>
#include <cstdlib>

namespace {

constexpr double surface = 0.01;  // x0 [m]
constexpr double tau = 0.05;      // [s]

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs("usage: spring TRAJECTORY FORCES\n", stderr);
    return 2;
  }
  std::FILE* const trajectory = std::fopen(arguments[1], "r");
  std::FILE* const forces = std::fopen(arguments[2], "w");
  if (trajectory == nullptr || forces == nullptr) {
    std::fputs("spring: a file cannot be opened\n", stderr);
    return 2;
  }
  char head[256];
  if (std::fgets(head, sizeof head, trajectory) == nullptr) return 2;
  std::fputs("# sign: resisting\ntime[s],fx[N],fy[N]\n", forces);
  double lag = 0.0;
  double last = 0.0;
  char line[512];
  while (std::fgets(line, sizeof line, trajectory) != nullptr) {
    double row[6];  // tick, time, and position and velocity of both axes
    char* at = line;
    for (double& value : row) {
      value = std::strtod(at, &at);
      if (*at == ',') ++at;
    }
    const double now = row[1], x = row[2], vx = row[3], vy = row[5];
    const double period = now - last;
    last = now;
    const double depth = x - surface;
    lag = depth > 0.0 ? lag + period * (vx - lag / tau) : 0.0;
    const double fx = depth > 0.0 ? 400.0 * depth + 200.0 * lag : 0.0;
    const double fy = depth > 0.0 ? 100.0 * depth * vy / 0.1 : 0.0;
    std::fprintf(forces, "%.17g,%.17g,%.17g\n", now, fx, fy);
  }
  (void)std::fclose(trajectory);
  return std::fclose(forces) == 0 ? 0 : 4;
}
