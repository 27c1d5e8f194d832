#include "choose/candidates.h"

#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/core.h>

#include <kerf/models/foreign.h>

#include "fits/law_options.h"

namespace kerf::bench {
namespace {

/// How many parameters of a law a fit searches: neither those held nor the outer knots, which are the ends of
/// the data.
std::size_t searched(const CandidateLaw& law) {
  const models::LawFacts& facts = models::law_facts(law.model);
  const auto all = models::Law::parameters(law.model, options_of_law(law.model, law.law_options));
  if (const models::ForeignLaw* const foreign = models::foreign_law(law.model)) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < all.size(); ++i) count += foreign->is_searched(i) ? 1 : 0;
    return count;
  }
  const auto free = std::ranges::count_if(all, [&](const models::ParameterInfo& info) {
    return std::ranges::none_of(facts.held,
                                [&](std::string_view name) { return info.name.starts_with(name); });
  });
  return static_cast<std::size_t>(free) - (facts.search == models::Search::segments ? 2 : 0);
}

/// `size`: 0 where the variant has one alone.
CandidateLaw candidate(std::string_view model, const models::Variant& variant, std::size_t size) {
  CandidateLaw law{.name = std::string(model),
                   .model = std::string(model),
                   .law_options = {variant.options.begin(), variant.options.end()},
                   .effects = {variant.effects.begin(), variant.effects.end()}};
  if (size > 0) {
    law.name += fmt::format("-{}", size);
    law.law_options.insert(law.law_options.begin(),
                           fmt::format("{}={}", models::law_facts(model).size.option, size));
  }
  if (size > 1) law.effects.insert(variant.from_size_2.begin(), variant.from_size_2.end());
  law.name += variant.suffix;
  law.parameters = searched(law);
  return law;
}

std::vector<CandidateLaw> candidates_of(std::string_view model, bool has_cycles,
                                        const CandidateOptions& options) {
  const models::LawFacts& facts = models::law_facts(model);
  const std::size_t largest =
      facts.search == models::Search::segments ? options.max_segments : options.max_arms;
  std::vector<CandidateLaw> all;
  for (const models::Variant& variant : facts.variants) {
    if (variant.needs_cycles && !has_cycles) continue;
    if (variant.sizes_from == 0) all.push_back(candidate(model, variant, 0));
    for (std::size_t size = variant.sizes_from; size > 0 && size <= largest; ++size)
      all.push_back(candidate(model, variant, size));
  }
  return all;
}

}  // namespace

std::string_view name_of(Effect effect) noexcept {
  constexpr std::array<std::string_view, 6> names{"rotation", "loop", "relaxation",
                                                  "cutting",  "rate", "stiffening"};
  return names[static_cast<std::size_t>(effect)];
}

std::vector<CandidateLaw> candidates_for(const schema::Axis& axis, bool has_cycles,
                                         const CandidateOptions& options) {
  std::vector<models::LawInfo> laws = models::registry();
  std::erase_if(
      laws, [&](const models::LawInfo& law) { return !units_fit(law, axis.position_unit, axis.force_unit); });
  std::ranges::stable_sort(laws, {},
                           [](const models::LawInfo& law) { return models::law_facts(law.name).rank; });
  std::vector<CandidateLaw> all;
  for (const models::LawInfo& law : laws)
    std::ranges::move(candidates_of(law.name, has_cycles, options), std::back_inserter(all));
  std::ranges::stable_sort(all, {}, &CandidateLaw::parameters);
  return all;
}

}  // namespace kerf::bench
