#pragma once

#include <cstdlib>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/law.h>

namespace kerf::test {

inline models::OptionValue option_in(const std::string& text) {
  if (text == "true" || text == "false") return text == "true";
  if (text.front() == '\'') return text.substr(1, text.size() - 2);
  return std::strtod(text.c_str(), nullptr);
}

/// The numbers of `{ value = [0, 0.1], unit = "rad" }`, or the one.
inline std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.c_str() + text.find_first_of("-0123456789");
  for (char* end = nullptr; *at != '\0' && *at != 'u';
       at = end + std::string_view(end).find_first_not_of("], "))
    numbers.push_back(std::strtod(at, &end));
  return numbers;
}

/// A plausible law of every kind in the registry, `examples/NAME.law.toml` as `kerf` writes law files: a law
/// without one fails every suite that walks the registry.
inline models::Law example(std::string_view model) {
  const std::string name = KERF_SOURCE_DIR "/examples/" + std::string(model) + ".law.toml";
  std::ifstream file(name);
  std::map<std::string, std::vector<double>> given;
  models::Options options;
  std::string section;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('[')) section = line;
    const auto equals = line.find(" = ");
    if (equals == std::string::npos) continue;
    const std::string key = line.substr(0, equals);
    const std::string value = line.substr(equals + 3);
    if (section == "[parameters]") given[key] = numbers_in(value);
    if (section == "[fidelity]") options[key] = option_in(value);
  }
  if (given.empty()) throw std::logic_error("no example of law " + std::string(model) + " in " + name);
  std::vector<double> values;
  std::map<std::string, std::size_t> taken;
  for (const models::ParameterInfo& info : models::Law::parameters(model, options)) {
    const std::string key = info.name.substr(0, info.name.find('['));
    values.push_back(given.at(key).at(taken[key]++));
  }
  return models::Law::make(model, values, options);
}

}  // namespace kerf::test
