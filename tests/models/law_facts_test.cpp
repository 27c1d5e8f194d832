#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/models/law.h>
#include <kerf/models/registry.h>

#include "support/example_laws.h"

namespace kerf::models {
namespace {

/// A scalar law with all that a registered one has, but its facts.
struct WithoutFacts {
  static constexpr std::string_view name = "bare";
  static constexpr std::string_view equation = "F = 0";
  struct State {};
  static std::vector<OptionInfo> options() { return {}; }
  static std::vector<ParameterInfo> parameters(const Options&) { return {}; }
};
struct NeverSought : WithoutFacts {
  static constexpr LawFacts facts{.not_a_candidate = "nobody would take it"};
};
struct NeitherChosenNorSaidWhy : WithoutFacts {
  static constexpr LawFacts facts{.search = Search::descent};
};
struct ChosenAndSaidWhyNot : WithoutFacts {
  static constexpr LawFacts facts{
      .search = Search::descent, .variants = {{}}, .not_a_candidate = "nobody would take it"};
};
struct ScannedOverNothing : WithoutFacts {
  static constexpr LawFacts facts{
      .search = Search::descent, .scan = {.over = Scan::values, .parameter = "k"}, .variants = {{}}};
};
struct Complete : WithoutFacts {
  static constexpr LawFacts facts{.search = Search::descent, .variants = {{}}};
};
static_assert(!RegistrableLaw<WithoutFacts>);
static_assert(!RegistrableLaw<NeverSought>);
static_assert(!RegistrableLaw<NeitherChosenNorSaidWhy>);
static_assert(!RegistrableLaw<ChosenAndSaidWhyNot>);
static_assert(!RegistrableLaw<ScannedOverNothing>);
static_assert(RegistrableLaw<Complete>);

std::vector<std::string_view> names_of_all_laws() {
  std::vector<std::string_view> names;
  for (const LawInfo& law : registry()) names.push_back(law.name);
  return names;
}

class FactsOf : public testing::TestWithParam<std::string_view> {
 protected:
  [[nodiscard]] const OptionValue* standard_of(std::string_view option) const {
    const auto found = std::ranges::find(options_, option, &OptionInfo::name);
    return found != options_.end() ? &found->standard : nullptr;
  }
  [[nodiscard]] bool has_parameter(std::string_view begins) const {
    return std::ranges::any_of(Law::parameters(GetParam()),
                               [&](const ParameterInfo& info) { return info.name.starts_with(begins); });
  }

  const LawFacts& facts_ = law_facts(GetParam());

 private:
  const std::vector<OptionInfo> options_ = Law::options(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Registry, FactsOf, testing::ValuesIn(names_of_all_laws()),
                         [](const auto& name) { return std::string(name.param); });

TEST_P(FactsOf, NameParametersThatTheLawHas) {
  for (const std::string_view name : {facts_.scan.parameter, facts_.scan.spring})
    EXPECT_TRUE(name.empty() || has_parameter(name)) << name;
  for (const std::string_view name : facts_.held) EXPECT_TRUE(has_parameter(name)) << name;
}

TEST_P(FactsOf, NameOptionsThatTheLawHas) {
  for (const DataOption& option : facts_.from_data) {
    const OptionValue* const standard = standard_of(option.name);
    ASSERT_NE(standard, nullptr) << option.name;
    EXPECT_EQ(std::holds_alternative<bool>(*standard), option.from == From::cycles) << option.name;
  }
  for (const std::string_view name : {facts_.scan.option, facts_.size.option}) {
    const OptionValue* const standard = standard_of(name);
    EXPECT_TRUE(name.empty() || (standard != nullptr && std::holds_alternative<double>(*standard))) << name;
  }
  EXPECT_EQ(standard_of("precision") != nullptr, facts_.in_float);
}

TEST_P(FactsOf, CallFinerWhatTheLawHasOptionsFor) {
  std::vector<const char*> needed;
  switch (facts_.fineness) {
    case Fineness::nothing:
      break;
    case Fineness::integrators:
      needed = {"integrator"};
      break;
    case Fineness::strips:
      needed = {"fidelity", "strips"};
      break;
    case Fineness::nodes:
      needed = {"columns", "rows", "spacing", "substeps"};
      break;
    case Fineness::projections:
      needed = {"projection"};
      break;
    case Fineness::segments:
    case Fineness::points:
    case Fineness::memberships:
      EXPECT_FALSE(facts_.size.option.empty());
      break;
  }
  for (const char* const name : needed) EXPECT_NE(standard_of(name), nullptr) << name;
}

TEST_P(FactsOf, GiveSizesThatTheLawTakes) {
  if (facts_.size.option.empty()) return;
  std::size_t before = 0;
  for (const std::size_t size : {facts_.size.first, facts_.size.last}) {
    const auto parameters =
        Law::parameters(GetParam(), {{std::string(facts_.size.option), static_cast<double>(size)}});
    EXPECT_GT(parameters.size(), before) << size;
    before = parameters.size();
  }
}

TEST_P(FactsOf, SayHowManyParametersADescentSearches) {
  if (facts_.search != Search::descent) return;
  Options largest = test::example(GetParam()).options();
  if (!facts_.size.option.empty())
    largest[std::string(facts_.size.option)] = static_cast<double>(facts_.size.last);
  EXPECT_LE(Law::parameters(GetParam(), largest).size(), static_cast<std::size_t>(facts_.searched_at_once));
}

TEST_P(FactsOf, ChooseVariantsByOptionsThatTheLawHas) {
  std::set<std::string_view> suffixes;
  for (const Variant& variant : facts_.variants) {
    EXPECT_TRUE(suffixes.insert(variant.suffix).second) << "two variants of one name";
    for (const std::string_view option : variant.options)
      EXPECT_NE(standard_of(option.substr(0, option.find('='))), nullptr) << option;
  }
}

TEST(Facts, OfTheUsualLawsGiveEachAPlaceOfItsOwn) {
  std::vector<int> places;
  for (const LawInfo& law : registry()) {
    if (const int place = law_facts(law.name).usual; place > 0) places.push_back(place);
  }
  std::ranges::sort(places);
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_EQ(places[i], static_cast<int>(i) + 1);
}

}  // namespace
}  // namespace kerf::models
