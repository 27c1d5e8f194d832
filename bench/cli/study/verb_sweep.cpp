#include "study/verb_sweep.h"

#include "program/verbs.h"

namespace kerf::bench {

void add_sweep(CLI::App& app, Context& context) {
  CLI::App& sweep = add_verb_of_verbs(
      app, "sweep", "Compute a grid of fits, choices or walls, here or as shards on a cluster",
      "Example:\n"
      "  kerf sweep plan noise.toml\n"
      "  kerf sweep run noise.plan.json -j 2\n"
      "  kerf sweep merge noise.plan.json\n\n"
      "docs/sweeps.md says what a sweep varies, what its shards promise, and what a cluster needs.");
  add_sweep_plan(sweep, context);
  add_sweep_run(sweep, context);
  add_sweep_status(sweep, context);
  add_sweep_merge(sweep, context);
  add_sweep_submit(sweep, context);
  add_sweep_worker(sweep, context);
}

}  // namespace kerf::bench
