#include "look/verb_forms.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "pages/taken.h"
#include "program/described.h"
#include "verbs/offered_verbs.h"
#include "verbs/verb_form.h"

namespace kerf::bench {
namespace {

bool holds(const std::vector<std::string_view>& list, std::string_view text) {
  return std::ranges::find(list, text) != list.end();
}

/// "1000" of "FLOAT:POSITIVE=1000".
std::string standard_of(const DescribedOption& option) {
  const std::size_t at = option.value.rfind('=');
  if (at == std::string::npos) return "";
  std::string value = option.value.substr(at + 1);
  return value.substr(0, value.find(' '));
}

std::vector<std::string> strings(const std::vector<std::string_view>& views) {
  return {views.begin(), views.end()};
}

/// What a form asks for; nothing for what it leaves out.
std::optional<ValueKind> kind_of(const OfferedVerb& offered, const DescribedVerb& verb,
                                 const DescribedOption& option, std::vector<std::string>& words) {
  const std::string& name = option.names.back();
  if (is_never_offered(name) || holds(offered.left_out, name)) return std::nullopt;
  for (const OfferedVerb::Output& output : offered.outputs) {
    if (output.option != name) continue;
    words = strings(output.endings);
    return ValueKind::output;
  }
  if (!option.takes_value) return ValueKind::flag;
  if (!option.takes_text) return ValueKind::number;
  if (!option.choices.empty()) {
    words = option.choices;
    return ValueKind::choice;
  }
  if (holds(offered.texts, name)) return ValueKind::text;
  Taken taken = taken_by(verb, option);
  switch (taken.kind) {
    case Taken::Kind::laws:
      return ValueKind::laws;
    case Taken::Kind::devices:
      return ValueKind::device;
    case Taken::Kind::folders:
      return ValueKind::folder;
    case Taken::Kind::files:
      std::erase(taken.words, ".so");  // code
      if (taken.words.empty()) return std::nullopt;
      words = std::move(taken.words);
      return ValueKind::file;
    default:
      return std::nullopt;
  }
}

void add_values(const OfferedVerb& offered, const DescribedVerb& verb,
                const std::vector<DescribedOption>& options, bool positional, VerbForm& form) {
  for (const DescribedOption& option : options) {
    VerbValue value{.name = option.names.back(),
                    .label = option.description,
                    .standard = standard_of(option),
                    .positional = positional,
                    .required = option.required,
                    .repeated = option.repeated};
    const auto kind = kind_of(offered, verb, option, value.words);
    if (!kind) continue;
    value.kind = *kind;
    form.values.push_back(std::move(value));
  }
}

}  // namespace

std::vector<VerbForm> verb_forms(const CLI::App& program) {
  const std::vector<DescribedVerb> described = describe(program);
  std::vector<VerbForm> forms;
  for (const OfferedVerb& offered : offered_verbs()) {
    const auto verb = std::ranges::find_if(described, [&](const DescribedVerb& one) {
      return fmt::format("{}", fmt::join(one.words, " ")) == offered.verb;
    });
    if (verb == described.end()) continue;
    VerbForm form{.verb = std::string(offered.verb),
                  .title = std::string(offered.title),
                  .group = verb->group.empty() ? verb->words.front() : verb->group,
                  .description = verb->description,
                  .more = verb->footer,
                  .values = {},
                  .fixed = strings(offered.fixed),
                  .needs_key = offered.needs_key};
    add_values(offered, *verb, verb->values, true, form);
    add_values(offered, *verb, verb->options, false, form);
    forms.push_back(std::move(form));
  }
  return forms;
}

}  // namespace kerf::bench
