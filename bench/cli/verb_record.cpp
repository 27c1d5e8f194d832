#include "cli/verbs.h"

namespace kerf::bench {

void add_record(CLI::App& app, Context& context) {
  add_verb(app, context, "record", "", "kerf record", [] {});
}

}  // namespace kerf::bench
