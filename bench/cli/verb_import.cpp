#include "cli/verbs.h"

namespace kerf::bench {

void add_import(CLI::App& app, Context& context) {
  add_verb(app, context, "import", "", "kerf import", [] {});
}

}  // namespace kerf::bench
