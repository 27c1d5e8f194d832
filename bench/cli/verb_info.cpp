#include "cli/verbs.h"

namespace kerf::bench {

void add_info(CLI::App& app, Context& context) {
  add_verb(app, context, "info", "", "kerf info", [] {});
}

}  // namespace kerf::bench
