#include "own_code/new_law.h"

#include <cctype>
#include <stdexcept>

#include <fmt/format.h>

#include <kerf/models/law.h>

#include "own_code/build_law.h"
#include "own_code/compiler.h"

namespace kerf::bench {
namespace {

constexpr std::string_view header_of_law =
    R"(// A law of our own: 'kerf law build %NAME%.h' makes a plug-in of it.
#pragma once

#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/plugin.h>

/// A spring with dry friction that builds up over a short travel.
///
///     F = k x + Fc z,   dz/dx = (sgn v - z) / xd
///
/// k the stiffness, Fc the friction, xd the travel in which it builds up. Exact for a tick without a reversal.
template <typename T>
struct %TYPE% {
  static constexpr std::string_view name = "%NAME%";
  static constexpr std::string_view equation = "F = k x + Fc z, dz/dx = (sgn v - z) / xd";
  static constexpr std::string_view linear[] = {"stiffness", "coulomb"};  // the force is linear in these
  static constexpr unsigned tells = KERF_TELLS_LOOP;                      // what it shows of a cut

  T stiffness{};   ///< k [N/m]
  T coulomb{};     ///< Fc [N]
  T presliding{};  ///< xd [m], > 0

  /// All that it remembers.
  struct State {
    T slip{0.0};  ///< z
    double penetration = 0.0;
    bool started = false;
  };

  static std::vector<kerf::models::ParameterInfo> parameters(const kerf::models::Options&) {
    using kerf::models::Quantity;
    using kerf::models::Scale;
    return {{"stiffness", Quantity::stiffness, 0.0, 1e6, Scale::linear, "k, force per depth"},
            {"coulomb", Quantity::force, 0.0, 1e3, Scale::linear, "Fc, dry friction"},
            {"presliding", Quantity::position, 1e-7, 1.0, Scale::logarithmic, "xd, travel of its rise"}};
  }
  /// Where a fit begins, and what is rendered before there is one.
  static std::vector<double> initial() { return {100.0, 0.1, 1e-3}; }
  static %TYPE% make(std::span<const T> values, const kerf::models::Options&) {
    return {values[0], values[1], values[2]};
  }

  T step(State& state, const kerf::models::Motion& motion, double /*period_s*/) const {
    using std::exp;
    const double travel = state.started ? motion.penetration - state.penetration : 0.0;
    state.started = true;
    state.penetration = motion.penetration;
    if (travel != 0.0) {
      const double sign = travel > 0.0 ? 1.0 : -1.0;
      state.slip = sign + (state.slip - sign) * exp(-std::abs(travel) / presliding);
    }
    return stiffness * motion.penetration + coulomb * state.slip;
  }
};

KERF_LAW(%TYPE%);
)";

constexpr std::string_view test_of_law =
    R"(// What is true of the law, whatever its numbers: a program that ends with 0 where it holds.
#include <cmath>
#include <cstdio>
#include <vector>

#include "%NAME%.h"

int main() {
  const std::vector<double> values{300.0, 0.5, 1e-4};
  const auto law = %TYPE%<double>::make(values, {});
  %TYPE%<double>::State state;
  double force = 0.0;
  for (int i = 0; i <= 100; ++i) force = law.step(state, {1e-4 * i, 0.1}, 1e-3);
  const double closing = 300.0 * 0.01 + 0.5;  // spring and friction, 100 times xd after the turn
  if (!(std::abs(force - closing) < 1e-9)) return std::printf("closing: %g, expected %g\n", force, closing), 1;
  for (int i = 99; i >= 0; --i) force = law.step(state, {1e-4 * i, -0.1}, 1e-3);
  if (!(std::abs(force + 0.5) < 1e-9)) return std::printf("opening: %g, expected -0.5\n", force), 1;
  return 0;
}
)";

constexpr std::string_view cmake_of_law =
    R"(# For who builds the law within a project; 'kerf law build %NAME%.h' needs none of it.
cmake_minimum_required(VERSION 3.25)
project(%NAME% LANGUAGES CXX)
set(KERF_INCLUDE "%INCLUDE%" CACHE PATH "The folder with kerf/law.h")

file(CONFIGURE OUTPUT %NAME%.cpp CONTENT "#include \"%NAME%.h\"\n")
add_library(%NAME% MODULE ${CMAKE_CURRENT_BINARY_DIR}/%NAME%.cpp)
set_target_properties(%NAME% PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden)
target_compile_definitions(%NAME% PRIVATE KERF_BUILD_LAW)

enable_testing()
add_executable(%NAME%_test %NAME%_test.cpp)
add_test(NAME %NAME% COMMAND %NAME%_test)
foreach(target %NAME% %NAME%_test)
  target_compile_features(${target} PRIVATE cxx_std_20)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${KERF_INCLUDE})
endforeach()
)";

/// "my_law" is MyLaw.
std::string type_of(std::string_view name) {
  std::string type;
  bool begins = true;
  for (const char c : name) {
    if (c != '_') type += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    begins = c == '_';
  }
  return type;
}

std::string with_names(std::string_view text, std::string_view name, const std::string& include) {
  return filled_in(text, {{"INCLUDE", include}, {"TYPE", type_of(name)}, {"NAME", std::string(name)}});
}

}  // namespace

NewLaw new_law(std::string_view name) {
  require_name(name, "a law");
  for (const models::LawInfo& law : models::registry()) {
    if (law.name == name)
      throw std::invalid_argument(fmt::format("'{}' is a law of Kerf's own; give yours another name", name));
  }
  const std::string include = headers_for_laws().string();
  return {.header = with_names(header_of_law, name, include),
          .test = with_names(test_of_law, name, include),
          .cmake = with_names(cmake_of_law, name, include)};
}

}  // namespace kerf::bench
