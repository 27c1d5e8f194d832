#include "fits/law_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <stdexcept>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

struct Assignment {
  std::string name;
  std::string value;
};

Assignment assignment_of(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size()) {
    throw std::invalid_argument(fmt::format(
        "--option: '{}' is not NAME=VALUE, for example arms=2; 'kerf laws NAME' lists them", text));
  }
  return {.name = text.substr(0, equals), .value = text.substr(equals + 1)};
}

models::OptionValue value_like(const models::OptionValue& standard, const Assignment& given) {
  const auto refuse = [&](const char* expected) {
    throw std::invalid_argument(
        fmt::format("--option: {} is '{}', expected {}", given.name, given.value, expected));
  };
  if (std::holds_alternative<bool>(standard)) {
    if (given.value != "true" && given.value != "false") refuse("true or false");
    return given.value == "true";
  }
  if (std::holds_alternative<std::string>(standard)) return given.value;
  double number = 0.0;
  const char* const end = given.value.data() + given.value.size();
  const auto [rest, error] = std::from_chars(given.value.data(), end, number);
  if (error != std::errc() || rest != end || !std::isfinite(number)) refuse("a number");
  return number;
}

}  // namespace

bool units_fit(const models::LawInfo& law, std::string_view position_unit, std::string_view force_unit) {
  return law.position_unit.empty() || (law.position_unit == position_unit && law.force_unit == force_unit);
}

models::Options options_of_law(std::string_view model, const std::vector<std::string>& given) {
  models::Options options;
  const auto known = models::Law::options(model);
  for (const std::string& text : given) {
    const Assignment assignment = assignment_of(text);
    const auto option = std::find_if(known.begin(), known.end(),
                                     [&](const auto& one) { return one.name == assignment.name; });
    if (option != known.end()) options[assignment.name] = value_like(option->standard, assignment);
  }
  return options;
}

void check_law_options(const std::vector<std::string>& models, const std::vector<std::string>& given) {
  std::set<std::string> names;
  for (const std::string& text : given) {
    const std::string name = assignment_of(text).name;
    if (!names.insert(name).second)
      throw std::invalid_argument(fmt::format("the option '{}' is given twice; leave one out", name));
    std::set<std::string> all;
    bool known = false;
    for (const std::string& model : models) {
      known = options_of_law(model, {text}).contains(name) || known;
      for (const models::OptionInfo& option : models::Law::options(model)) all.insert(option.name);
    }
    if (known) continue;
    std::string list;
    for (const std::string& one : all) list += (list.empty() ? "" : ", ") + one;
    throw std::invalid_argument(
        fmt::format("none of the laws has an option '{}'; theirs are {}", name, list));
  }
}

}  // namespace kerf::bench
