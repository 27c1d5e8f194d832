#include "kerf/drivers/pose_path.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <sstream>
#include <utility>

#include "kerf/drivers/hand.h"

namespace kerf::drivers {
namespace {

struct UnitOfText {
  std::string_view name;
  double factor;
};
constexpr std::array<UnitOfText, 1> times{{{"s", 1.0}}};
constexpr std::array<UnitOfText, 2> lengths{{{"mm", 1e-3}, {"m", 1.0}}};
constexpr std::array<UnitOfText, 2> angles{{{"deg", std::numbers::pi / 180.0}, {"rad", 1.0}}};

[[noreturn]] void refuse_keyframe(std::string_view keyframe) {
  throw DeviceError("keyframe '" + std::string(keyframe) +
                    "': expected TIME:X:Y:Z:RX:RY:RZ, joined by ',', such as 0.8s:0:-40:100mm:0:0:30deg");
}

/// Takes numbers with ':' between them, and their unit, off the front of a text.
bool take(std::string_view& text, std::span<double> numbers, std::span<const UnitOfText> units) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0 && !text.starts_with(':')) return false;
    if (i > 0) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), numbers[i]);
    if (error != std::errc{} || !(std::abs(numbers[i]) <= 1e6)) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
  const std::string_view name = text.substr(0, text.find(':'));
  const auto* unit = std::find_if(units.data(), units.data() + units.size(),
                                  [&](const UnitOfText& one) { return one.name == name; });
  if (unit == units.data() + units.size()) return false;
  for (double& number : numbers) number *= unit->factor;
  text.remove_prefix(name.size());
  return true;
}

PoseKeyframe parse_keyframe(const std::string_view whole) {
  std::string_view text = whole;
  PoseKeyframe keyframe;
  const auto colon = [&] {
    if (!text.starts_with(':')) refuse_keyframe(whole);
    text.remove_prefix(1);
  };
  if (!take(text, {&keyframe.at_s, 1}, times)) refuse_keyframe(whole);
  colon();
  if (!take(text, {keyframe.position.data(), 3}, lengths)) refuse_keyframe(whole);
  colon();
  if (!take(text, {keyframe.position.data() + 3, 3}, angles) || !text.empty()) refuse_keyframe(whole);
  return keyframe;
}

std::string digits_of(double number) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
  return {buffer.data(), end};
}

}  // namespace

PosePath::PosePath(Options options) : options_(std::move(options)) {
  const auto& keyframes = options_.keyframes;
  if (keyframes.empty() || keyframes.front().at_s != 0.0) {
    throw DeviceError("the first keyframe of a path must be at 0 s");
  }
  const auto early = std::adjacent_find(keyframes.begin(), keyframes.end(),
                                        [](const auto& a, const auto& b) { return !(a.at_s < b.at_s); });
  if (early != keyframes.end()) {
    std::ostringstream message;
    message << "the keyframe at " << std::next(early)->at_s << " s comes after one at " << early->at_s
            << " s; each must be later than the one before";
    throw DeviceError(message.str());
  }
  if (options_.repeat && keyframes.front().position != keyframes.back().position) {
    throw DeviceError("a path that repeats must end at the pose at which it begins");
  }
}

PosePath::Equilibrium PosePath::at(double time_s) const noexcept {
  const auto& keyframes = options_.keyframes;
  const double length_s = keyframes.back().at_s;
  if (options_.repeat && length_s > 0.0) time_s -= length_s * std::floor(std::max(0.0, time_s) / length_s);
  const auto next = std::upper_bound(keyframes.begin(), keyframes.end(), time_s,
                                     [](double time, const PoseKeyframe& one) { return time < one.at_s; });
  if (next == keyframes.begin()) return {.position = keyframes.front().position, .velocity = {}};
  const PoseKeyframe& from = *std::prev(next);
  if (next == keyframes.end()) return {.position = from.position, .velocity = {}};
  const double stroke_s = next->at_s - from.at_s;
  const MinimumJerk motion = MinimumJerk::at((time_s - from.at_s) / stroke_s);
  Equilibrium wish;
  for (std::size_t axis = 0; axis < max_axes; ++axis) {
    const double travel = next->position[axis] - from.position[axis];
    wish.position[axis] = from.position[axis] + motion.position * travel;
    wish.velocity[axis] = motion.speed / stroke_s * travel;
  }
  return wish;
}

std::vector<PoseKeyframe> parse_keyframes(std::string_view text) {
  std::vector<PoseKeyframe> keyframes;
  while (true) {
    const auto comma = std::min(text.find(','), text.size());
    keyframes.push_back(parse_keyframe(text.substr(0, comma)));
    if (comma == text.size()) return keyframes;
    text.remove_prefix(comma + 1);
  }
}

std::string to_text(const std::vector<PoseKeyframe>& keyframes) {
  std::ostringstream text;
  for (const PoseKeyframe& keyframe : keyframes) {
    text << (&keyframe == keyframes.data() ? "" : ",") << digits_of(keyframe.at_s) << 's';
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
      text << ':' << digits_of(keyframe.position[axis]) << (axis == 2 ? "m" : "");
    }
    text << "rad";
  }
  return text.str();
}

}  // namespace kerf::drivers
