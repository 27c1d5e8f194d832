#include <memory>

#include <fmt/core.h>

#include <kerf/schema/session.h>
#include <kerf/schema/validate.h>

#include "plan/file_of_sweep.h"
#include "program/verbs.h"

namespace kerf::bench {
namespace {

void run_validate(const std::string& file, Context& context) {
  refuse_file_of_sweep(file);
  const auto violations = schema::validate(file);
  const std::string schema = schema::schema_of(file);
  context.result["schema"] =
      schema.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(schema);
  context.result["valid"] = violations.empty();
  context.result["violations"] = nlohmann::ordered_json::array();
  for (const auto& [where, found, expected] : violations) {
    context.result["violations"].push_back({{"where", where}, {"found", found}, {"expected", expected}});
    context.say(fmt::format("{}: {}: found {}, expected {}", file, where, found, expected));
  }
  if (violations.empty()) {
    const bool is_sealed = schema == schema::session_schema_name;
    context.say(
        fmt::format("{}: valid{}", file,
                    is_sealed ? "; whether its seals hold is seen by who opens it with its key" : ""));
  } else {
    context.exit = Exit::check_failed;
  }
}

}  // namespace

void add_validate(CLI::App& app, Context& context) {
  auto file = std::make_shared<std::string>();
  Verb verb = add_verb(app, context, "validate", "List every way in which a file departs from the schema",
                       "kerf validate cut.h5", [file, &context] { run_validate(*file, context); });
  verb.add_option("recording", *file, "The recording, session, stored forces or tables of a sweep")
      .required();
  verb.takes_texts(context, *file);
}

}  // namespace kerf::bench
