#include "cli/verbs.h"

namespace kerf::bench {

void add_report(CLI::App& app, Context& context) {
  add_verb(app, context, "report", "", "kerf report", [] {});
}

}  // namespace kerf::bench
