#include "scene/scalpel_paths.h"

#include <numbers>

namespace kerf::bench {
namespace {

constexpr double hand_height_m = 0.10;
constexpr double travel_m = 0.04;
constexpr double turn_rad = std::numbers::pi / 3.0;

}  // namespace

std::vector<drivers::PoseKeyframe> scalpel_t1() {
  return {{0.0, {0.0, 0.0, hand_height_m}},
          {0.8, {0.0, -travel_m, hand_height_m}},
          {1.0, {0.0, -travel_m, hand_height_m}},
          {1.8, {travel_m, -travel_m, hand_height_m}}};
}

std::vector<drivers::PoseKeyframe> scalpel_t2() {
  return {{0.0, {0.0, 0.0, hand_height_m}},
          {1.0, {0.0, 0.0, hand_height_m, 0.0, 0.0, turn_rad}},
          {1.2, {0.0, 0.0, hand_height_m, 0.0, 0.0, turn_rad}},
          {2.2, {0.0, 0.0, hand_height_m}}};
}

}  // namespace kerf::bench
