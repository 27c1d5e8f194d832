#pragma once

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "protocol/protocol.h"

namespace kerf::test {

/// The text of a law by the name of its file: "soft", "stiff" and "third" lie on theta, "linear" on x_s,
/// "spatial" brings axes of its own, "tight" has its order of 0.5 near the largest there is, 1, and the
/// offset of "still" is 0.
inline std::string law_called(const std::string& name) {
  const auto kelvin = [](std::string_view axis, std::string_view unit, double stiffness) {
    return fmt::format(R"(model = "kelvin"
axis = "{0}"
position_unit = "{1}"
force_unit = "N"
contact = {{ position = {{ value = 0.5, unit = "{1}" }}, direction = "decreasing" }}
[parameters]
parallel_stiffness = {{ value = {2}, unit = "N/{1}" }}
series_stiffness = {{ value = 7, unit = "N/{1}" }}
damping = {{ value = 2, unit = "N·s/{1}" }}
)",
                       axis, unit, stiffness);
  };
  if (name == "soft.law.toml") return kelvin("theta", "rad", 2.0);
  if (name == "stiff.law.toml") return kelvin("theta", "rad", 8.0);
  if (name == "third.law.toml") return kelvin("theta", "rad", 12.0);
  if (name == "linear.law.toml") return kelvin("x_s", "m", 8.0);
  if (name == "spatial.law.toml") {
    return R"(model = "scissors"
[parameters]
pivot_torque = { value = 0.003, unit = "N·m" }
blade_friction = { value = 0.4, unit = "N" }
cutting_force = { value = 6, unit = "N" }
edge_stiffness = { value = 1000, unit = "N/m" }
largest_force = { value = 2, unit = "N" }
)";
  }
  if (name == "tight.law.toml") {
    return R"(model = "springpot"
axis = "theta"
position_unit = "rad"
force_unit = "N"
[parameters]
stiffness = { value = 1, unit = "N/rad" }
fractional_stiffness = { value = 8, unit = "N/rad" }
order = { value = 0.5, unit = "1" }
[fidelity]
reference_time = 2
)";
  }
  if (name == "still.law.toml") {
    return R"(model = "friction"
axis = "theta"
position_unit = "rad"
force_unit = "N"
[parameters]
offset = { value = 0, unit = "N" }
stiffness = { value = 2, unit = "N/rad" }
viscosity = { value = 0.3, unit = "N·s/rad" }
coulomb = { value = 0.8, unit = "N" }
presliding = { value = 0.005, unit = "rad" }
)";
  }
  throw std::invalid_argument(fmt::format("there is no file {}", name));
}

/// What the file says that all of these tests start from: two samples on one tissue.
inline std::string protocol_text(std::string_view top, std::string_view tables = "") {
  return fmt::format(R"(name = "two laws"
question = "Which felt more like cutting?"
{}
[[sample]]
name = "soft"
law = "soft.law.toml"
[[sample]]
name = "stiff"
law = "stiff.law.toml"
{})",
                     top, tables);
}

/// Of a design of levels: one sample.
inline std::string level_text(std::string_view top, std::string_view scale, std::string_view law = "soft") {
  return fmt::format(R"(name = "levels"
question = "Which felt stiffer?"
{}
[[sample]]
name = "{}"
law = "{}.law.toml"
[scale]
{})",
                     top, law, law, scale);
}

inline bench::Protocol protocol_from(const std::string& text) {
  return bench::parse_protocol(text, "p.protocol.toml", law_called);
}

/// Two tissues of three and two samples.
inline constexpr const char* two_tissues = R"([[sample]]
name = "third"
law = "third.law.toml"
[[tissue]]
name = "liver"
samples = ["soft", "stiff", "third"]
[[tissue]]
name = "skin"
samples = ["third", "soft"]
)";

/// The example of every design in examples/sessions.
inline constexpr std::initializer_list<const char*> example_protocols{
    "preference",     "abx",    "2ifc",      "3ifc",  "constant", "staircase", "quest",
    "same-different", "yes-no", "magnitude", "rating"};
/// And of a hand that is led.
inline constexpr const char* guided_example = "guided";
/// And of ways to choose levels that have no design of their own.
inline constexpr std::initializer_list<const char*> adaptive_examples{"interleaved", "psi-marginal"};

inline bench::Protocol example_protocol(const std::string& name) {
  return bench::read_protocol(fmt::format("{}/examples/sessions/{}.protocol.toml", KERF_SOURCE_DIR, name));
}

}  // namespace kerf::test
