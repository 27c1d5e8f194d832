#include "cli/verbs.h"

namespace kerf::bench {

void add_devices(CLI::App& app, Context& context) {
  add_verb(app, context, "devices", "", "kerf devices", [] {});
}

}  // namespace kerf::bench
