#include "calibrate/loads_script.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "files/named_file.h"

namespace kerf::bench {
namespace {

using Vector3 = Eigen::Vector3d;

/// Limits of a tolerance as a standard deviation: any value between is as likely.
double deviation_of_limits(double tolerance) { return tolerance / std::numbers::sqrt3; }

struct Piece {
  std::string name;
  double mass_kg = 0.0;
  double tolerance_kg = 0.0;
};

/// What pushes in one step: pieces of mass, or a force [N], or a torque [N·m].
struct Push {
  std::vector<Piece> pieces;
  double force_n = 0.0;
  double torque_n_m = 0.0;
  double tolerance = 0.0;  ///< of force or torque, in shares
};

struct Placement {
  std::string name;
  Vector3 direction = Vector3::Zero();
  Vector3 point = Vector3::Zero();
  double direction_tolerance = 0.0;  ///< [rad]
  double point_tolerance = 0.0;      ///< [m]
};

class ScriptReader {
 public:
  ScriptReader(const toml::table& root, const std::string& file) : root_(root), file_(file) {}

  LoadScript read(const GravityOption& option) {
    allow_only(root_,
               {"serial_number", "provenance", "capacity", "gravity", "tolerance", "weights", "series"},
               "a script of loads");
    script_.serial_number = root_["serial_number"].value_or(std::string());
    script_.provenance = root_["provenance"].value_or(std::string());
    if (root_.contains("capacity")) {
      const std::vector<double> six = numbers(root_, "capacity");
      if (six.size() != 6) refuse("'capacity' must be six numbers: fx, fy, fz [N], tx, ty, tz [N·m]");
      script_.capacity = Eigen::Map<const Wrench>(six.data());
    }
    if (root_.contains("gravity")) script_.gravity = number(root_, "gravity");
    if (option.gravity) script_.gravity = *option.gravity;
    script_.knows_gravity = option.gravity || root_.contains("gravity");
    if (!(script_.gravity > 9.0 && script_.gravity < 10.0))
      refuse("'gravity' must be that of the place, 9.78 to 9.84 m/s²");
    tolerance_ = root_.contains("tolerance") ? number(root_, "tolerance") : 0.0;
    if (!(tolerance_ >= 0.0 && tolerance_ < 0.5)) refuse("'tolerance' must be a share of each load: 0.001");
    read_weights();
    const toml::array* series = root_["series"].as_array();
    if (series == nullptr || series->empty()) refuse("there is no load: it needs a [[series]]");
    for (const toml::node& one : *series) {
      if (!one.is_table()) refuse("'series' must be tables: [[series]]");
      read_series(*one.as_table());
    }
    return std::move(script_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw std::invalid_argument(fmt::format("{}: {}", file_, what));
  }

  void allow_only(const toml::table& table, std::initializer_list<std::string_view> keys,
                  std::string_view where) const {
    for (const auto& [key, node] : table) {
      if (std::ranges::find(keys, key.str()) == keys.end())
        refuse(fmt::format("unknown key '{}' in {}; known are {}", key.str(), where, fmt::join(keys, ", ")));
    }
  }

  double finite(const toml::node& node, std::string_view key) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value)) refuse(fmt::format("'{}' must be a finite number", key));
    return *value;
  }
  double number(const toml::table& table, std::string_view key) const { return finite(*table.get(key), key); }
  double number_or(const toml::table& table, std::string_view key, double standard) const {
    return table.contains(key) ? number(table, key) : standard;
  }
  std::vector<double> numbers(const toml::table& table, std::string_view key) const {
    const toml::array* array = table.get(key)->as_array();
    if (array == nullptr) refuse(fmt::format("'{}' must be a list of numbers", key));
    std::vector<double> all;
    for (const toml::node& one : *array) all.push_back(finite(one, key));
    return all;
  }
  Vector3 three(const toml::table& table, std::string_view key) const {
    const std::vector<double> all = numbers(table, key);
    if (all.size() != 3) refuse(fmt::format("'{}' must be three numbers, x, y, z of the sensor", key));
    return {all[0], all[1], all[2]};
  }

  Piece piece(std::string name, double mass_kg, double tolerance_kg) const {
    if (!(mass_kg > 0.0)) refuse(fmt::format("the mass of {} must be more than 0", name));
    return {.name = std::move(name), .mass_kg = mass_kg, .tolerance_kg = tolerance_kg};
  }

  void read_weights() {
    const toml::table* weights = root_["weights"].as_table();
    if (weights == nullptr) return;
    for (const auto& [key, node] : *weights) {
      const std::string name(key.str());
      const toml::table* table = node.as_table();
      if (table == nullptr)
        refuse(fmt::format("weight '{}' must be a table: {{ mass_g = 500.0, tolerance_g = 0.1 }}", name));
      allow_only(*table, {"mass_kg", "mass_g", "tolerance_kg", "tolerance_g"},
                 fmt::format("weight '{}'", name));
      if (table->contains("mass_kg") == table->contains("mass_g"))
        refuse(fmt::format("weight '{}' needs one of mass_kg and mass_g", name));
      const double mass =
          table->contains("mass_kg") ? number(*table, "mass_kg") : 1e-3 * number(*table, "mass_g");
      const double limits = table->contains("tolerance_kg")  ? number(*table, "tolerance_kg")
                            : table->contains("tolerance_g") ? 1e-3 * number(*table, "tolerance_g")
                                                             : tolerance_ * mass;
      weights_.emplace(name, piece("weight " + name, mass, limits));
    }
  }

  /// The pushes of a series, in the order in which they are put on.
  std::vector<Push> pushes_of(const toml::table& table, const std::string& name) const {
    std::vector<Push> pushes;
    int kinds = 0;
    for (const auto& [key, factor] : {std::pair{"masses_kg", 1.0}, std::pair{"masses_g", 1e-3}}) {
      if (!table.contains(key)) continue;
      ++kinds;
      for (const double one : numbers(table, key)) {
        const double mass = factor * one;
        pushes.push_back({.pieces = {piece(fmt::format("{:.6g} kg", mass), mass, tolerance_ * mass)}});
      }
    }
    for (const char* key : {"forces_n", "torques_n_m"}) {
      if (!table.contains(key)) continue;
      ++kinds;
      for (const double one : numbers(table, key)) {
        Push push{.pieces = {}, .tolerance = tolerance_};
        (std::string_view(key) == "forces_n" ? push.force_n : push.torque_n_m) = one;
        pushes.push_back(push);
      }
    }
    if (const toml::array* list = table["weights"].as_array()) {
      ++kinds;
      for (const toml::node& one : *list) pushes.push_back(weights_of(one, name));
    }
    if (kinds != 1 || pushes.empty())
      refuse(fmt::format("series '{}' needs one of masses_kg, masses_g, weights, forces_n and torques_n_m",
                         name));
    return pushes;
  }

  /// "a+b".
  Push weights_of(const toml::node& node, const std::string& series) const {
    Push push;
    const std::string all = node.value_or(std::string());
    std::string_view rest = all;
    while (!rest.empty()) {
      const auto end = std::min(rest.find('+'), rest.size());
      const auto found = weights_.find(std::string(rest.substr(0, end)));
      if (found == weights_.end())
        refuse(fmt::format("series '{}' has the weight '{}', which is not in [weights]", series,
                           rest.substr(0, end)));
      push.pieces.push_back(found->second);
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    if (push.pieces.empty()) refuse(fmt::format("a weight of series '{}' must be a text: \"a+b\"", series));
    return push;
  }

  Placement placement_of(const toml::table& table, const std::string& name) const {
    Placement placement{.name = name};
    if (table.contains("direction") == table.contains("orientation_deg"))
      refuse(fmt::format("series '{}' needs one of direction and orientation_deg", name));
    if (table.contains("direction")) {
      placement.direction = three(table, "direction");
      if (!(placement.direction.norm() > 0.0)) refuse(fmt::format("the direction of series '{}' is 0", name));
    } else {
      const Vector3 turn = three(table, "orientation_deg") * std::numbers::pi / 180.0;
      const double angle = turn.norm();
      const Eigen::AngleAxisd rotation(angle, angle > 0.0 ? Vector3(turn / angle) : Vector3::UnitX());
      placement.direction = rotation.inverse() * Vector3(0.0, 0.0, -1.0);
    }
    placement.direction.normalize();
    if (table.contains("point_m")) placement.point = three(table, "point_m");
    placement.direction_tolerance =
        number_or(table, "direction_tolerance_deg", 0.0) * std::numbers::pi / 180.0;
    placement.point_tolerance = number_or(table, "point_tolerance_m", 0.0);
    return placement;
  }

  static Wrench at_point(const Vector3& force, const Vector3& point) {
    Wrench wrench;
    wrench << force, point.cross(force);
    return wrench;
  }

  /// The load of a push and what is not known of it.
  LoadStep step_of(const Push& push, const Placement& place) const {
    LoadStep step{.number = 0, .series = place.name, .words = {}};
    double force = push.force_n;
    for (const Piece& one : push.pieces) force += one.mass_kg * script_.gravity;
    step.load = at_point(force * place.direction, place.point);
    step.load.tail<3>() += push.torque_n_m * place.direction;
    const auto add = [&](std::string source, const Wrench& effect) {
      if (effect.norm() > 0.0) step.errors.push_back({.source = std::move(source), .effect = effect});
    };
    const Wrench per_newton = at_point(place.direction, place.point);
    double weight = 0.0;
    for (const Piece& one : push.pieces) {
      add(one.name, per_newton * script_.gravity * deviation_of_limits(one.tolerance_kg));
      weight += one.mass_kg * script_.gravity;
    }
    if (!script_.knows_gravity) add("gravity", per_newton * weight * deviation_of_limits(gravity_span));
    add(fmt::format("load {:.6g} N, {:.6g} N·m", push.force_n, push.torque_n_m),
        push.pieces.empty() ? Wrench(step.load * deviation_of_limits(push.tolerance))
                            : Wrench(Wrench::Zero()));
    const Vector3 across = place.direction.unitOrthogonal();
    for (const auto& [name, way] :
         {std::pair<const char*, Vector3>{"first", across},
          std::pair<const char*, Vector3>{"second", place.direction.cross(across)}}) {
      Wrench turned = at_point(force * way, place.point);
      turned.tail<3>() += push.torque_n_m * way;
      add(fmt::format("{} turn of {}", name, place.name),
          turned * deviation_of_limits(place.direction_tolerance));
    }
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      Wrench moved = Wrench::Zero();
      moved.tail<3>() =
          (Vector3::Unit(axis) * deviation_of_limits(place.point_tolerance)).cross(force * place.direction);
      add(fmt::format("place {} of {}", axis, place.name), moved);
    }
    step.words = words_of(push, place);
    return step;
  }

  static std::string words_of(const Push& push, const Placement& place) {
    std::string text;
    double mass = 0.0;
    for (const Piece& one : push.pieces) mass += one.mass_kg;
    if (mass > 0.0) text = fmt::format("{:.6g} kg", mass);
    if (push.force_n != 0.0) text = fmt::format("{:.6g} N", push.force_n);
    if (push.torque_n_m != 0.0) text = fmt::format("{:.6g} N·m", push.torque_n_m);
    text += fmt::format(" {} {:.3g}, {:.3g}, {:.3g}", push.torque_n_m != 0.0 ? "about" : "along",
                        place.direction.x(), place.direction.y(), place.direction.z());
    if (place.point.norm() > 0.0)
      text += fmt::format(" at {:.4g}, {:.4g}, {:.4g} mm", 1e3 * place.point.x(), 1e3 * place.point.y(),
                          1e3 * place.point.z());
    return text;
  }

  void require_within_capacity(const LoadStep& step) const {
    if (!script_.capacity) return;
    const Eigen::Array<double, 6, 1> shares = step.load.array().abs() / script_.capacity->array().abs();
    Eigen::Index most = 0;
    if (const double share = shares.maxCoeff(&most); share > 1.2) {
      refuse(
          fmt::format("series '{}': {} is {:.3g} times the capacity along {}; were grams given as kilograms?",
                      step.series, step.words, share,
                      std::array{"fx", "fy", "fz", "tx", "ty", "tz"}.at(static_cast<std::size_t>(most))));
    }
  }

  void read_series(const toml::table& table) {
    const std::size_t number_of_series = ++series_count_;
    const std::string name = table["name"].value_or(fmt::format("{}", number_of_series));
    allow_only(
        table,
        {"name", "direction", "orientation_deg", "point_m", "direction_tolerance_deg", "point_tolerance_m",
         "masses_kg", "masses_g", "weights", "forces_n", "torques_n_m", "unload", "hold_s"},
        fmt::format("series '{}'", name));
    const Placement place = placement_of(table, name);
    const std::vector<Push> pushes = pushes_of(table, name);
    // A sensor that is turned over feels what is mounted on it another way in every series.
    const std::size_t tare = table.contains("orientation_deg") ? ++turned_count_ : 0;
    const double hold_s = number_or(table, "hold_s", 2.0);
    if (!(hold_s >= 0.1 && hold_s <= 3600.0))
      refuse(fmt::format("hold_s of series '{}' must be 0.1 to 3600 s", name));
    const auto add = [&](LoadStep step) {
      step.series = name;
      step.placement = number_of_series;
      step.tare = tare;
      step.hold_s = hold_s;
      const std::string key = fmt::format("{}", fmt::join(step.load.data(), step.load.data() + 6, " "));
      step.load_number =
          step.load.norm() > 0.0 ? load_numbers_.emplace(key, load_numbers_.size() + 1).first->second : 0;
      step.number = script_.steps.size() + 1;
      require_within_capacity(step);
      script_.steps.push_back(std::move(step));
    };
    const LoadStep nothing{.number = 0, .series = name, .words = "nothing on it"};
    add(nothing);
    for (const Push& one : pushes) add(step_of(one, place));
    if (table["unload"].value_or(true)) {
      for (auto one = pushes.rbegin() + 1; one != pushes.rend(); ++one) add(step_of(*one, place));
    }
    add(nothing);
  }

  const toml::table& root_;
  const std::string& file_;
  LoadScript script_;
  double tolerance_ = 0.0;
  std::map<std::string, Piece> weights_;
  std::map<std::string, std::size_t> load_numbers_;
  std::size_t series_count_ = 0;
  std::size_t turned_count_ = 0;
};

/// Tares from 0 without gaps.
void renumber_tares(LoadScript& script) {
  std::map<std::size_t, std::size_t> numbers;
  for (LoadStep& step : script.steps) step.tare = numbers.emplace(step.tare, numbers.size()).first->second;
}

}  // namespace

LoadScript read_load_script(const std::string& file, const GravityOption& option) {
  const std::string text = read_named_file(file);
  try {
    const toml::table root = toml::parse(text, file);
    LoadScript script = ScriptReader(root, file).read(option);
    renumber_tares(script);
    return script;
  } catch (const toml::parse_error& error) {
    throw std::invalid_argument(
        fmt::format("{}:{}: {}", file, error.source().begin.line, error.description()));
  }
}

Eigen::MatrixXd load_errors(const std::vector<const LoadStep*>& steps,
                            const std::vector<std::size_t>& components) {
  std::map<std::string, Eigen::Index> sources;
  for (const LoadStep* step : steps) {
    for (const LoadError& one : step->errors)
      sources.emplace(one.source, static_cast<Eigen::Index>(sources.size()));
  }
  const auto count = static_cast<Eigen::Index>(components.size());
  Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(steps.size()) * count,
                                                 static_cast<Eigen::Index>(sources.size()));
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (const LoadError& one : steps[i]->errors) {
      for (std::size_t k = 0; k < components.size(); ++k)
        errors(static_cast<Eigen::Index>(i) * count + static_cast<Eigen::Index>(k), sources.at(one.source)) +=
            one.effect(static_cast<Eigen::Index>(components[k]));
    }
  }
  return errors;
}

}  // namespace kerf::bench
