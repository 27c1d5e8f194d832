#include "chart/fit_plan.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include <kerf/fitting/fit.h>
#include <kerf/models/law.h>

namespace kerf::bench {
namespace {

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

void add(const std::string& model, std::vector<FitPlan>& to) {
  const auto sized = [&](std::size_t count, const char* option, const char* what) {
    to.push_back({model, counted(count, what), {{option, static_cast<double>(count)}}});
  };
  if (model == "kelvin") {
    to.push_back({model, "exact", {}});
    to.push_back({model, "semi-implicit", {{"integrator", std::string("semi_implicit")}}});
    to.push_back({model, "Euler", {{"integrator", std::string("euler")}}});
  } else if (model == "maxwell") {
    for (std::size_t arms = 1; arms <= 4; ++arms) sized(arms, "arms", "arm");
  } else if (model == "piecewise") {
    for (std::size_t segments = 1; segments <= 12; ++segments) sized(segments, "segments", "segment");
  } else if (model == "recording") {
    for (std::size_t points = 2; points <= 256; points *= 2) sized(points, "points", "point");
  } else if (model.starts_with("fuzzy_")) {
    for (std::size_t memberships = 2; memberships <= 5; ++memberships) {
      to.push_back({model,
                    counted(memberships * memberships, "rule"),
                    {{"memberships", static_cast<double>(memberships)}}});
    }
  } else {
    to.push_back({model, "as fitted", {}});
  }
}

}  // namespace

bool has_float(std::string_view model) {
  const auto options = models::Law::options(model);
  return std::any_of(options.begin(), options.end(),
                     [](const auto& option) { return option.name == "precision"; });
}

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
  if (models.empty()) {
    for (const auto* model : {"kelvin", "maxwell", "springpot", "exponential", "hunt_crossley", "friction",
                              "piecewise", "recording"}) {
      want(model);
    }
  }
  std::vector<FitPlan> plans;
  for (const std::string& model : wanted) add(model, plans);
  return plans;
}

}  // namespace kerf::bench
