#include "chart/fit_plan.h"

#include <algorithm>
#include <iterator>

#include <fmt/core.h>

#include <kerf/fitting/fit.h>
#include <kerf/models/law.h>

namespace kerf::bench {
namespace {

std::vector<FitPlan> sizes_of(const std::string& model, const models::SizeFacts& size) {
  std::vector<FitPlan> plans;
  for (std::size_t count = size.first; count <= size.last; count = size.doubles ? 2 * count : count + 1) {
    const std::size_t told = size.squared ? count * count : count;
    plans.push_back({model,
                     fmt::format("{} {}{}", told, size.unit, told == 1 ? "" : "s"),
                     {{std::string(size.option), static_cast<double>(count)}}});
  }
  return plans;
}

std::vector<FitPlan> plans_of(const std::string& model) {
  const models::LawFacts& facts = models::law_facts(model);
  if (!facts.size.option.empty()) return sizes_of(model, facts.size);
  if (facts.fineness != models::Fineness::integrators) return {{model, "as fitted", {}}};
  return {{model, "exact", {}},
          {model, "semi-implicit", {{"integrator", std::string("semi_implicit")}}},
          {model, "Euler", {{"integrator", std::string("euler")}}}};
}

}  // namespace

bool has_float(std::string_view model) { return models::law_facts(model).in_float; }

std::vector<FitPlan> fit_plans(const std::vector<std::string>& models) {
  std::vector<std::string> wanted;
  const auto want = [&](std::string_view model) {
    if (std::find(wanted.begin(), wanted.end(), model) == wanted.end()) wanted.emplace_back(model);
  };
  for (const std::string& model : models) {
    if (model == "all") {
      for (const std::string_view one : fitting::fitted_laws()) want(one);
    } else {
      fitting::check_model(model);
      want(model);
    }
  }
  for (const std::string_view model : fitting::fitted_laws()) {
    if (models.empty() && models::law_facts(model).charted) want(model);
  }
  std::vector<FitPlan> plans;
  for (const std::string& model : wanted) std::ranges::move(plans_of(model), std::back_inserter(plans));
  return plans;
}

}  // namespace kerf::bench
