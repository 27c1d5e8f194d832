#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "verbs/sweep_verb.h"

namespace kerf::bench {

SweepVerbs sweep_verbs() {
  static constexpr std::array<const SweepVerb*, 6> all{&sweep_of_fits,     &sweep_of_stability,
                                                       &sweep_of_identify, &sweep_of_checks,
                                                       &sweep_of_choices,  &sweep_of_regressions};
  return all;
}

const SweepVerb& sweep_verb_called(std::string_view name, SweepVerbs verbs) {
  std::string known;
  for (const SweepVerb* const verb : verbs) {
    if (verb->name == name) return *verb;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", verb->name);
  }
  throw std::invalid_argument(fmt::format("a sweep runs no verb '{}'; it runs {}", name, known));
}

}  // namespace kerf::bench
