#pragma once

#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace kerf::bench {

struct VerbForm;

/// The verbs that a page may run (offered_verbs()) as forms, made of what their --help says: a verb gets its
/// form by a line in that table.
[[nodiscard]] std::vector<VerbForm> verb_forms(const CLI::App& program);

}  // namespace kerf::bench
