#include "cli/verbs.h"

namespace kerf::bench {

void add_validate(CLI::App& app, Context& context) {
  add_verb(app, context, "validate", "", "kerf validate", [] {});
}

}  // namespace kerf::bench
