#include "bench/export/fmu/fmi3_rules.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <sstream>

namespace kerf::test {
namespace {

/// What an element may hold: its attributes, those needed marked by '!', and its children in order.
struct Element {
  std::vector<std::string> attributes;
  std::vector<std::string> children;
};

const std::map<std::string, Element>& schema() {
  static const std::map<std::string, Element> all{
      {"fmiModelDescription",
       {{"!fmiVersion", "!modelName", "!instantiationToken", "description", "author", "version", "copyright",
         "license", "generationTool", "generationDateAndTime", "variableNamingConvention"},
        {"CoSimulation", "UnitDefinitions", "TypeDefinitions", "LogCategories", "DefaultExperiment",
         "ModelVariables", "ModelStructure", "Annotations"}}},
      {"CoSimulation",
       {{"!modelIdentifier", "needsExecutionTool", "canBeInstantiatedOnlyOncePerProcess",
         "canGetAndSetFMUState", "canSerializeFMUState", "canHandleVariableCommunicationStepSize",
         "fixedInternalStepSize", "maxOutputDerivativeOrder", "providesIntermediateUpdate",
         "mightReturnEarlyFromDoStep", "canReturnEarlyAfterIntermediateUpdate", "hasEventMode"},
        {}}},
      {"UnitDefinitions", {{}, {"Unit"}}},
      {"Unit", {{"!name"}, {"BaseUnit", "DisplayUnit"}}},
      {"BaseUnit", {{"kg", "m", "s", "A", "K", "mol", "cd", "rad", "factor", "offset"}, {}}},
      {"LogCategories", {{}, {"Category"}}},
      {"Category", {{"!name", "description"}, {}}},
      {"DefaultExperiment", {{"startTime", "stopTime", "tolerance", "stepSize"}, {}}},
      {"ModelVariables", {{}, {"Float64"}}},
      {"Float64",
       {{"!name", "!valueReference", "description", "causality", "variability", "initial", "start", "unit",
         "displayUnit", "min", "max", "nominal"},
        {}}},
      {"ModelStructure", {{}, {"Output", "InitialUnknown"}}},
      {"Output", {{"!valueReference", "dependencies", "dependenciesKind"}, {}}},
      {"InitialUnknown", {{"!valueReference", "dependencies", "dependenciesKind"}, {}}}};
  return all;
}

class Rules {
 public:
  void check_element(const pugi::xml_node& node) {
    const auto found = schema().find(node.name());
    if (found == schema().end()) return broken("no element ", node.name());
    const auto& [attributes, children] = found->second;
    for (const std::string& name : attributes) {
      if (name[0] == '!' && !node.attribute(name.c_str() + 1))
        broken(node.name(), " without " + name.substr(1));
    }
    for (const pugi::xml_attribute attribute : node.attributes()) {
      const std::string name = attribute.name();
      if (std::ranges::find(attributes, name) == attributes.end() &&
          std::ranges::find(attributes, "!" + name) == attributes.end())
        broken(node.name(), " has no attribute " + name);
      if (std::string_view(attribute.value()).find_first_of("\n\t") != std::string_view::npos)
        broken(name, " is not one line");
    }
    auto at = children.begin();
    for (const pugi::xml_node child : node.children()) {
      at = std::find(at, children.end(), child.name());
      if (at == children.end()) return broken(child.name(), " is in the wrong place");
      check_element(child);
    }
  }

  void check_variables(const pugi::xml_node& root) {
    std::set<std::string> names;
    std::set<std::string> references;
    std::set<std::string> units;
    for (const pugi::xml_node unit : root.child("UnitDefinitions")) {
      if (!units.insert(unit.attribute("name").value()).second)
        broken("a unit twice: ", unit.attribute("name").value());
    }
    std::set<std::string> outputs;
    std::set<std::string> unknowns;
    int independents = 0;
    for (const pugi::xml_node variable : root.child("ModelVariables")) {
      const std::string name = variable.attribute("name").value();
      const std::string reference = variable.attribute("valueReference").value();
      const std::string causality = variable.attribute("causality").as_string("local");
      const std::string variability = variable.attribute("variability").as_string("continuous");
      const std::string initial =
          variable.attribute("initial").as_string(causality == "input" ? "exact" : "");
      if (!names.insert(name).second || name.empty()) broken(name, ": its name is not the only one");
      if (!references.insert(reference).second) broken(name, ": its value reference is not the only one");
      if (const auto unit = variable.attribute("unit"); unit && !units.contains(unit.value()))
        broken(name, ": its unit is not defined");
      static const std::set<std::string> legal{"independent continuous ", "input continuous exact",
                                               "output continuous calculated", "local constant exact",
                                               "output constant exact"};
      if (!legal.contains(causality + " " + variability + " " + initial))
        broken(name, ": " + causality + " " + variability + " " + initial);
      const bool has_start = initial == "exact" || initial == "approx";
      if (has_start != static_cast<bool>(variable.attribute("start")))
        broken(name, ": with or without a start");
      if (has_start &&
          variable.attribute("start").as_double(std::nan("")) != variable.attribute("start").as_double(0.0))
        broken(name, ": its start is no number");
      if (causality == "independent") ++independents;
      if (causality == "output") outputs.insert(reference);
      if (causality == "output" && initial == "calculated") unknowns.insert(reference);
    }
    if (independents != 1) broken("ModelVariables", ": not one independent");
    check_structure(root, "Output", outputs, references);
    check_structure(root, "InitialUnknown", unknowns, references);
  }

  void check_identity(const pugi::xml_node& root) {
    const std::string version = root.attribute("fmiVersion").value();
    if (version != "3.0") broken("fmiVersion ", version);
    const std::string identifier = root.child("CoSimulation").attribute("modelIdentifier").value();
    const auto is_c = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    if (identifier.empty() || std::isdigit(static_cast<unsigned char>(identifier[0])) != 0 ||
        !std::ranges::all_of(identifier, is_c))
      broken("no identifier: ", identifier);
  }

  std::vector<std::string> found;

 private:
  void broken(const std::string& what, const std::string& why) { found.push_back(what + why); }

  void check_structure(const pugi::xml_node& root, const char* kind, const std::set<std::string>& expected,
                       const std::set<std::string>& references) {
    std::set<std::string> named;
    for (const pugi::xml_node unknown : root.child("ModelStructure").children(kind)) {
      named.insert(unknown.attribute("valueReference").value());
      std::istringstream dependencies(unknown.attribute("dependencies").value());
      for (std::string reference; dependencies >> reference;) {
        if (!references.contains(reference)) broken(kind, " depends on no variable");
      }
    }
    if (named != expected) broken(kind, "s are not those that the variables ask for");
  }
};

template <typename Number>
Number number_at(std::string_view bytes, std::size_t at) {
  Number number{};
  std::memcpy(&number, bytes.substr(at).data(), sizeof number);
  return number;
}

}  // namespace

std::vector<std::string> broken_rules(const pugi::xml_document& description) {
  Rules rules;
  const auto root = description.document_element();
  rules.check_element(root);
  rules.check_identity(root);
  rules.check_variables(root);
  return rules.found;
}

std::vector<std::string> broken_zip_rules(std::string_view archive) {
  std::vector<std::string> found;
  if (!archive.starts_with("PK\3\4")) found.emplace_back("it does not begin with a file");
  constexpr std::string_view file_mark = "PK\1\2";
  std::size_t files = 0;
  for (std::size_t at = archive.find(file_mark); at != std::string_view::npos;
       at = archive.find(file_mark, at + 46), ++files) {
    const auto name = archive.substr(at + 46, number_at<std::uint16_t>(archive, at + 28));
    const auto broken = [&](const char* why) { found.push_back(std::string(name) + why); };
    if (number_at<std::uint16_t>(archive, at + 6) > 20) broken(": needs more than zip 2.0");
    const auto flags = number_at<std::uint16_t>(archive, at + 8);
    const auto method = number_at<std::uint16_t>(archive, at + 10);
    if (method != 0 && method != 8) broken(": neither stored nor deflated");
    if ((flags & 1U) != 0) broken(": encrypted");
    if ((flags & 8U) != 0) broken(": has a data descriptor");
    if (name.find('\\') != std::string_view::npos || name.starts_with("/")) broken(": no name for an FMU");
    const auto local = number_at<std::uint32_t>(archive, at + 42);
    if (archive.substr(local, 4) != "PK\3\4" || (number_at<std::uint16_t>(archive, local + 6) & 8U) != 0)
      broken(": its own header is another");
  }
  if (files == 0) found.emplace_back("no files");
  return found;
}

}  // namespace kerf::test
