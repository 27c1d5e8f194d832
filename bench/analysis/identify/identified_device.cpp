#include "identify/identified_device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include <kerf/schema/recording.h>
#include <kerf/version.h>

#include "files/json_file.h"
#include "files/json_number.h"
#include "files/whole_file.h"
#include "html/html.h"
#include "identify/identified_page.h"
#include "plot/chart_json.h"

namespace kerf::bench {
namespace {

using drivers::Estimate;
using drivers::Known;
using identification::Identified;
using identification::Value;
using json = nlohmann::ordered_json;

Known known(const std::optional<Value>& value, double scale = 1.0) {
  if (!value || !std::isfinite(value->value)) return std::nullopt;
  return Estimate{
      .value = scale * value->value, .lower = scale * value->lower, .upper = scale * value->upper};
}

Known not_negative(Known number) {
  if (!number) return number;
  number->value = std::max(0.0, number->value);
  number->lower = std::max(0.0, number->lower);
  number->upper = std::max(number->value, number->upper);
  return number;
}

/// The friction of one direction where the offset is all friction's: f -+ o, by both their intervals.
Known one_way(const Value& coulomb, const Value& offset, double sign) {
  const double value = coulomb.value + sign * offset.value;
  const double half = std::hypot(0.5 * (coulomb.upper - coulomb.lower), 0.5 * (offset.upper - offset.lower));
  return not_negative(Estimate{.value = value, .lower = value - half, .upper = value + half});
}

void take_friction(const IdentifiedDevice& device, const IdentifiedAxis& of, drivers::AxisModel& model) {
  const Identified& found = *of.found;
  const Value& coulomb = *found.coulomb_n;
  const Value& offset = found.offset_n.front();
  switch (device.offset) {
    case OffsetIs::gravity: {
      model.coulomb_up = model.coulomb_down = not_negative(known(found.coulomb_n));
      // At the middle one of the places.
      model.gravity = known(found.offset_n[found.offset_n.size() / 2]);
      if (found.offset_n.size() > 1) {
        drivers::GravityTable table;
        for (std::size_t place = 0; place < found.offset_n.size(); ++place) {
          table.position.push_back(of.measured.places_m[place] / model.lever);
          table.force.push_back(found.offset_n[place].value);
        }
        model.gravity_table = table;
      }
      return;
    }
    case OffsetIs::friction:
      model.coulomb_up = one_way(coulomb, offset, -1.0);
      model.coulomb_down = one_way(coulomb, offset, 1.0);
      model.gravity = Estimate::exactly(0.0);
      return;
    case OffsetIs::unknown: {
      const double most = std::max(std::abs(offset.lower), std::abs(offset.upper));
      const Estimate either{.value = coulomb.value,
                            .lower = std::max(0.0, coulomb.lower - most),
                            .upper = coulomb.upper + most};
      model.coulomb_up = model.coulomb_down = either;
      return;
    }
  }
}

/// What was found is in units of the commanded force; in newtons where a sensor told what of it acts.
Known in_newtons(const Known& number, const Known& constant) {
  if (!number || !constant) return number;
  const double value = number->value * constant->value;
  const double half = std::hypot(0.5 * (number->upper - number->lower) * constant->value,
                                 0.5 * (constant->upper - constant->lower) * number->value);
  return Estimate{.value = value, .lower = value - half, .upper = value + half};
}

drivers::AxisModel axis_model(const IdentifiedDevice& device, const IdentifiedAxis& of) {
  drivers::AxisModel model = drivers::axis_model_of(device.device.axes.at(of.axis));
  model.validation.fits.reset();
  if (!of.found) {
    model.validation.verdict = of.problem;
    return model;
  }
  const Identified& found = *of.found;
  model.mass = known(found.mass_kg);
  model.viscous = not_negative(known(found.viscous_n_s_per_m));
  take_friction(device, of, model);
  if (found.compliance_m_per_n > found.compliance_half_width && found.fits == false &&
      !found.explanations.empty() &&
      found.explanations.front().missing == identification::Missing::flexible_link) {
    model.stiffness = Estimate{.value = 1.0 / found.compliance_m_per_n,
                               .lower = 1.0 / (found.compliance_m_per_n + found.compliance_half_width),
                               .upper = 1.0 / (found.compliance_m_per_n - found.compliance_half_width)};
  }
  model.delay = not_negative(known(found.delay_s));
  model.delay_jitter = not_negative(known(found.jitter_s));
  if (found.encoder_step_m) {
    model.encoder_step = Estimate::exactly(*found.encoder_step_m / model.lever);
  } else {
    model.encoder_step = known(found.local_step_m, 1.0 / model.lever);
  }
  model.velocity_noise = not_negative(known(found.velocity_noise_m_s, 1.0 / model.lever));
  model.velocity_corner = not_negative(known(found.velocity_corner_rad_s));
  model.motor_constant = known(found.motor_constant);
  model.saturation = known(found.saturation_n);
  if (device.held) {
    // With what of the hand moves with the device; how much that is, one measurement cannot tell.
    model.hand_stiffness = not_negative(known(found.stiffness_n_per_m));
    model.hand_mass = Estimate::exactly(0.0);
    model.hand_damping = Estimate::exactly(0.0);
  }
  for (Known* const number : {&model.mass, &model.viscous, &model.coulomb_up, &model.coulomb_down,
                              &model.gravity, &model.stiffness, &model.hand_stiffness}) {
    *number = in_newtons(*number, model.motor_constant);
  }
  if (model.gravity_table && model.motor_constant) {
    for (double& force : model.gravity_table->force) force *= model.motor_constant->value;
  }
  model.validation.fits = found.fits;
  if (found.validation_rms_m > 0.0) model.validation.error = found.validation_error;
  model.validation.verdict = found.verdict;
  model.validation.why_not = found.why_not;
  return model;
}

std::string interval_in_words(const Value& value, double scale, const std::string& unit) {
  return fmt::format("{:.4g} {} ({:.4g} to {:.4g})", scale * value.value, unit, scale * value.lower,
                     scale * value.upper);
}

json value_as_json(const std::optional<Value>& value) {
  if (!value) return nullptr;
  return {{"value", json_number(value->value)},
          {"lower", json_number(value->lower)},
          {"upper", json_number(value->upper)}};
}

struct Units {
  bool turns = false;
  [[nodiscard]] std::string mass() const { return turns ? "kg·m²" : "kg"; }
  [[nodiscard]] std::string damping() const { return turns ? "N·m·s/rad" : "N·s/m"; }
  [[nodiscard]] std::string force() const { return turns ? "N·m" : "N"; }
  [[nodiscard]] std::string stiffness() const { return turns ? "N·m/rad" : "N/m"; }
  [[nodiscard]] std::string speed() const { return turns ? "mrad/s" : "mm/s"; }
  [[nodiscard]] std::string small_way() const { return turns ? "urad" : "um"; }
};

void offset_lines(const IdentifiedDevice& device, const IdentifiedAxis& of, const Units& units,
                  std::vector<std::string>& lines) {
  const Identified& found = *of.found;
  for (std::size_t place = 0; place < found.offset_n.size(); ++place) {
    std::string name = "constant force";
    if (found.offset_n.size() > 1) name += fmt::format(" at {:.3g} m", of.measured.places_m[place]);
    lines.push_back(
        fmt::format("  {:28}{}", name, interval_in_words(found.offset_n[place], 1.0, units.force())));
  }
  switch (device.offset) {
    case OffsetIs::gravity:
      lines.emplace_back(
          "    taken for gravity, friction for the same both ways; they cannot be told apart by motion");
      return;
    case OffsetIs::friction:
      lines.push_back(fmt::format(
          "    taken for friction: {:.4g} {} up, {:.4g} down; they cannot be told apart by motion",
          found.coulomb_n->value - found.offset_n.front().value, units.force(),
          found.coulomb_n->value + found.offset_n.front().value));
      return;
    case OffsetIs::unknown:
      lines.emplace_back("    gravity, or friction that differs by direction: unknown");
      return;
  }
}

void axis_lines(const IdentifiedDevice& device, const IdentifiedAxis& of, std::vector<std::string>& lines) {
  const drivers::AxisInfo& about = device.device.axes.at(of.axis);
  lines.push_back(fmt::format("axis {}", about.name));
  if (!of.problem.empty()) lines.push_back(fmt::format("  {}", of.problem));
  if (!of.found) return;
  const Identified& found = *of.found;
  const Units units{.turns = about.force_unit == "N·m"};
  const auto line = [&](const char* name, const std::optional<Value>& value, double scale,
                        const std::string& unit) {
    lines.push_back(
        fmt::format("  {:28}{}", name, value ? interval_in_words(*value, scale, unit) : "unknown"));
  };
  line(device.held ? "mass with the hand" : "mass", found.mass_kg, 1.0, units.mass());
  line("viscous friction", found.viscous_n_s_per_m, 1.0, units.damping());
  line("Coulomb friction", found.coulomb_n, 1.0, units.force());
  offset_lines(device, of, units, lines);
  line(device.held ? "stiffness of the hand" : "stiffness", found.stiffness_n_per_m, 1.0, units.stiffness());
  line("delay", found.delay_s, 1e3, "ms");
  line("jitter of the delay", found.jitter_s, 1e6, "us");
  if (found.local_step_m) {
    line("encoder step, where it is", found.local_step_m, 1e6, units.small_way());
  } else {
    lines.push_back(fmt::format("  {:28}{}", "encoder step",
                                found.encoder_step_m
                                    ? fmt::format("{:.4g} {}", 1e6 * *found.encoder_step_m, units.small_way())
                                    : std::string("unknown: no step of which all readings are multiples")));
  }
  line("noise of the velocity", found.velocity_noise_m_s, 1e3, units.speed());
  line("corner of its filter", found.velocity_corner_rad_s, 0.5 / std::numbers::pi, "Hz");
  line("motor constant", found.motor_constant, 1.0, "");
  if (found.motor_constant) {
    lines.emplace_back(
        "    forces, mass and stiffness above are in commanded newtons; the file has them times this");
  }
  if (found.saturation_n) {
    line("saturation", found.saturation_n, 1.0, units.force());
  } else {
    lines.push_back(fmt::format("  {:28}none up to the {:.3g} {} that were commanded", "saturation",
                                found.largest_force_n, units.force()));
  }
  const double compliance = std::max(0.0, found.compliance_m_per_n) + found.compliance_half_width;
  lines.push_back(fmt::format("  {:28}{}", "stiffness of the structure",
                              std::isfinite(compliance)
                                  ? fmt::format("none shows; at least {:.5g} {}",
                                                1.0 / std::max(compliance, 1e-12), units.stiffness())
                                  : std::string("unknown")));
  for (const identification::Agreement& agreement : found.agreements) {
    if (agreement.agrees) continue;
    lines.push_back(fmt::format(
        "  finding: time and frequency domain differ in {} by {:.3g}, {:.1f} standard errors", agreement.name,
        agreement.difference, std::abs(agreement.difference) / agreement.standard_error));
  }
  lines.push_back(fmt::format(
      "  {}: {}", found.fits ? (*found.fits ? "fits" : "does not fit") : "unknown whether it fits",
      found.verdict.empty() ? "no other data to try it on" : found.verdict));
  for (const std::string& why : found.why_not) lines.push_back(fmt::format("    {}", why));
  if (!of.z_width) return;
  lines.emplace_back("  Z-width");
  for (const std::string& told : of.z_width->lines) lines.push_back(fmt::format("    {}", told));
}

/// All that was looked for, in the units of the device, for whoever shows it; null: unknown.
json numbers_as_json(const IdentifiedDevice& device, const IdentifiedAxis& of) {
  const Identified& found = *of.found;
  const drivers::AxisInfo& about = device.device.axes.at(of.axis);
  const Units units{.turns = about.force_unit == "N·m"};
  const std::string way = units.turns ? "rad" : "m";
  json numbers = json::array();
  const auto add = [&](const std::string& name, const std::optional<Value>& value, const std::string& unit) {
    const Value none{.value = std::nan(""), .lower = std::nan(""), .upper = std::nan("")};
    const Value& known = value ? *value : none;
    numbers.push_back({{"name", name},
                       {"value", json_number(known.value)},
                       {"lower", json_number(known.lower)},
                       {"upper", json_number(known.upper)},
                       {"unit", unit}});
  };
  add(device.held ? "mass with the hand" : "mass", found.mass_kg, units.mass());
  add("viscous friction", found.viscous_n_s_per_m, units.damping());
  add("Coulomb friction", found.coulomb_n, units.force());
  for (std::size_t place = 0; place < found.offset_n.size(); ++place) {
    add(found.offset_n.size() > 1
            ? fmt::format("constant force at {:.3g} {}", of.measured.places_m[place], way)
            : std::string("constant force"),
        found.offset_n[place], units.force());
  }
  add(device.held ? "stiffness of the hand" : "stiffness", found.stiffness_n_per_m, units.stiffness());
  add("delay", found.delay_s, "s");
  add("jitter of the delay", found.jitter_s, "s");
  std::optional<Value> step = found.local_step_m;
  if (found.encoder_step_m) {
    step =
        Value{.value = *found.encoder_step_m, .lower = *found.encoder_step_m, .upper = *found.encoder_step_m};
  }
  add("encoder step", step, way);
  add("noise of the velocity", found.velocity_noise_m_s, way + "/s");
  std::optional<Value> corner = found.velocity_corner_rad_s;
  if (corner) {
    for (double* const side : {&corner->value, &corner->lower, &corner->upper})
      *side *= 0.5 / std::numbers::pi;
  }
  add("corner of its filter", corner, "Hz");
  add("motor constant", found.motor_constant, "1");
  add(found.saturation_n
          ? std::string("saturation")
          : fmt::format("saturation: none up to {:.3g} {}", found.largest_force_n, units.force()),
      found.saturation_n, units.force());
  return numbers;
}

json axis_as_json(const IdentifiedDevice& device, const IdentifiedAxis& of) {
  json out{{"name", device.device.axes.at(of.axis).name}, {"problem", of.problem}};
  const identification::Prospect& prospect = of.measured.design.prospect;
  out["experiment"] = layout_as_json(of.measured);
  out["promised"] = nullptr;
  if (prospect.information != 0.0)
    out["promised"] = {{"travel", prospect.travel_m},
                       {"speed", prospect.speed_m_s},
                       {"relative_mass", prospect.relative_mass},
                       {"relative_viscous", prospect.relative_viscous},
                       {"relative_coulomb", prospect.relative_coulomb},
                       {"delay_s", prospect.delay_s},
                       {"information", prospect.information}};
  if (!of.found) return out;
  const Identified& found = *of.found;
  out["mass"] = value_as_json(found.mass_kg);
  out["viscous"] = value_as_json(found.viscous_n_s_per_m);
  out["coulomb"] = value_as_json(found.coulomb_n);
  out["stiffness"] = value_as_json(found.stiffness_n_per_m);
  out["delay_s"] = value_as_json(found.delay_s);
  out["delay_jitter_s"] = value_as_json(found.jitter_s);
  out["constant_force"] = json::array();
  for (const Value& offset : found.offset_n) out["constant_force"].push_back(value_as_json(offset));
  out["encoder_step"] = found.encoder_step_m ? json(*found.encoder_step_m) : json(nullptr);
  out["local_step"] = value_as_json(found.local_step_m);
  out["velocity_noise"] = value_as_json(found.velocity_noise_m_s);
  out["velocity_corner_rad_s"] = value_as_json(found.velocity_corner_rad_s);
  out["motor_constant"] = value_as_json(found.motor_constant);
  out["saturation"] = value_as_json(found.saturation_n);
  out["largest_force"] = found.largest_force_n;
  out["compliance"] = value_as_json(Value{.value = found.compliance_m_per_n,
                                          .lower = found.compliance_m_per_n - found.compliance_half_width,
                                          .upper = found.compliance_m_per_n + found.compliance_half_width});
  json agreements = json::array();
  for (const identification::Agreement& one : found.agreements) {
    agreements.push_back({{"name", one.name},
                          {"difference", json_number(one.difference)},
                          {"standard_error", json_number(one.standard_error)},
                          {"agrees", one.agrees}});
  }
  out["domains"] = std::move(agreements);
  json frequency = json::object();
  constexpr std::array names{"mass", "viscous", "coulomb", "stiffness", "delay_s"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double value =
        identification::value_of(found.frequency.model.axis, identification::all_parameters[i]);
    const double half = found.frequency.half_width(i);
    frequency[names[i]] = value_as_json(Value{.value = value, .lower = value - half, .upper = value + half});
  }
  out["frequency"] = std::move(frequency);
  json response = json::array();
  for (const identification::ResponseLine& line : found.response) {
    response.push_back({{"frequency_hz", line.frequency_hz},
                        {"gain", std::abs(line.response)},
                        {"phase_rad", std::arg(line.response)},
                        {"coherence", json_number(line.coherence.value)},
                        {"coherence_lower", json_number(line.coherence.lower)},
                        {"coherence_upper", json_number(line.coherence.upper)}});
  }
  out["response"] = std::move(response);
  out["residual_rms"] = json_number(found.time.rms_m);
  out["residual_lag_1"] = json_number(found.residual_lag_1);
  out["repeated_rms"] = json_number(found.repeated_m);
  out["validation_error"] = json_number(found.validation_error);
  out["fits"] = found.fits ? json(*found.fits) : json(nullptr);
  out["why_not"] = found.why_not;
  json explanations = json::array();
  for (const identification::Explanation& one : found.explanations) {
    json about{{"name", std::string(identification::name_of(one.missing))}, {"share", one.share}};
    if (one.missing == identification::Missing::backlash) about["kurtosis"] = one.blows;
    explanations.push_back(std::move(about));
  }
  out["explanations"] = std::move(explanations);
  out["missing"] = found.missing ? json(std::string(identification::name_of(*found.missing))) : json(nullptr);
  out["verdict"] = found.verdict;
  out["z_width"] = of.z_width ? of.z_width->json : json(nullptr);
  out["numbers"] = numbers_as_json(device, of);
  out["charts"] = json::array();
  for (const Figure& figure : axis_figures(device, of))
    out["charts"].push_back({{"name", figure.name}, {"figure", chart_to_json(figure.chart)}});
  return out;
}

}  // namespace

bool IdentifiedDevice::is_good() const noexcept {
  return std::ranges::all_of(axes, [](const IdentifiedAxis& axis) {
    return axis.problem.empty() && axis.found && axis.found->fits == true;
  });
}

IdentifiedAxis identified_axis(AxisExperiment measured, std::size_t axis) {
  IdentifiedAxis out;
  out.axis = axis;
  out.problem = measured.problem;
  out.measured = std::move(measured);
  if (out.measured.experiment.lines.empty()) return out;  // not even the pilot was finished
  try {
    out.found = identification::identify(out.measured.experiment);
  } catch (const std::invalid_argument& why) {
    out.problem += fmt::format("{}{}", out.problem.empty() ? "" : "; ", why.what());
  }
  if (out.found && out.found->motor_constant && out.found->motor_constant->upper < 0.0) {
    out.problem += fmt::format("{}the sensor tells the other sign: give its mount sign = -1",
                               out.problem.empty() ? "" : "; ");
    out.found->motor_constant.reset();
  }
  return out;
}

drivers::DeviceModel model_of(const IdentifiedDevice& identified) {
  const schema::Header header = schema::new_header("");
  drivers::DeviceModel model;
  model.kerf = software();
  model.date = header.created;
  model.rate_hz = 1000.0;
  model.held = identified.held;
  model.conditions =
      identified.held ? "held in the hand: mass and friction are those of both" : "free, nobody touched it";
  if (identified.offset == OffsetIs::gravity) model.conditions += "; friction taken for the same both ways";
  model.uri = identified.device.uri;
  model.model = identified.device.model;
  model.serial = identified.device.serial;
  model.port = identified.device.port;
  for (const IdentifiedAxis& axis : identified.axes) model.axes.push_back(axis_model(identified, axis));
  return model;
}

json identified_as_json(const IdentifiedDevice& identified) {
  json axes = json::array();
  for (const IdentifiedAxis& axis : identified.axes) axes.push_back(axis_as_json(identified, axis));
  return {{"device", identified.device.uri},
          {"model", identified.device.model},
          {"simulated", identified.device.simulated},
          {"held", identified.held},
          {"good", identified.is_good()},
          {"axes", std::move(axes)}};
}

std::vector<std::string> identified_lines(const IdentifiedDevice& identified) {
  std::vector<std::string> lines{
      fmt::format("{}  {}; intervals of 95 %", identified.device.uri, identified.device.model)};
  for (const IdentifiedAxis& axis : identified.axes) axis_lines(identified, axis, lines);
  return lines;
}

void write_identified(const IdentifiedDevice& identified, const std::string& name,
                      const std::filesystem::path& folder) {
  const json written = identified_as_json(identified);
  std::vector<Figure> figures;
  for (const IdentifiedAxis& axis : identified.axes) {
    if (!axis.found) continue;
    for (Figure& figure : axis_figures(identified, axis)) figures.push_back(std::move(figure));
  }
  std::vector<Chart> charts;
  for (const Figure& figure : figures) charts.push_back(figure.chart);
  const std::vector<std::string> drawings = draw_all(charts);
  for (std::size_t i = 0; i < figures.size(); ++i)
    write_whole_file(folder / (figures[i].name + ".svg"), drawings[i] + "\n");
  for (const IdentifiedAxis& axis : identified.axes) {
    if (!axis.z_width) continue;
    const std::string& of = identified.device.axes.at(axis.axis).name;
    write_whole_file(folder / (of + "-z-width.csv"), axis.z_width->csv);
  }
  write_whole_file(folder / "identify.html",
                   html_page("Device", "<h1>The device</h1>\n" + identified_body(written)));
  write_json_file(folder / "identify.json", written);
  write_whole_file(folder / (name + ".device.toml"), drivers::to_toml(model_of(identified)));
}

}  // namespace kerf::bench
