#include "judge/stability_options.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

namespace kerf::bench {
namespace {

using enum StabilityMode;

constexpr std::array mode_names{"virtual walls", "a law",         "--plane", "--several",
                                "--z-width",     "--controllers", "--cases"};

std::string name_of(StabilityMode mode) { return mode_names.at(static_cast<std::size_t>(mode)); }

/// Options, and the studies that they say something to.
struct Use {
  std::vector<const char*> options;
  std::vector<StabilityMode> of;
};

/// Of those that all studies take nothing is said.
std::vector<Use> uses() {
  return {{{"--depth", "--speed", "--along"}, {law}},
          {{"--from"}, {law, several}},
          {{"--wall"}, {plane, controllers}},
          {{"--across", "--wall-damping", "--rotation", "--drags"}, {several}},
          {{"--seconds", "--push"}, {walls}},
          {{"--boundaries"}, {walls, plane}},
          {{"--stiffness"}, {walls, several, z_width, controllers}},
          {{"--damping"}, {walls, z_width, controllers}},
          {{"--felt", "--strike", "--stop-at", "--rungs", "--repeats", "--resolution", "--false-alarms"},
           {z_width, controllers}},
          {{"--model-error"}, {z_width}},
          {{"--hand-sensor"}, {controllers}},
          {{"--cells"}, {walls, law, plane, several}},
          {{"--device", "--device-model", "--axis", "--mass", "--viscous", "--coulomb", "--encoder"},
           {walls, law, plane, z_width, controllers}},
          {{"--rate", "--filter", "--delay", "--grip", "--hand-mass", "--hand-damping", "--hand-stiffness"},
           {walls, law, plane, several, z_width, controllers}}};
}

std::string in_words(const std::vector<StabilityMode>& modes) {
  std::vector<std::string> words;
  for (const StabilityMode mode : modes) words.push_back(name_of(mode));
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

void refuse_idle_options(const RefuseIdle& refuse, StabilityMode mode) {
  for (const Use& use : uses()) {
    if (std::ranges::find(use.of, mode) == use.of.end())
      refuse(use.options, name_of(mode), "it is for " + in_words(use.of));
  }
}

}  // namespace kerf::bench
