#pragma once

#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include <kerf/kerf.h>

namespace kerf::test {

using OpenLaw = std::unique_ptr<kerf_law, decltype(&kerf_law_close)>;
using OpenState = std::unique_ptr<kerf_state, decltype(&kerf_state_destroy)>;

/// `examples/NAME.law.toml`
inline std::string example_file(std::string_view model) {
  return KERF_SOURCE_DIR "/examples/" + std::string(model) + ".law.toml";
}

inline OpenLaw opened(const std::string& file) {
  kerf_law* law = nullptr;
  std::array<char, 512> error{};
  if (kerf_law_open(file.c_str(), &law, error.data(), error.size()) != KERF_OK)
    throw std::runtime_error(error.data());
  return {law, &kerf_law_close};
}

inline OpenLaw parsed(std::string_view text) {
  kerf_law* law = nullptr;
  std::array<char, 512> error{};
  if (kerf_law_parse(text.data(), text.size(), "a law", &law, error.data(), error.size()) != KERF_OK)
    throw std::runtime_error(error.data());
  return {law, &kerf_law_close};
}

inline OpenState state_of(const OpenLaw& law) {
  kerf_state* state = nullptr;
  std::array<char, 512> error{};
  if (kerf_state_create(law.get(), &state, error.data(), error.size()) != KERF_OK)
    throw std::runtime_error(error.data());
  return {state, &kerf_state_destroy};
}

/// A wall of 100 N/m from 0.01 m on, without any memory.
inline constexpr std::string_view wall = R"(model = "friction"
[contact]
position = { value = 10, unit = "mm" }
[parameters]
offset = { value = 0, unit = "N" }
stiffness = { value = 0.1, unit = "N/mm", std_error = 0.002 }
viscosity = { value = 2, unit = "N·s/m" }
coulomb = { value = 0, unit = "N" }
presliding = { value = 0.1, unit = "mm" }
)";

}  // namespace kerf::test
