#include "kerf/drivers/protocols/inverse3.h"

#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

namespace kerf::drivers::inverse3 {
namespace {

using nlohmann::json;

/// {"x": 1, "y": 2, "z": 3}, all finite.
std::optional<std::array<double, 3>> vector_in(const json& parent, const char* key) {
  const auto found = parent.find(key);
  if (found == parent.end() || !found->is_object()) return std::nullopt;
  std::array<double, 3> vector{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto part = found->find(std::string(1, "xyz"[i]));
    if (part == found->end() || !part->is_number()) return std::nullopt;
    vector.at(i) = part->get<double>();
    if (!std::isfinite(vector.at(i))) return std::nullopt;
  }
  return vector;
}

std::optional<bool> flag_in(const json& parent, const char* group, const char* key) {
  const auto found = parent.find(group);
  if (found == parent.end() || !found->is_object()) return std::nullopt;
  const auto flag = found->find(key);
  return flag != found->end() && flag->is_boolean() ? std::optional(flag->get<bool>()) : std::nullopt;
}

std::string text_in(const json& parent, const char* key) {
  const auto found = parent.find(key);
  return found != parent.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// Of the list of a kind.
const json* find_device(const json& list, std::string_view device) {
  if (!list.is_array()) return nullptr;
  for (const json& one : list) {
    if (one.is_object() && (device.empty() || text_in(one, "device_id") == device)) return &one;
  }
  return nullptr;
}

bool button_in(const json& message) {
  for (const char* const kind : {"verse_grip", "wireless_verse_grip"}) {
    const auto grips = message.find(kind);
    if (grips == message.end() || !grips->is_array() || grips->empty() || !grips->front().is_object())
      continue;
    const auto state = grips->front().find("state");
    if (state == grips->front().end() || !state->is_object()) continue;
    if (const auto one = state->find("button"); one != state->end() && one->is_boolean())
      return one->get<bool>();
    if (const auto a = flag_in(*state, "buttons", "a")) return *a;
  }
  return false;
}

}  // namespace

std::optional<Naming> naming_of(std::string_view version) noexcept {
  // The first N.N in it, whatever stands around.
  for (std::size_t at = 0; at < version.size(); ++at) {
    int major = 0;
    int minor = 0;
    const char* const end = version.data() + version.size();
    const auto [dot, no_major] = std::from_chars(version.data() + at, end, major);
    if (no_major != std::errc{} || dot == end || *dot != '.') continue;
    const auto [behind, no_minor] = std::from_chars(dot + 1, end, minor);
    if (no_minor != std::errc{} || major < 0 || minor < 0) continue;
    return major > 3 || (major == 3 && minor >= 5) ? Naming::vector : Naming::values;
  }
  return std::nullopt;
}

std::string order(std::string_view device, const std::array<double, 3>& force_n, Naming naming) {
  const json force{{"x", force_n[0]}, {"y", force_n[1]}, {"z", force_n[2]}};
  const char* const name = naming == Naming::values ? "values" : "vector";
  const json one{{"device_id", device}, {"commands", {{"set_cursor_force", {{name, force}}}}}};
  return json{{"inverse3", json::array({one})}}.dump();
}

std::optional<State> parse(std::string_view text, std::string_view device) {
  if (text.size() > longest_message) return std::nullopt;
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) return std::nullopt;
  const auto list = message.find("inverse3");
  const json* const found = list == message.end() ? nullptr : find_device(*list, device);
  if (found == nullptr) return std::nullopt;
  const auto state = found->find("state");
  if (state == found->end() || !state->is_object()) return std::nullopt;
  const auto position = vector_in(*state, "cursor_position");
  if (!position) return std::nullopt;
  State told{.device = text_in(*found, "device_id"), .position_m = *position};
  told.velocity_m_s = vector_in(*state, "cursor_velocity").value_or(told.velocity_m_s);
  told.force_n = vector_in(*state, "current_cursor_force");
  told.button = button_in(message);
  told.calibrated = flag_in(*found, "status", "calibrated");
  told.in_use = flag_in(*found, "status", "in_use");
  if (const auto config = found->find("config"); config != found->end() && config->is_object()) {
    told.type = text_in(*config, "type");
    told.gravity_compensation = flag_in(*config, "gravity_compensation", "enabled");
  }
  return told;
}

}  // namespace kerf::drivers::inverse3
