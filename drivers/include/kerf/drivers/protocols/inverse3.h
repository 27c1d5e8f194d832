#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// What Haply's Inverse Service says of an Inverse3 over its WebSocket, and is told: JSON, one state for each
/// message. Source: the maker's pages of the service 3.1 to 3.5 and public clients of it; facts of both.
namespace kerf::drivers::inverse3 {

inline constexpr std::uint16_t port = 10001;
/// The largest message that is looked at; one with several devices has some thousand letters.
inline constexpr std::size_t longest_message = 256 * 1024;

/// How a force is named in a message: `values` by the service 3.1 to 3.4, `vector` by its pages of 3.5. It
/// ignores what it does not know, so that the wrong one is no force and no error.
enum class Naming : std::uint8_t { values, vector };
/// By what the service answers to GET /version; nothing where no version is in it.
[[nodiscard]] std::optional<Naming> naming_of(std::string_view version) noexcept;

/// "{"inverse3":[{"device_id":...,"commands":{"set_cursor_force":{...}}}]}"; finite forces [N].
[[nodiscard]] std::string order(std::string_view device, const std::array<double, 3>& force_n, Naming naming);

/// One Inverse3 as a message has it.
struct State {
  std::string device;  ///< its device_id
  std::array<double, 3> position_m{};
  std::array<double, 3> velocity_m_s{};
  std::optional<std::array<double, 3>> force_n;  ///< that the service says to exert
  bool button = false;                           ///< of the first grip that a message has
  // Of the first message, the inventory, alone.
  std::string type;  ///< "inverse3", "inverse3x", "minverse"; empty: not said
  std::optional<bool> calibrated;
  std::optional<bool> in_use;
  std::optional<bool> gravity_compensation;
};
/// The one of that id, or the first where `device` is empty. Nothing for what is no JSON, has no such device,
/// or a position that is no finite number.
[[nodiscard]] std::optional<State> parse(std::string_view message, std::string_view device);

}  // namespace kerf::drivers::inverse3
