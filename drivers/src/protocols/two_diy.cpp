#include "kerf/drivers/protocols/two_diy.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace kerf::drivers::two_diy {
namespace {

constexpr std::uint8_t asks_reset = 0;
constexpr std::uint8_t asks_set_up = 1;
constexpr std::uint8_t asks_torque = 2;
constexpr std::uint8_t both_ports = 0b11;

constexpr std::array<Version, 4> all{{{.name = "original",
                                       .made = {.arm_m = 0.05, .forearm_m = 0.07, .between_m = 0.02},
                                       .gain = 0.1,
                                       .counts_backwards = {false, false},
                                       .rest_deg = {180.0, 0.0},
                                       .counts_per_turn = {13824.0, 13824.0},
                                       .port = {1, 2}},
                                      {.name = "v2",
                                       .made = {.arm_m = 0.07, .forearm_m = 0.09, .between_m = 0.0},
                                       .rest_deg = {241.0, -61.0},
                                       .counts_per_turn = {10752.0, 10752.0}},
                                      {.name = "v3",
                                       .made = {.arm_m = 0.07, .forearm_m = 0.09, .between_m = 0.038},
                                       .rest_deg = {97.23, 82.77},
                                       .counts_per_turn = {5299.7, 5219.3}},
                                      {.name = "v3.1",
                                       .made = {.arm_m = 0.07, .forearm_m = 0.09, .between_m = 0.038},
                                       .rest_deg = {168.0, 12.0},
                                       .counts_per_turn = {4880.0, 4880.0}}}};

void append(Bytes& bytes, double value) {
  const auto word = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  for (const unsigned shift : {0U, 8U, 16U, 24U}) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
}

/// The joint whose motor and encoder are at that port.
std::size_t joint_at(const Version& version, std::uint8_t port) noexcept {
  return version.port[0] == port ? 0 : 1;
}

}  // namespace

std::span<const Version> versions() noexcept { return all; }

const Version* find(std::string_view name) noexcept {
  const auto* found = std::ranges::find(all, name, &Version::name);
  return found == all.end() ? nullptr : found;
}

Bytes reset() { return {asks_reset, board}; }

Bytes set_up(const Version& version) {
  const std::array joints{joint_at(version, 1), joint_at(version, 2)};
  Bytes bytes{asks_set_up, board};
  for (int kind = 0; kind < 2; ++kind) {  // motors, then encoders
    bytes.push_back(both_ports);
    for (const std::size_t joint : joints) bytes.push_back(version.counts_backwards.at(joint) ? 1 : 0);
  }
  bytes.push_back(0);  // analogue inputs
  bytes.push_back(0);  // outputs
  for (const std::size_t joint : joints) {
    append(bytes, version.rest_deg.at(joint));
    append(bytes, version.counts_per_turn.at(joint));
  }
  return bytes;
}

Bytes torques(const Version& version, const std::array<double, 2>& torque_n_m) {
  Bytes bytes{asks_torque, board};
  for (const std::uint8_t port : {std::uint8_t{1}, std::uint8_t{2}}) {
    const double torque = torque_n_m.at(joint_at(version, port));
    append(bytes, std::isfinite(torque) ? std::clamp(torque, -most_torque_n_m, most_torque_n_m) : 0.0);
  }
  return bytes;
}

std::optional<std::array<double, 2>> parse(const Version& version,
                                           std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.size() != answer_size || bytes[0] != board) return std::nullopt;
  std::array<double, 2> angles{};
  for (const std::uint8_t port : {std::uint8_t{1}, std::uint8_t{2}}) {
    const std::size_t at = 1 + 4 * std::size_t{port - 1U};
    const auto word =
        static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8U |
        static_cast<std::uint32_t>(bytes[at + 2]) << 16U | static_cast<std::uint32_t>(bytes[at + 3]) << 24U;
    const auto angle = static_cast<double>(std::bit_cast<float>(word));
    if (!(std::abs(angle) < 3600.0)) return std::nullopt;
    angles[joint_at(version, port)] = angle;
  }
  return angles;
}

}  // namespace kerf::drivers::two_diy
