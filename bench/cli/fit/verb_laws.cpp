#include <algorithm>
#include <memory>
#include <string>

#include <fmt/core.h>

#include <kerf/fitting/fit.h>
#include <kerf/models/law.h>

#include "laws/plugin_laws.h"
#include "program/verbs.h"

namespace kerf::bench {
namespace {

struct LawsVerbArguments {
  std::string law;
};

std::string as_text(const models::OptionValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{:g}", *number);
  return "\"" + std::get<std::string>(value) + "\"";
}

nlohmann::ordered_json to_json(const models::OptionValue& value) {
  return std::visit([](const auto& one) { return nlohmann::ordered_json(one); }, value);
}

bool can_be_fitted(std::string_view law) {
  const auto laws = fitting::fitted_laws();
  return std::find(laws.begin(), laws.end(), law) != laws.end();
}

nlohmann::ordered_json summary(const models::LawInfo& law) {
  nlohmann::ordered_json axes = nlohmann::ordered_json::array();
  for (const models::LawAxis& axis : models::Law::axes(law.name)) axes.push_back(axis.name);
  return {{"name", law.name}, {"equation", law.equation}, {"axes", axes}, {"fit", can_be_fitted(law.name)}};
}

void list_laws(Context& context) {
  context.result = {{"laws", nlohmann::ordered_json::array()}};
  for (const models::LawInfo& law : models::registry()) {
    const auto entry = summary(law);
    context.result["laws"].push_back(entry);
    std::string axes;
    for (const auto& axis : entry["axes"]) axes += (axes.empty() ? "" : ", ") + axis.get<std::string>();
    context.say(fmt::format("{:18} {:22} {}", law.name, axes.empty() ? "any axis" : axes, law.equation));
  }
  context.say("kerf laws NAME says more of one");
}

void describe_law(const std::string& name, Context& context) {
  const auto parameters = models::Law::parameters(name);
  for (const models::LawInfo& law : models::registry()) {
    if (law.name == name) context.result = summary(law);
  }
  context.say(fmt::format("{}: {}", name, context.result["equation"].get<std::string>()));
  context.say("parameters (axis in m, force in N, options at their standard):");
  for (const models::ParameterInfo& info : parameters) {
    const std::string unit = models::unit_of(info.quantity, "N", "m");
    context.say(
        fmt::format("  {:22} {:10} {:g} to {:g}: {}", info.name, unit, info.lower, info.upper, info.meaning));
    context.result["parameters"].push_back({{"name", info.name},
                                            {"unit", unit},
                                            {"lower", info.lower},
                                            {"upper", info.upper},
                                            {"meaning", info.meaning}});
  }
  context.say("options, under [fidelity] in a law file:");
  for (const models::OptionInfo& option : models::Law::options(name)) {
    context.say(fmt::format("  {:22} {:10} {}", option.name, as_text(option.standard), option.meaning));
    context.result["options"].push_back(
        {{"name", option.name}, {"standard", to_json(option.standard)}, {"meaning", option.meaning}});
  }
}

}  // namespace

void add_laws(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<LawsVerbArguments>();
  Verb verb = add_verb(app, context, "laws", "List the force laws, or the parameters and options of one",
                       "kerf laws blade", [arguments, &context] {
                         if (is_plugin(arguments->law))
                           arguments->law = load_plugin(arguments->law).info().name;
                         if (arguments->law.empty()) {
                           list_laws(context);
                         } else {
                           describe_law(arguments->law, context);
                         }
                       });
  verb.takes_laws(context);
  verb.add_option("NAME", arguments->law, "Law");
}

}  // namespace kerf::bench
