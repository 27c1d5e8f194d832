#pragma once

#include <cstddef>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace kerf::models {

/// What a parameter measures. The first ones follow the axis, so that one law serves forces over depth [m]
/// and over an angle [rad]; the others have the same unit everywhere.
enum class Quantity {
  force,
  position,
  velocity,
  stiffness,
  damping,
  ratio,
  length,             ///< m
  mass,               ///< kg
  time,               ///< s
  angular_frequency,  ///< 1/s
  torque,             ///< N·m
  energy,             ///< J
  toughness,          ///< J/m²
  load,               ///< N, whatever the axis measures
  spring,             ///< N/m
  dashpot,            ///< N·s/m
  joint_damping,      ///< N·m·s/rad
  edge_damping,       ///< N·s/m², viscous force per length of an edge and speed
  surface_damping,    ///< N·s/m³, per area and speed
  edge_stiffness,     ///< N/m²
  surface_stiffness,  ///< N/m³
};

/// The unit of a quantity on an axis: `unit_of(Quantity::stiffness, "N", "rad")` is "N/rad".
[[nodiscard]] std::string unit_of(Quantity quantity, std::string_view force_unit,
                                  std::string_view position_unit);

/// How a parameter is searched: a logarithmic one is positive and may span decades.
enum class Scale { linear, logarithmic };

/// One parameter of a law: its name in law files, what it measures, and the range a law accepts.
struct ParameterInfo {
  std::string name;
  Quantity quantity = Quantity::ratio;
  double lower = 0.0;  ///< smallest value accepted, inclusive
  double upper = 0.0;  ///< largest value accepted, inclusive
  Scale scale = Scale::linear;
  std::string meaning;
};

/// A setting of a law that is chosen and not fitted: an integrator, a table's grid, a ramp band.
using OptionValue = std::variant<bool, double, std::string>;
using Options = std::map<std::string, OptionValue, std::less<>>;

/// One option of a law, with the value that it has when a law file does not name it.
struct OptionInfo {
  std::string name;
  OptionValue standard;
  std::string meaning;
};

/// In which scalars a law of the scalar T reckons with what is no parameter.
template <typename T>
struct Scalars {
  using Input = std::conditional_t<std::is_same_v<T, float>, float, double>;
  using Signal = double;
  static constexpr bool single = std::is_same_v<T, float>;
};
/// Its inputs and its numbers beside parameters: single precision stays single; a dual number meets doubles.
template <typename T>
using Input = typename Scalars<T>::Input;
/// The motion and the time themselves, and what a law remembers of them: doubles, whatever T is, but for a
/// law that is written out for other programs (kerf/traced/traced.h), which has to see them.
template <typename T>
using Signal = typename Scalars<T>::Signal;

/// The option of a law that can be rendered in single precision; its parameters are fitted in double anyhow.
[[nodiscard]] inline OptionInfo precision_option() {
  return {"precision", std::string("double"), "of the arithmetic of a tick: double or float"};
}

/// Reads the options that a law knows, and refuses the others.
///
/// Each accessor throws std::invalid_argument if the option has another type than asked for.
class OptionReader {
 public:
  /// @throws std::invalid_argument for an option that is not in `known`.
  OptionReader(std::string_view model, const std::vector<OptionInfo>& known, const Options& given);

  [[nodiscard]] double number(std::string_view name, double lower, double upper) const;
  [[nodiscard]] bool flag(std::string_view name) const;
  [[nodiscard]] std::string text(std::string_view name) const;
  /// A text that is one of those allowed.
  [[nodiscard]] std::string choice(std::string_view name,
                                   std::initializer_list<std::string_view> allowed) const;
  /// A whole number.
  [[nodiscard]] std::size_t count(std::string_view name, std::size_t lower, std::size_t upper) const;

 private:
  const OptionValue& value(std::string_view name) const;

  std::string model_;
  Options values_;
};

}  // namespace kerf::models
