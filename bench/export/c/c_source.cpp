#include "c/c_source.h"

#include <cctype>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <kerf/drivers/toml_text.h>
#include <kerf/traced/program.h>
#include <kerf/version.h>

#include "hosts/by_c/c_host_texts.h"
#include "law_in_words.h"
#include "own_code/compiler.h"

namespace kerf::bench {
namespace {

/// Text as lines of a comment.
std::string as_comment(const std::string& text) {
  std::string comment;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    comment += line.empty() ? " *\n" : " *     " + in_comment(line) + "\n";
  return comment;
}

/// Text as a literal of C, in lines.
std::string as_literal(const std::string& text) {
  std::string literal = "\"";
  std::size_t length = 0;
  for (const char c : text) {
    if (c == '"' || c == '\\') literal += '\\';
    // No trigraph.
    if (c == '?') literal += '\\';
    literal += c;
    if (++length >= 90 && c == ',') {
      literal += "\"\n         \"";
      length = 0;
    }
  }
  return literal + "\"";
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// As C has it: "0.5", "(-1.0)".
std::string number(double value) {
  std::string text = drivers::toml_number(value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text[0] == '-' ? "(" + text + ")" : text;
}

}  // namespace

nlohmann::ordered_json described(const ExportedLaw& exported) {
  const LawFile& law = exported.file;
  nlohmann::ordered_json json;
  json["law"] = std::filesystem::path(law.name).filename().string();
  json["sha256"] = exported.sha256;
  json["model"] = law.law.model();
  json["equation"] = models::law_info(law.law.model()).equation;
  json["axis"] = law.axis;
  json["position_unit"] = law.position_unit;
  json["force_unit"] = law.force_unit;
  json["contact"] = {{"position", law.contact.position}, {"direction", law.contact.direction > 0.0 ? 1 : -1}};
  json["parameters"] = nlohmann::ordered_json::array();
  const auto infos = law.law.parameters();
  for (std::size_t i = 0; i < infos.size(); ++i) {
    nlohmann::ordered_json one;
    one["name"] = infos[i].name;
    one["value"] = law.law.values()[i];
    one["unit"] = models::unit_of(infos[i].quantity, law.force_unit, law.position_unit);
    if (!law.std_errors.empty()) one["std_error"] = law.std_errors[i];
    one["meaning"] = infos[i].meaning;
    json["parameters"].push_back(std::move(one));
  }
  json["options"] = nlohmann::ordered_json::object();
  for (const auto& [name, value] : law.law.options())
    std::visit([&, &key = name](const auto& of) { json["options"][key] = of; }, value);
  if (!law.fit.recording_uuid.empty()) {
    json["fit"] = {{"recording", law.fit.recording_uuid},
                   {"sha256", law.fit.recording_sha256},
                   {"content", law.fit.recording_content},
                   {"rmse_n", law.fit.rmse_n},
                   {"date", law.fit.date},
                   {"software", law.fit.software}};
  }
  if (law.fit.range) {
    json["range"] = {{"penetration", {law.fit.range->least, law.fit.range->most}},
                     {"speed", law.fit.range->fastest}};
  }
  json["exported_by"] = software();
  return json;
}

std::string c_source(const ExportedLaw& exported) {
  const LawFile& law = exported.file;
  const traced::Program program = traced::trace(law.law.model(), law.law.values(), law.law.options());
  return filled_in(c_host_text("law.c.in"),
                   {{"MODEL", std::string(law.law.model())},
                    {"LAW", in_comment(std::filesystem::path(law.name).filename().string())},
                    {"SOFTWARE", software()},
                    {"EQUATION", std::string(models::law_info(law.law.model()).equation)},
                    {"SHA256", exported.sha256},
                    {"FIT", in_comment(fit_in_words(law))},
                    {"RANGE", range_in_words(law)},
                    {"POSITION_UNIT", law.position_unit},
                    {"FORCE_UNIT", law.force_unit},
                    {"CODE", traced::to_c(program, exported.name)},
                    {"CONTACT", number(law.contact.position)},
                    {"DIRECTION", number(law.contact.direction)},
                    {"GROWS", law.contact.direction > 0.0 ? "grows into the tissue" : "shrinks into it"},
                    {"UPPER", upper(exported.name)},
                    {"NAME", exported.name},
                    {"TEXT", as_comment(exported.text)},
                    {"JSON", as_literal(described(exported).dump())}});
}

}  // namespace kerf::bench
