#include "cli/verbs.h"

namespace kerf::bench {

void add_fit(CLI::App& app, Context& context) {
  add_verb(app, context, "fit", "", "kerf fit", [] {});
}

}  // namespace kerf::bench
