#include "choose/effects.h"

#include <array>

#include <fmt/core.h>

#include "choose/candidate_search.h"

namespace kerf::bench {
namespace {

constexpr double as_good = 0.99;

struct Best {
  const Candidate* least_error = nullptr;
  const Candidate* simplest_within = nullptr;

  void consider(const Candidate& candidate) {
    if (!candidate.file || !candidate.converged) return;
    // Of laws that are as good as each other the simplest, which comes first.
    if (least_error == nullptr || candidate.error_n < as_good * least_error->error_n)
      least_error = &candidate;
    if (simplest_within == nullptr && candidate.within_jnd) simplest_within = &candidate;
  }
};

std::string in_jnds(const Candidate& candidate) {
  return fmt::format("{:.2g} JND ({})", candidate.error_jnd, candidate.law.name);
}

void decide(EffectVerdict& verdict, const Best& without, const Best& with, const Candidate* taken,
            double jnd_n) {
  const Candidate& best_without = *without.least_error;
  const Candidate& best_with = *with.least_error;
  const std::string figures = fmt::format("{} without, {} with", in_jnds(best_without), in_jnds(best_with));
  if (best_without.within_jnd) {
    const bool has = taken != nullptr && taken->law.effects.contains(verdict.effect);
    verdict.matter = has ? Matter::replaceable : Matter::does_not;
    verdict.why =
        has ? fmt::format("{}; {} does without, with {} parameters", figures,
                          without.simplest_within->law.name, without.simplest_within->law.parameters)
            : figures;
    return;
  }
  const double mended_n = fitting::left_out(best_without.error_n, best_with.error_n);
  if (best_with.within_jnd || mended_n > jnd_n) {
    verdict.matter = Matter::matters;
    verdict.why = figures;
  } else {
    verdict.matter = Matter::not_known;
    verdict.why = fmt::format("{}: taking it in mends {:.2g} JND", figures, mended_n / jnd_n);
  }
}

}  // namespace

std::string_view name_of(Matter matter) noexcept {
  constexpr std::array<std::string_view, 4> names{"matters", "replaceable", "does not matter", "not known"};
  return names[static_cast<std::size_t>(matter)];
}

std::vector<EffectVerdict> judge_effects(std::span<const Candidate> candidates,
                                         std::optional<std::size_t> taken, double jnd_n) {
  std::vector<EffectVerdict> all;
  for (const Effect effect :
       {Effect::loop, Effect::relaxation, Effect::cutting, Effect::rate, Effect::stiffening}) {
    Best with;
    Best without;
    for (const Candidate& candidate : candidates)
      (candidate.law.effects.contains(effect) ? with : without).consider(candidate);
    if (with.least_error == nullptr || without.least_error == nullptr) continue;
    EffectVerdict verdict{.effect = effect,
                          .without_n = without.least_error->error_n,
                          .with_n = with.least_error->error_n,
                          .without_law = without.least_error->law.name,
                          .with_law = with.least_error->law.name,
                          .why = {}};
    decide(verdict, without, with, taken ? &candidates[*taken] : nullptr, jnd_n);
    all.push_back(std::move(verdict));
  }
  return all;
}

}  // namespace kerf::bench
