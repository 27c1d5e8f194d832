#include "chart/fidelities.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include <kerf/models/scissors_mesh.h>

namespace kerf::bench {
namespace {

constexpr int max_lattice_nodes = 40'000;

std::string rate_label(double rate_hz) { return fmt::format("{:g} Hz", rate_hz); }

double option_number(const LawFile& law, std::string_view name) {
  const auto given = law.law.options().find(name);
  if (given != law.law.options().end()) return std::get<double>(given->second);
  for (const models::OptionInfo& option : models::Law::options(law.law.model())) {
    if (option.name == name) return std::get<double>(option.standard);
  }
  throw std::invalid_argument(fmt::format("law '{}' has no option '{}'", law.law.model(), name));
}

void strips(const LawFile& law, double rate_hz, Fidelities& to) {
  for (const char* kind : {"paper", "strips"}) {
    for (const double count : {1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0}) {
      to.all.push_back({fmt::format("{} {:g}", kind, count),
                        with_options(law, {{"fidelity", std::string(kind)}, {"strips", count}}), rate_hz});
    }
  }
  const LawFile exact = with_options(law, {{"fidelity", std::string("exact")}});
  to.all.push_back({"exact", exact, rate_hz});
  to.reference = {"exact", exact, rate_hz};
}

void integrators(const LawFile& law, double rate_hz, Fidelities& to) {
  const LawFile exact = with_options(law, {{"integrator", std::string("exact")}});
  to.all.push_back({"exact", exact, rate_hz});
  std::vector<double> rates{250.0, 500.0, 1000.0, 4000.0};
  if (std::find(rates.begin(), rates.end(), rate_hz) == rates.end()) rates.push_back(rate_hz);
  for (const auto& [name, label] :
       {std::pair{"semi_implicit", "semi-implicit"}, std::pair{"euler", "Euler"}}) {
    const LawFile other = with_options(law, {{"integrator", std::string(name)}});
    for (const double rate : rates) {
      to.all.push_back(
          {rate == rate_hz ? label : fmt::format("{}, {}", label, rate_label(rate)), other, rate});
    }
  }
  to.reference = {"exact", exact, reference_rate_factor * rate_hz};
}

/// The same slab with `factor` times the nodes a side; nothing if that is too small or too large.
std::optional<LawFile> relaid(const LawFile& law, double factor) {
  const double spacing = option_number(law, "spacing") / factor;
  const auto nodes = [&](const char* side) {
    return std::round((option_number(law, side) - 1.0) * factor) + 1.0;
  };
  if (nodes("columns") < 4.0 || nodes("rows") < 4.0) return std::nullopt;
  if (nodes("columns") * nodes("rows") > max_lattice_nodes) return std::nullopt;
  models::Options options = law.law.options();
  options["columns"] = nodes("columns");
  options["rows"] = nodes("rows");
  options["spacing"] = spacing;
  options.erase("substeps");
  std::vector<double> values = law.law.values();
  const auto parameters = law.law.parameters();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string& name = parameters[i].name;
    if (name == "node_mass" || name == "node_damping" || name == "cutting_mass") values[i] /= factor * factor;
    if (name == "break_deflection") values[i] /= factor;
  }
  return with_law(law, models::Law::make(law.law.model(), values, options));
}

void lattice(const LawFile& law, double rate_hz, Fidelities& to) {
  const auto label = [](const LawFile& file) {
    return fmt::format("{:g} x {:g} nodes", option_number(file, "columns"), option_number(file, "rows"));
  };
  to.reference = {label(law), law, rate_hz};
  double finest = 1.0;
  for (const double factor : {0.5, 1.0, 2.0, 3.0, 4.0}) {
    const auto file = relaid(law, factor);
    if (!file) {
      to.notes.push_back(fmt::format("{} with {:g} times the nodes a side has too {} nodes and is left out",
                                     law.law.model(), factor, factor < 1.0 ? "few" : "many"));
      continue;
    }
    if (factor >= 1.0) to.refinements.push_back({factor, {label(*file), *file, rate_hz}});
    if (factor > finest) {
      to.reference = {label(*file), *file, rate_hz};
      finest = factor;
    }
    if (factor < 3.0) to.all.push_back({label(*file), *file, rate_hz});
  }
  const int needed =
      models::ScissorsMesh::make(law.law.values(), with_options(law, {{"substeps", 0.0}}).law.options())
          .substeps(1.0 / rate_hz);
  std::vector<int> tried;
  for (const int divisor : {2, 4}) {
    const int substeps = std::max(1, needed / divisor);
    if (substeps == needed || std::find(tried.begin(), tried.end(), substeps) != tried.end()) continue;
    tried.push_back(substeps);
    to.all.push_back({fmt::format("{}, {} of {} sub-steps", label(law), substeps, needed),
                      with_options(law, {{"substeps", static_cast<double>(substeps)}}), rate_hz});
  }
}

void projections(const LawFile& law, double rate_hz, Fidelities& to) {
  for (const char* projection : {"consistent", "paper"}) {
    to.all.push_back({projection, with_options(law, {{"projection", std::string(projection)}}), rate_hz});
  }
  to.reference = to.all.front();
  to.reference.rate_hz = reference_rate_factor * rate_hz;
}

void append(std::vector<Fidelity>& to, std::vector<Fidelity> more) {
  std::move(more.begin(), more.end(), std::back_inserter(to));
}

}  // namespace

LawFile with_law(const LawFile& file, models::Law law) {
  LawFile other = file;
  other.law = std::move(law);
  other.std_errors.clear();
  return other;
}

LawFile with_options(const LawFile& law, const models::Options& changes) {
  models::Options options = law.law.options();
  for (const auto& [name, value] : changes) options[name] = value;
  return with_law(law, models::Law::make(law.law.model(), law.law.values(), options));
}

Fidelities fidelities_of(const LawFile& law, double rate_hz) {
  Fidelities result{.all = {}, .reference = {"as given", law, rate_hz}, .notes = {}};
  const models::LawFacts& facts = models::law_facts(law.law.model());
  const LawFile given = facts.in_float ? with_options(law, {{"precision", std::string("double")}}) : law;
  const auto as_given = [&](double reference_hz) {
    result.all.push_back({"as given", given, rate_hz});
    result.reference = {"as given", given, reference_hz};
  };
  switch (facts.fineness) {
    case models::Fineness::strips:
      strips(given, rate_hz, result);
      break;
    case models::Fineness::nodes:
      lattice(given, rate_hz, result);
      break;
    case models::Fineness::integrators:
      integrators(given, rate_hz, result);
      break;
    case models::Fineness::projections:
      projections(given, rate_hz, result);
      break;
    case models::Fineness::segments:
      as_given(rate_hz);
      append(result.all, resampled_segments(given, facts.size.last, rate_hz));
      break;
    case models::Fineness::points:
      as_given(rate_hz);
      append(result.all, resampled_tables(given, facts.size.last, rate_hz));
      break;
    case models::Fineness::memberships:
      as_given(rate_hz);
      add_memberships(given, rate_hz, result);
      break;
    case models::Fineness::nothing:
      as_given(reference_rate_factor * rate_hz);
      break;
  }
  if (facts.in_float) {
    const Fidelity& first = result.all.front();
    const LawFile single = with_options(first.law, {{"precision", std::string("float")}});
    result.all.push_back({first.label + ", float", single, rate_hz});
  }
  return result;
}

}  // namespace kerf::bench
