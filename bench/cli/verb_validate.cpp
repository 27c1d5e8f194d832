#include <memory>

#include <fmt/core.h>

#include <kerf/schema/validate.h>

#include "cli/verbs.h"

namespace kerf::bench {
namespace {

void run_validate(const std::string& file, Context& context) {
  const auto violations = schema::validate(file);
  context.result["valid"] = violations.empty();
  context.result["violations"] = nlohmann::ordered_json::array();
  for (const auto& [where, found, expected] : violations) {
    context.result["violations"].push_back({{"where", where}, {"found", found}, {"expected", expected}});
    say(fmt::format("{}: {}: found {}, expected {}", file, where, found, expected));
  }
  if (violations.empty()) {
    say(fmt::format("{}: valid", file));
  } else {
    context.exit = Exit::check_failed;
  }
}

}  // namespace

void add_validate(CLI::App& app, Context& context) {
  auto file = std::make_shared<std::string>();
  Verb verb = add_verb(app, context, "validate", "List every way in which a file departs from the schema",
                       "kerf validate cut.h5", [file, &context] { run_validate(*file, context); });
  verb.add_option("recording", *file, "The recording").required();
}

}  // namespace kerf::bench
