#include "cli/verbs.h"

namespace kerf::bench {

void add_check(CLI::App& app, Context& context) {
  add_verb(app, context, "check", "", "kerf check", [] {});
}

}  // namespace kerf::bench
