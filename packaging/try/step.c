/* Steps a law file for a tenth of a second, at 1 kHz, 10 mm/s into the tissue, and prints the last force. */
#include <kerf/kerf.h>
#include <stdio.h>

int main(int argc, char** argv) {
  char error[256] = "";
  kerf_law* law = NULL;
  kerf_state* state = NULL;
  double force = 0.0;
  uint32_t flags = 0;
  int tick;
  if (argc != 2) return 2;
  if (kerf_law_open(argv[1], &law, error, sizeof error) != KERF_OK ||
      kerf_state_create(law, &state, error, sizeof error) != KERF_OK) {
    fprintf(stderr, "%s\n", error);
    return 2;
  }
  for (tick = 0; tick < 100; ++tick) flags |= kerf_step_depth(state, 1e-5 * tick, 0.01, 1e-3, &force);
  printf("%s: %g N after 0.1 s, flags %u\n", kerf_law_model(law), force, (unsigned)flags);
  kerf_state_destroy(state);
  kerf_law_close(law);
  return flags == 0 && force > 0.0 ? 0 : 1;
}
