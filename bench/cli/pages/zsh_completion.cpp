#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pages/completion.h"
#include "pages/quoting.h"
#include "pages/taken.h"

namespace kerf::bench {
namespace {

constexpr std::string_view zsh_frame = R"zsh(
_kerf_devices() {
  local -a uris
  uris=($_kerf_simulated ${(f)"$(_call_program devices $_kerf_program devices 2>/dev/null | sed -n 's/^\([a-z0-9]*:[^ ]*\)  .*/\1/p')"})
  compadd -- $uris
}

_kerf() {
  local _kerf_program=$words[1] verb
  if [[ $words[2] == help ]]; then
    words=($words[1] $words[3,-1])
    ((CURRENT--))
  fi
  # From verb to verb: the first word is then the last of them.
  while ((CURRENT > 2)) && (($+_kerf_verbs[${verb:+$verb }$words[2]])); do
    verb=${verb:+$verb }$words[2]
    shift words
    ((CURRENT--))
  done
  if (($+_kerf_groups[$verb])) && [[ $PREFIX != -* ]]; then
    local name
    local -a names
    for name in ${=_kerf_groups[$verb]}; do
      names+=("$name:${_kerf_verbs[${verb:+$verb }$name]}")
    done
    ((CURRENT == 2)) && _describe 'verb' names
    return
  fi
  case $verb in
)zsh";

/// A text within a specification of _arguments.
std::string zsh_escaped(std::string_view text) { return with_escapes(text, "\\[]:", "\\"); }

std::string zsh_action(const Taken& taken, const CompletionWords& known) {
  using enum Taken::Kind;
  switch (taken.kind) {
    case nothing:
      return " ";
    case words:
      return fmt::format("({})", zsh_escaped(fmt::format("{}", fmt::join(taken.words, " "))));
    case laws:
      return fmt::format("_values -s , law {}", fmt::join(known.laws, " "));
    case devices:
      return "_kerf_devices";
    case folders:
      return "_files -/";
    case files:
      break;
  }
  if (taken.words.empty()) return "_files";
  // One ending alone between parentheses would be taken for a qualifier.
  const bool one = taken.words.size() == 1;
  return fmt::format("_files -g \"*{}{}{}\"", one ? "" : "(", fmt::join(taken.words, "|"), one ? "" : ")");
}

/// The specifications of one option, or of a value without a name, for _arguments.
std::string zsh_specification(const DescribedVerb& verb, const DescribedOption& option,
                              const CompletionWords& known) {
  const std::string value = zsh_action(taken_by(verb, option), known);
  const std::string& last = option.names.back();
  if (!last.starts_with('-'))
    return single_quoted(fmt::format("{}:{}:{}", option.repeated ? "*" : (option.required ? "" : ":"),
                                     zsh_escaped(last), value));
  std::string out;
  for (const std::string& name : option.names) {
    const std::string others =
        option.names.size() > 1 ? fmt::format("({})", fmt::join(option.names, " ")) : "";
    std::string text = (option.repeated ? "*" : others) + name;
    if (option.takes_value) text += name.starts_with("--") ? "=" : "+";
    text += "[" + zsh_escaped(option.description) + "]";
    if (option.takes_value) text += ":" + zsh_escaped(last.substr(2)) + ":" + value;
    out += (out.empty() ? "" : " ") + single_quoted(text);
  }
  return out;
}

std::string zsh_arguments(const DescribedVerb& verb, const CompletionWords& known) {
  std::string out = fmt::format("    {})\n      _arguments -S",
                                single_quoted(fmt::format("{}", fmt::join(verb.words, " "))));
  for (const DescribedOption& option : verb.options)
    out += " \\\n        " + zsh_specification(verb, option, known);
  for (const DescribedOption& value : verb.values)
    out += " \\\n        " + zsh_specification(verb, value, known);
  return out + "\n      ;;\n";
}

}  // namespace

std::string zsh_completion(const std::vector<DescribedVerb>& all, const CompletionWords& words) {
  std::string verbs;
  std::string groups;
  std::string cases;
  for (const DescribedVerb& verb : all) {
    const std::string name = fmt::format("{}", fmt::join(verb.words, " "));
    if (!name.empty())
      verbs += fmt::format("  {} {}\n", single_quoted(name),
                           single_quoted(with_escapes(verb.description, ":\\", "\\")));
    if (!verb.verbs.empty())
      groups += fmt::format("  {} '{}'\n", single_quoted(name), fmt::join(verb.verbs, " "));
    cases += zsh_arguments(verb, words);
  }
  return fmt::format(
      "#compdef kerf\n# Completion of kerf for zsh, made by kerf of what --help prints.\n\n"
      "typeset -ga _kerf_simulated=({})\ntypeset -gA _kerf_verbs=(\n{})\ntypeset -gA "
      "_kerf_groups=(\n{})\n{}{}  esac\n}}\n\n"
      "_kerf \"$@\"\n",
      fmt::join(words.devices, " "), verbs, groups, zsh_frame, cases);
}

}  // namespace kerf::bench
