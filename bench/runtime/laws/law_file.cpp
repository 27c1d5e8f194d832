#include "laws/law_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <system_error>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <kerf/drivers/toml_text.h>
#include <kerf/version.h>

#include "laws/law_toml.h"
#include "laws/plugin_mention.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

using drivers::toml_number;
using drivers::toml_text;

models::Options read_options(const Place& place, const toml::table& root) {
  models::Options options;
  if (root.get("fidelity") == nullptr) return options;
  for (const auto& [key, node] : place.table(root, "fidelity")) {
    const std::string name(key.str());
    if (node.is_boolean()) {
      options[name] = **node.as_boolean();
    } else if (node.is_string()) {
      options[name] = **node.as_string();
    } else {
      options[name] = place.number(node, "'" + name + "'");
    }
  }
  return options;
}

/// "closing" for "closing[3]": parameters of that kind stand in the file as one array.
std::string_view group_of(std::string_view parameter) { return parameter.substr(0, parameter.find('[')); }

models::Contact read_contact(const Place& place, const toml::table& root, const std::string& position_unit) {
  models::Contact contact;
  if (root.get("contact") == nullptr) return contact;
  const toml::table& table = place.table(root, "contact");
  place.allow_only(table, {"position", "direction"}, "[contact]");
  if (const toml::node* position = table.get("position")) {
    const auto values = place.measured(*position, "position", position_unit).values;
    if (values.size() != 1 || !std::isfinite(values[0]))
      place.refuse(*position, "'position' must be one number");
    contact.position = values[0];
  }
  const std::string direction = place.text(table, "direction", "increasing");
  if (direction != "increasing" && direction != "decreasing") {
    place.refuse(*table.get("direction"), "'direction' is \"{}\", expected \"increasing\" or \"decreasing\"",
                 direction);
  }
  contact.direction = direction == "increasing" ? 1.0 : -1.0;
  return contact;
}

/// So many numbers in a unit.
std::vector<double> read_numbers(const Place& place, const toml::table& table, const std::string& key,
                                 const std::string& unit, std::size_t count) {
  const toml::node* const node = table.get(key);
  if (node == nullptr) place.refuse(table, "[fit] has no '{}', which belongs to its range", key);
  auto values = place.measured(*node, key, unit).values;
  if (values.size() != count ||
      !std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
    place.refuse(*node, "'{}' must be {} finite number{}", key, count, count == 1 ? "" : "s");
  return values;
}

std::optional<FittedRange> read_range(const Place& place, const toml::table& table,
                                      const std::string& position_unit) {
  if (table.get("penetration") == nullptr && table.get("speed") == nullptr) return std::nullopt;
  const auto depths = read_numbers(place, table, "penetration", position_unit, 2);
  const auto speed = read_numbers(place, table, "speed", position_unit + "/s", 1);
  return FittedRange{.least = depths[0], .most = depths[1], .fastest = speed[0]};
}

FitProvenance read_provenance(const Place& place, const toml::table& root, const std::string& position_unit,
                              const std::string& force_unit) {
  FitProvenance fit;
  if (root.get("fit") == nullptr) return fit;
  const toml::table& table = place.table(root, "fit");
  place.allow_only(
      table, {"recording", "sha256", "content", "rmse", "penetration", "speed", "date", "software"}, "[fit]");
  fit.recording_uuid = place.text(table, "recording", "");
  fit.recording_sha256 = place.text(table, "sha256", "");
  fit.recording_content = place.text(table, "content", "");
  fit.date = place.text(table, "date", "");
  fit.software = place.text(table, "software", "");
  if (const toml::node* rmse = table.get("rmse")) {
    // Up to 0.1.0 that of a torque was written in N, and meant N·m.
    const toml::table* const given = rmse->as_table();
    const bool is_of_old = given != nullptr && (*given)["unit"].value<std::string_view>() == "N";
    const auto values = place.measured(*rmse, "rmse", is_of_old ? "N" : force_unit).values;
    if (values.size() != 1) place.refuse(*rmse, "'rmse' must be one number");
    fit.rmse_n = values[0];
  }
  fit.range = read_range(place, table, position_unit);
  return fit;
}

/// A unit of the axis; `only` is the one that the law makes sense in, or empty.
std::string unit_choice(const Place& place, const toml::table& root, std::string_view key,
                        std::string_view only, std::initializer_list<std::string_view> allowed,
                        std::string_view model) {
  std::string unit = place.text(root, key, only.empty() ? *allowed.begin() : only);
  if (std::find(allowed.begin(), allowed.end(), unit) == allowed.end()) {
    place.refuse(*root.get(key), "'{}' is \"{}\", expected {}; parameters may be in other units", key, unit,
                 fmt::join(allowed, " or "));
  }
  if (!only.empty() && unit != only) {
    place.refuse(*root.get(key), "'{}' is \"{}\", but law '{}' is one of {}", key, unit, model, only);
  }
  return unit;
}

/// The parameters of a law file, put in the order in which the law takes them.
Measured read_parameters(const Place& place, const toml::table& root,
                         const std::vector<models::ParameterInfo>& infos, const std::string& force_unit,
                         const std::string& position_unit) {
  const toml::table& table = place.table(root, "parameters");
  for (const auto& [key, node] : table) {
    const std::string_view name = key.str();
    if (std::none_of(infos.begin(), infos.end(),
                     [&](const auto& info) { return group_of(info.name) == name; })) {
      std::vector<std::string_view> known;
      for (const auto& info : infos) {
        if (known.empty() || known.back() != group_of(info.name)) known.push_back(group_of(info.name));
      }
      place.refuse(node, "unknown parameter '{}'; the law takes {}", key.str(), fmt::join(known, ", "));
    }
  }
  Measured all;
  for (std::size_t i = 0; i < infos.size();) {
    const std::string group(group_of(infos[i].name));
    const auto end = static_cast<std::size_t>(
        std::find_if(infos.begin() + static_cast<std::ptrdiff_t>(i), infos.end(),
                     [&](const auto& info) { return group_of(info.name) != group; }) -
        infos.begin());
    const toml::node* node = table.get(group);
    if (node == nullptr) place.refuse(table, "parameter '{}' is missing", group);
    const Measured one =
        place.measured(*node, group, models::unit_of(infos[i].quantity, force_unit, position_unit));
    if (one.values.size() != end - i) {
      place.refuse(*node, "'{}' has {} values, expected {}", group, one.values.size(), end - i);
    }
    for (std::size_t k = i; k < end; ++k) {
      const double value = one.values[k - i];
      if (!(value >= infos[k].lower && value <= infos[k].upper)) {
        place.refuse(*node, "parameter '{}' is {} in SI, expected a number from {} to {}", infos[k].name,
                     value, infos[k].lower, infos[k].upper);
      }
    }
    all.values.insert(all.values.end(), one.values.begin(), one.values.end());
    all.std_errors.insert(all.std_errors.end(), one.std_errors.begin(), one.std_errors.end());
    i = end;
  }
  if (all.std_errors.size() != all.values.size()) all.std_errors.clear();
  return all;
}

std::string option_text(const models::OptionValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const double* number = std::get_if<double>(&value)) return toml_number(*number);
  return toml_text(std::get<std::string>(value));
}

/// `value` or `[a, b, c]`
std::string value_text(const std::vector<double>& all, std::size_t begin, std::size_t end, bool is_array) {
  std::string text;
  for (std::size_t i = begin; i < end; ++i) text += (i == begin ? "" : ", ") + toml_number(all[i]);
  return is_array ? "[" + text + "]" : text;
}

/// Where a scalar law goes; a spatial one brings its axes with it.
std::string contact_text(const LawFile& file) {
  std::string text;
  if (!file.axis.empty()) text += fmt::format("axis = {}\n", toml_text(file.axis));
  text += fmt::format("position_unit = \"{}\"\nforce_unit = \"{}\"\n", file.position_unit, file.force_unit);
  return text + fmt::format("\n[contact]\nposition = {{ value = {}, unit = \"{}\" }}\ndirection = \"{}\"\n",
                            toml_number(file.contact.position), file.position_unit,
                            file.contact.direction > 0.0 ? "increasing" : "decreasing");
}

std::string parameters_text(const LawFile& file) {
  const auto infos = file.law.parameters();
  const auto& values = file.law.values();
  std::string text = "\n[parameters]\n";
  for (std::size_t i = 0; i < infos.size();) {
    const auto group = group_of(infos[i].name);
    std::size_t end = i + 1;
    while (end < infos.size() && group_of(infos[end].name) == group) ++end;
    const bool is_array = group.size() != infos[i].name.size();
    text += fmt::format("{} = {{ value = {}, unit = \"{}\"", group, value_text(values, i, end, is_array),
                        models::unit_of(infos[i].quantity, file.force_unit, file.position_unit));
    if (!file.std_errors.empty()) {
      text += fmt::format(", std_error = {}", value_text(file.std_errors, i, end, is_array));
    }
    text += fmt::format(" }}  # {}\n", infos[i].meaning);
    i = end;
  }
  return text;
}

/// "0.3.0" for "0.3.0 (81988ff57a31)..."; three numbers in `numbers`.
std::string take_version(std::string_view text, std::array<int, 3>& numbers) {
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0 && (at == end || *at++ != '.')) return "";
    const auto [next, error] = std::from_chars(at, end, numbers[i]);
    if (error != std::errc{}) return "";
    at = next;
  }
  return {text.data(), at};
}

/// The version in the first line, "# kerf 0.3.0 (81988ff57a31)", if it is later than this one; else empty.
std::string later_writer(std::string_view text) {
  constexpr std::string_view before = "# kerf ";
  std::array<int, 3> theirs{};
  std::array<int, 3> ours{};
  if (!text.starts_with(before)) return "";
  std::string writer = take_version(text.substr(before.size()), theirs);
  if (writer.empty() || take_version(version(), ours).empty() || theirs <= ours) return "";
  return writer;
}

}  // namespace

LawFile law_from_table(const toml::table& root, const std::string& name,
                       std::initializer_list<std::string_view> beside, const PluginTerms& terms) {
  const Place place(name);
  std::vector<std::string_view> known{"model",      "axis",     "position_unit", "force_unit", "contact",
                                      "parameters", "fidelity", "fit",           "plugin"};
  known.insert(known.end(), beside);
  place.allow_only(root, known, "a law");
  const std::string model = place.text(root, "model", "");
  if (model.empty()) place.refuse(root, "no 'model'; expected for example model = \"kelvin\"");
  require_plugin(place, root, model, terms);
  // What a law says of its options or parameters has the line of their table.
  const auto at = [&](std::string_view key, const auto& action) {
    try {
      return action();
    } catch (const std::invalid_argument& error) {
      const toml::node* node = root.get(key);
      place.refuse(node != nullptr ? *node : root, "{}", error.what());
    }
  };
  const models::LawInfo info = at("model", [&] {
    try {
      return models::law_info(model);
    } catch (const std::invalid_argument& unknown) {
      throw std::invalid_argument(fmt::format("{}; {}", unknown.what(), terms.of_unknown));
    }
  });
  const std::string position_unit =
      unit_choice(place, root, "position_unit", info.position_unit, {"m", "rad"}, model);
  const std::string force_unit = unit_choice(place, root, "force_unit", info.force_unit, {"N", "N·m"}, model);
  const models::Options options = read_options(place, root);
  const auto infos = at("fidelity", [&] { return models::Law::parameters(model, options); });
  if (!models::Law::axes(model).empty()) {
    for (const auto* key : {"axis", "position_unit", "force_unit", "contact"}) {
      const toml::node* node = root.get(key);
      if (node == nullptr) continue;
      place.refuse(*node, "law '{}' brings axes and units of its own; leave '{}' out", model, key);
    }
  }
  Measured parameters = read_parameters(place, root, infos, force_unit, position_unit);
  return {.law = at("parameters", [&] { return models::Law::make(model, parameters.values, options); }),
          .contact = read_contact(place, root, position_unit),
          .axis = place.text(root, "axis", ""),
          .position_unit = position_unit,
          .force_unit = force_unit,
          .std_errors = std::move(parameters.std_errors),
          .fit = read_provenance(place, root, position_unit, force_unit),
          .name = name};
}

LawFile parse_law_file(const std::string& text, const std::string& name, const PluginTerms& terms) {
  try {
    return law_from_table(parse_toml(text, name), name, {}, terms);
  } catch (const std::invalid_argument& refused) {
    const std::string writer = later_writer(text);
    if (writer.empty()) throw;
    throw std::invalid_argument(
        fmt::format("{} (kerf {} wrote the file, and this is {})", refused.what(), writer, version()));
  }
}

LawFile parse_law_file(const std::string& text, const std::string& name) {
  return parse_law_file(text, name, {});
}

std::string to_toml(const LawFile& file) {
  std::string text = fmt::format("model = \"{}\"\n", file.law.model());
  if (!file.law.is_spatial()) text += contact_text(file);
  text += parameters_text(file);
  if (!file.law.options().empty()) {
    text += "\n[fidelity]\n";
    for (const auto& [name, value] : file.law.options())
      text += fmt::format("{} = {}\n", name, option_text(value));
  }
  text += plugin_text(file.law);
  if (!file.fit.recording_uuid.empty()) {
    text += fmt::format("\n[fit]\nrecording = {}\nsha256 = {}\n", toml_text(file.fit.recording_uuid),
                        toml_text(file.fit.recording_sha256));
    if (!file.fit.recording_content.empty())
      text += fmt::format("content = {}\n", toml_text(file.fit.recording_content));
    text += fmt::format("rmse = {{ value = {}, unit = \"{}\" }}\n", toml_number(file.fit.rmse_n),
                        file.law.is_spatial() ? "N" : file.force_unit);
    if (const auto& range = file.fit.range)
      text += fmt::format(
          "penetration = {{ value = [{}, {}], unit = \"{}\" }}\nspeed = {{ value = {}, unit = \"{}/s\" }}\n",
          toml_number(range->least), toml_number(range->most), file.position_unit,
          toml_number(range->fastest), file.position_unit);
    text += fmt::format("date = {}\nsoftware = {}\n", toml_text(file.fit.date), toml_text(file.fit.software));
  }
  return text;
}

}  // namespace kerf::bench
