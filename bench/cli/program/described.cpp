#include "program/described.h"

#include <cstddef>

#include <CLI/CLI.hpp>

namespace kerf::bench {
namespace {

std::string without_blanks_around(std::string text) { return CLI::detail::trim(text); }

/// {"contact", "all"} of "TEXT:{contact,all}".
std::vector<std::string> choices_of(const std::string& type) {
  const std::size_t begin = type.find(":{");
  if (begin == std::string::npos || type.back() != '}') return {};
  return CLI::detail::split(type.substr(begin + 2, type.size() - begin - 3), ',');
}

DescribedOption describe_option(const CLI::Option& option) {
  DescribedOption described;
  for (const std::string& name : option.get_snames()) described.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) described.names.push_back("--" + name);
  if (described.names.empty()) described.names.push_back(option.get_name(true));
  described.value = without_blanks_around(CLI::Formatter().make_option_opts(&option));
  described.description = option.get_description();
  described.choices = choices_of(option.get_type_name());
  described.takes_value = option.get_items_expected_max() != 0;
  described.takes_text = described.takes_value && option.get_type_name().starts_with("TEXT");
  described.repeated = option.get_expected_max() == CLI::detail::expected_max_vector_size;
  described.required = option.get_required();
  return described;
}

void describe_below(const CLI::App& app, const DescribedVerb& above, std::vector<DescribedVerb>& all) {
  DescribedVerb verb{.words = above.words,
                     .group = app.get_group(),
                     .description = app.get_description(),
                     .footer = app.get_footer(),
                     .values = {},
                     .options = {},
                     .verbs = {}};
  if (app.get_parent() != nullptr) verb.words.push_back(app.get_name());
  if (!above.words.empty()) verb.group.clear();
  for (const CLI::Option* const option : app.get_options())
    (option->nonpositional() ? verb.options : verb.values).push_back(describe_option(*option));
  const auto verbs = app.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); });
  for (const CLI::App* const one : verbs) verb.verbs.push_back(one->get_name());
  all.push_back(verb);
  for (const CLI::App* const one : verbs) describe_below(*one, verb, all);
}

}  // namespace

std::vector<DescribedVerb> describe(const CLI::App& program) {
  std::vector<DescribedVerb> all;
  describe_below(program, {}, all);
  return all;
}

}  // namespace kerf::bench
