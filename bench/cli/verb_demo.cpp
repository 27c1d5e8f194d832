#include "cli/verbs.h"

namespace kerf::bench {

void add_demo(CLI::App& app, Context& context) {
  add_verb(app, context, "demo", "", "kerf demo", [] {});
}

}  // namespace kerf::bench
