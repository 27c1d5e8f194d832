#include "cli/verbs.h"

namespace kerf::bench {

void add_segment(CLI::App& app, Context& context) {
  add_verb(app, context, "segment", "", "kerf segment", [] {});
}

}  // namespace kerf::bench
