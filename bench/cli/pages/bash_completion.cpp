#include <cstddef>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pages/completion.h"
#include "pages/quoting.h"
#include "pages/taken.h"

namespace kerf::bench {
namespace {

/// After the tables of the verbs; everything else is bash.
constexpr std::string_view bash_frame = R"bash(
# _kerf_files WHICH WORD ENDING...: files that end so and folders, or folders alone.
_kerf_files() {
  local which=$1 word=$2 name ending
  shift 2
  compopt -o filenames 2>/dev/null
  while IFS= read -r name; do
    if [[ -d $name || ($which == files && $# -eq 0) ]]; then
      COMPREPLY+=("$name")
      continue
    fi
    for ending; do
      [[ $which == files && $name == *"$ending" ]] && COMPREPLY+=("$name")
    done
  done < <(compgen -f -- "$word")
}

_kerf_devices() {
  "$1" devices 2>/dev/null | sed -n 's/^\([a-z0-9]*:[^ ]*\)  .*/\1/p'
}

# _kerf_values WORD WHAT WORDS...: what _kerf_takes says that a value is.
_kerf_values() {
  local word=$1 kind=$2 before=
  shift 2
  case $kind in
    files | folders) _kerf_files "$kind" "$word" "$@" ;;
    words) mapfile -t COMPREPLY < <(compgen -W "$*" -- "$word") ;;
    devices) mapfile -t COMPREPLY < <(compgen -W "$_kerf_simulated $(_kerf_devices "${COMP_WORDS[0]}")" -- "$word") ;;
    laws)
      [[ $word == *,* ]] && before=${word%,*},
      mapfile -t COMPREPLY < <(compgen -P "$before" -W "$_kerf_laws" -- "${word#"$before"}")
      ;;
  esac
}

_kerf() {
  local cur prev words cword verb='' at=1 value=0 option='' known
  _get_comp_words_by_ref -n := cur prev words cword || return
  COMPREPLY=()
  [[ ${words[1]} == help ]] && ((at = 2))
  while ((at < cword)) && [[ " $(_kerf_verbs "$verb") " == *" ${words[at]} "* ]]; do
    verb=${verb:+$verb }${words[at]}
    ((at++))
  done
  if [[ -n $(_kerf_verbs "$verb") && $cur != -* ]]; then
    ((at == cword)) && mapfile -t COMPREPLY < <(compgen -W "$(_kerf_verbs "$verb")" -- "$cur")
    return
  fi
  # Which value it would be, of those without a name.
  for ((; at < cword; at++)); do
    if [[ ${words[at]} != -* ]]; then
      ((value++))
    elif [[ ${words[at]} != *=* && -n $(_kerf_takes "$verb" "${words[at]}") ]]; then
      ((at++))
    fi
  done
  if [[ $cur == --*=* ]]; then
    option=${cur%%=*}
    # shellcheck disable=SC2046 # words are wanted
    _kerf_values "${cur#*=}" $(_kerf_takes "$verb" "$option")
    COMPREPLY=("${COMPREPLY[@]/#/$option=}")
  elif [[ $prev == -* && -n $(_kerf_takes "$verb" "$prev") ]]; then
    # shellcheck disable=SC2046
    _kerf_values "$cur" $(_kerf_takes "$verb" "$prev")
  elif [[ $cur == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(_kerf_options "$verb")" -- "$cur")
  else
    # shellcheck disable=SC2046
    _kerf_values "$cur" $(_kerf_takes "$verb" "$((value + 1))" || _kerf_takes "$verb" more)
  fi
  # Readline takes what stands after the last of these for the word.
  known=${cur%"${cur##*[:=]}"}
  COMPREPLY=("${COMPREPLY[@]#"$known"}")
}
complete -F _kerf kerf
)bash";

std::string in_words(const Taken& taken) {
  using enum Taken::Kind;
  switch (taken.kind) {
    case nothing:
      return "nothing";
    case words:
      return fmt::format("words {}", fmt::join(taken.words, " "));
    case laws:
      return "laws";
    case devices:
      return "devices";
    case folders:
      return "folders";
    case files:
      return fmt::format("files {}", fmt::join(taken.words, " "));
  }
  return "";
}

/// One line of _kerf_takes.
std::string taken_line(const DescribedVerb& verb, const std::string& what, const DescribedOption& option) {
  return fmt::format("    '{} {}') echo {} ;;\n", fmt::join(verb.words, " "), what,
                     single_quoted(in_words(taken_by(verb, option))));
}

std::string all_taken_by(const DescribedVerb& verb) {
  std::string out;
  for (const DescribedOption& option : verb.options) {
    if (!option.takes_value) continue;
    for (const std::string& name : option.names) out += taken_line(verb, name, option);
  }
  for (std::size_t i = 0; i < verb.values.size(); ++i) {
    const DescribedOption& value = verb.values[i];
    out += taken_line(verb, value.repeated ? "more" : std::to_string(i + 1), value);
  }
  return out;
}

}  // namespace

std::string bash_completion(const std::vector<DescribedVerb>& all, const CompletionWords& words) {
  std::string verbs;
  std::string options;
  std::string taken;
  for (const DescribedVerb& verb : all) {
    const std::string name = fmt::format("{}", fmt::join(verb.words, " "));
    if (!verb.verbs.empty())
      verbs += fmt::format("    '{}') echo '{}{}' ;;\n", name, verb.words.empty() ? "help " : "",
                           fmt::join(verb.verbs, " "));
    options += fmt::format("    '{}') echo '", name);
    for (const DescribedOption& option : verb.options)
      options += fmt::format("{} ", fmt::join(option.names, " "));
    options += "' ;;\n";
    taken += all_taken_by(verb);
  }
  return fmt::format(
      "# Completion of kerf for bash, made by kerf of what --help prints; bash-completion loads it.\n"
      "_kerf_laws='{}'\n_kerf_simulated='{}'\n\n"
      "_kerf_verbs() {{\n  case $1 in\n{}  esac\n}}\n\n"
      "_kerf_options() {{\n  case $1 in\n{}  esac\n}}\n\n"
      "# _kerf_takes VERB WHAT: what an option takes, or the value of that number, or any further value.\n"
      "_kerf_takes() {{\n  case \"$1 $2\" in\n{}    *) return 1 ;;\n  esac\n}}\n{}",
      fmt::join(words.laws, " "), fmt::join(words.devices, " "), verbs, options, taken, bash_frame);
}

}  // namespace kerf::bench
