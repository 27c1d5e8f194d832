#include "hosts/fmu/model_description.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include <kerf/models/parameter.h>
#include <kerf/version.h>

#include "hosts/by_c/c_compiler.h"
#include "law_in_words.h"

namespace kerf::bench {
namespace {

/// Exponents of a unit over kg, m, s, rad.
using Exponents = std::array<int, 4>;
constexpr std::array<const char*, 4> bases{"kg", "m", "s", "rad"};

const std::map<std::string_view, Exponents>& symbols() {
  static const std::map<std::string_view, Exponents> all{
      {"1", {0, 0, 0, 0}},   {"kg", {1, 0, 0, 0}}, {"m", {0, 1, 0, 0}}, {"s", {0, 0, 1, 0}},
      {"rad", {0, 0, 0, 1}}, {"N", {1, 1, -2, 0}}, {"J", {1, 2, -2, 0}}};
  return all;
}

constexpr std::string_view dot = "·";
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> plain{
    {{dot, "."}, {"²", "2"}, {"³", "3"}}};

/// "N·s/m²" as units are named in FMI: "N.s/m2".
std::string plain_unit(std::string unit) {
  for (const auto& [from, to] : plain) {
    for (auto at = unit.find(from); at != std::string::npos; at = unit.find(from))
      unit.replace(at, from.size(), to);
  }
  return unit;
}

Exponents exponents_of(const std::string& plain_name) {
  Exponents sum{};
  int sign = 1;
  for (std::size_t at = 0; at < plain_name.size();) {
    const std::size_t end = std::min(plain_name.find_first_of("./", at), plain_name.size());
    std::string symbol = plain_name.substr(at, end - at);
    int power = 1;
    if (symbol.size() > 1 && (symbol.back() == '2' || symbol.back() == '3')) {
      power = symbol.back() - '0';
      symbol.pop_back();
    }
    const auto found = symbols().find(symbol);
    if (found == symbols().end()) throw std::logic_error("no exponents for the unit " + plain_name);
    for (std::size_t base = 0; base < sum.size(); ++base) sum[base] += sign * power * found->second[base];
    if (end < plain_name.size() && plain_name[end] == '/') sign = -1;
    at = end + 1;
  }
  return sum;
}

class Variables {
 public:
  explicit Variables(pugi::xml_node root)
      : units_(root.append_child("UnitDefinitions")), categories_(root.append_child("LogCategories")) {
    auto category = categories_.append_child("Category");
    category.append_attribute("name") = "logStatusError";
    category.append_attribute("description") = "why a call was refused";
    auto experiment = root.append_child("DefaultExperiment");
    experiment.append_attribute("startTime") = "0";
    experiment.append_attribute("stepSize") = "0.001";
    variables_ = root.append_child("ModelVariables");
  }

  pugi::xml_node add(int reference, const std::string& name, const std::string& causality,
                     const std::string& variability, const std::string& unit,
                     const std::string& description) {
    auto variable = variables_.append_child("Float64");
    variable.append_attribute("name") = name.c_str();
    variable.append_attribute("valueReference") = reference;
    variable.append_attribute("description") = description.c_str();
    variable.append_attribute("causality") = causality.c_str();
    variable.append_attribute("variability") = variability.c_str();
    if (const std::string known = plain_unit(unit); known != "1") {
      variable.append_attribute("unit") = known.c_str();
      define(known);
    }
    return variable;
  }

 private:
  void define(const std::string& unit) {
    if (units_.find_child_by_attribute("Unit", "name", unit.c_str())) return;
    auto element = units_.append_child("Unit");
    element.append_attribute("name") = unit.c_str();
    auto base = element.append_child("BaseUnit");
    const Exponents exponents = exponents_of(unit);
    for (std::size_t i = 0; i < bases.size(); ++i) {
      if (exponents[i] != 0) base.append_attribute(bases[i]) = exponents[i];
    }
  }

  pugi::xml_node units_;
  pugi::xml_node categories_;
  pugi::xml_node variables_;
};

std::string text_of(const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text, "  ", pugi::format_default, pugi::encoding_utf8);
  return text.str();
}

pugi::xml_node root_of(pugi::xml_document& document, const char* name) {
  auto declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  auto root = document.append_child(name);
  root.append_attribute("fmiVersion") = "3.0";
  return root;
}

}  // namespace

std::vector<FmuConstant> fmu_constants(const LawFile& file) {
  std::vector<FmuConstant> constants{
      {"contact.position", file.contact.position, file.position_unit, "position where the tissue begins"},
      {"contact.direction", file.contact.direction, "1",
       "+1: the position grows into the tissue, -1: it shrinks"}};
  const std::vector<models::ParameterInfo> parameters = file.law.parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i)
    constants.push_back({"law." + parameters[i].name, file.law.values()[i],
                         models::unit_of(parameters[i].quantity, file.force_unit, file.position_unit),
                         parameters[i].meaning});
  return constants;
}

std::string fmu_token(const ExportedLaw& law) { return fmt::format("{} of {}", law.sha256, software()); }

std::string model_description(const ExportedLaw& law) {
  const LawFile& file = law.file;
  pugi::xml_document document;
  auto root = root_of(document, "fmiModelDescription");
  root.append_attribute("modelName") = law.name.c_str();
  root.append_attribute("instantiationToken") = fmu_token(law).c_str();
  root.append_attribute("description") =
      fmt::format("Force law {} for {}: {}. Fit: {}. Valid: {}. Law file of SHA-256 {}.", file.law.model(),
                  axis_in_words(file), models::law_info(file.law.model()).equation, fit_in_words(file),
                  range_in_words(file), law.sha256)
          .c_str();
  root.append_attribute("license") = "Apache-2.0, of the code that Kerf made";
  root.append_attribute("generationTool") = software().c_str();
  root.append_attribute("variableNamingConvention") = "structured";
  auto simulation = root.append_child("CoSimulation");
  simulation.append_attribute("modelIdentifier") = law.name.c_str();
  for (const char* const can :
       {"canHandleVariableCommunicationStepSize", "canGetAndSetFMUState", "canSerializeFMUState"})
    simulation.append_attribute(can) = true;

  Variables variables(root);
  auto time = variables.add(fmu_time, "time", "independent", "continuous", "1", "simulated time in seconds");
  static_cast<void>(time);
  variables
      .add(fmu_position, "position", "input", "continuous", file.position_unit, "of the tool on the axis")
      .append_attribute("start") = fmt::format("{:.17g}", file.contact.position).c_str();
  variables.add(fmu_velocity, "velocity", "input", "continuous", file.position_unit + "/s", "its derivative")
      .append_attribute("start") = 0.0;
  variables
      .add(fmu_force, "force", "output", "continuous", file.force_unit,
           "of the tissue on the tool at the end of the last step; positive where it pushes the position up")
      .append_attribute("initial") = "calculated";
  int reference = fmu_first_constant;
  for (const FmuConstant& constant : fmu_constants(file)) {
    auto variable =
        variables.add(reference++, constant.name, "local", "constant", constant.unit, constant.meaning);
    variable.append_attribute("initial") = "exact";
    variable.append_attribute("start") = fmt::format("{:.17g}", constant.value).c_str();
  }
  auto structure = root.append_child("ModelStructure");
  // The force is that of the last step: inputs set after it, before the next, do not change it.
  for (const char* const kind : {"Output", "InitialUnknown"}) {
    auto unknown = structure.append_child(kind);
    unknown.append_attribute("valueReference") = fmu_force;
    unknown.append_attribute("dependencies") = "";
  }
  return text_of(document);
}

std::string build_description(const ExportedLaw& law) {
  pugi::xml_document document;
  auto root = root_of(document, "fmiBuildDescription");
  auto configuration = root.append_child("BuildConfiguration");
  configuration.append_attribute("modelIdentifier") = law.name.c_str();
  auto files = configuration.append_child("SourceFileSet");
  files.append_attribute("language") = "C99";
  files.append_attribute("compilerOptions") = "-O2 -ffp-contract=off";
  // It includes the law.
  files.append_child("SourceFile").append_attribute("name") = (law.name + "_fmu.c").c_str();
  auto library = configuration.append_child("Library");
  library.append_attribute("name") = "m";
  return text_of(document);
}

}  // namespace kerf::bench
