// A spring that does below a depth what no law should: from its first load on, or where its law file says so.

#include <cmath>
#include <cstdlib>

#include <unistd.h>

#include <kerf/law.h>

namespace {

enum class Mood {
  none,
  no_number,
  crash,
  exit,
  sleep,
  abort,
  throws,
  write_behind,
  shared_memory,
  allocate,
  other_version,
  write_parameters,
  wrong_derivative,
  slow
};

constexpr Mood born = KERF_TEST_MOOD;
constexpr double depth = 0.002;

double remembered = 0.0;  // where no law may remember anything
void* kept = nullptr;

void step(const double* p, void* state, const double* x, const double*, double, double* force) {
  *force = p[0] * *x;
  *static_cast<double*>(state) = *x;
  if (*x < depth) return;
  switch (static_cast<Mood>(static_cast<int>(p[1]))) {
    case Mood::no_number:
      *force = std::nan("");
      return;
    case Mood::crash:
      *static_cast<volatile double*>(nullptr) = 1.0;
      return;
    case Mood::exit:
      std::exit(7);
    case Mood::sleep:
      sleep(3600);
      return;
    case Mood::abort:
      std::abort();
    case Mood::throws:
      throw 1;
    case Mood::write_behind:
      static_cast<double*>(state)[1] = *x;
      return;
    case Mood::shared_memory:
      remembered += 1.0;
      *force += remembered;
      return;
    case Mood::allocate:
      std::free(kept);
      kept = std::malloc(100);
      return;
    case Mood::write_parameters:
      const_cast<double*>(p)[0] += 1.0;
      return;
    case Mood::slow:
      usleep(1500);
      return;
    case Mood::none:
    case Mood::other_version:
    case Mood::wrong_derivative:
      return;
  }
}

void step_derivatives(const double* p, void* state, const double* x, const double* v, double dt,
                      double* force, double* by) {
  step(p, state, x, v, dt, force);
  by[0] = 2.0 * *x;
  by[1] = 0.0;
}

const kerf_law_parameter_v1 parameters[] = {
    {"stiffness", "N/m", "of a spring", 0.0, 1e6, 100.0, KERF_SEARCHED | KERF_LINEAR},
    {"mood", "1", "what it does below 2 mm", 0.0, 20.0, static_cast<double>(born), 0}};

}  // namespace

extern "C" KERF_LAW_EXPORT const kerf_law_v1* kerf_plugin_law() {
  static const kerf_law_v1 law = [] {
    kerf_law_v1 made{};
    made.abi = born == Mood::other_version ? 2 : KERF_LAW_ABI;
    made.size = sizeof(kerf_law_v1);
    made.name = "moody";
    made.equation = "F = k x";
    made.parameters = parameters;
    made.parameter_count = 2;
    made.state_size = sizeof(double);
    made.state_alignment = alignof(double);
    made.step = step;
    if (born == Mood::wrong_derivative) {
      made.derivatives_state_size = sizeof(double);
      made.derivatives_state_alignment = alignof(double);
      made.step_derivatives = step_derivatives;
    }
    return made;
  }();
  return &law;
}
