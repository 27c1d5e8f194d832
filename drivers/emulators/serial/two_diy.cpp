#include "serial/two_diy.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include <kerf/drivers/device.h>

namespace kerf::emulators {
namespace {

constexpr double in_degrees = 180.0 / std::numbers::pi;
constexpr double strongest_n_m = 0.123;
constexpr double lifted_m = 0.05;
constexpr double lifted_after_s = 1.0;
constexpr double native_usb_bits_per_s = 12e6;

HeldTip::Options resting(const drivers::two_diy::Version& version) {
  const Eigen::Vector2d rest =
      mechanisms::Pantograph(version.made)
          .handle(Eigen::Vector2d(version.rest_deg[0], version.rest_deg[1]) / in_degrees);
  return {.centre_m = {rest.x(), rest.y(), 0.0}, .max_travel_m = 0.1};
}

float float_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) word |= static_cast<std::uint32_t>(bytes.at(at + i)) << 8U * i;
  return std::bit_cast<float>(word);
}

}  // namespace

std::unique_ptr<EmulatedOnLine> EmulatedTwoDiy::make(drivers::UriOptions given, std::vector<Fault> faults) {
  const Options options = parse_common(given);
  const std::string name = given.text("version").value_or("v3.1");
  given.refuse_others();
  const auto* const version = drivers::two_diy::find(name);
  if (version == nullptr) throw drivers::DeviceError("2diy: option 'version' is '" + name + "'");
  return std::make_unique<EmulatedTwoDiy>(options, *version, std::move(faults));
}

EmulatedTwoDiy::EmulatedTwoDiy(const Options& options, const drivers::two_diy::Version& version,
                               std::vector<Fault> faults)
    : EmulatedSerialDevice(options, resting(version), std::move(faults), native_usb_bits_per_s),
      version_(version),
      mechanism_(version.made) {}

Eigen::Vector2d EmulatedTwoDiy::angles_deg() const {
  const Eigen::Vector3d at = position();
  const auto angles = mechanism_.angles_of({at.x(), at.y()});
  return angles ? Eigen::Vector2d(in_degrees * *angles)
                : Eigen::Vector2d(version_.rest_deg[0], version_.rest_deg[1]);
}

Eigen::Vector3d EmulatedTwoDiy::force() const {
  const auto jacobian = mechanism_.jacobian(angles_deg() / in_degrees);
  // By joint, of what the wires of each port do.
  Eigen::Vector2d torque;
  for (Eigen::Index joint = 0; joint < 2; ++joint) {
    const std::size_t port = version_.port.at(static_cast<std::size_t>(joint)) - 1U;
    torque[joint] = torque_n_m_.at(port) / version_.gain;
  }
  const Eigen::Vector2d found = jacobian.transpose().inverse() * torque;
  return found.allFinite() ? Eigen::Vector3d(found.x(), found.y(), 0.0) : Eigen::Vector3d::Zero();
}

void EmulatedTwoDiy::moved() {
  const double share = std::clamp(world_s() / lifted_after_s, 0.0, 1.0);
  lead({0.0, lifted_m * share * share * (3.0 - 2.0 * share), 0.0});
  adjust(force());
}

void EmulatedTwoDiy::begin_anew() {
  heard_.clear();
  forget();
}

void EmulatedTwoDiy::forget() {
  torque_n_m_ = {};
  is_set_up_ = false;
}

void EmulatedTwoDiy::hear(std::span<const std::uint8_t> bytes) {
  heard_.insert(heard_.end(), bytes.begin(), bytes.end());
  while (take_message()) {
  }
}

/// False where it waits for more: there is neither a frame nor a time-out.
bool EmulatedTwoDiy::take_message() {
  if (heard_.size() < 2) return false;
  const auto done = [&](std::size_t size) {
    heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(size));
    return true;
  };
  switch (heard_[0]) {
    case 0:
      forget();  // what stands behind it is the next order
      return done(2);
    case 1: {
      constexpr std::size_t size = 2 + 3 + 3 + 2 + 16;  // both motors, both encoders, no pins
      if (heard_.size() < size) return false;
      const Eigen::Vector2d now = angles_deg();
      for (std::size_t port = 0; port < 2; ++port) {
        const auto joint = static_cast<Eigen::Index>(version_.port[0] == port + 1 ? 0 : 1);
        ports_.at(port) = {.direction = heard_.at(6 + port) != 0 ? -1.0 : 1.0,
                           .offset_deg = static_cast<double>(float_at(heard_, 10 + 8 * port)),
                           .counts = static_cast<double>(float_at(heard_, 14 + 8 * port)),
                           .zero_deg = now[joint]};
      }
      is_set_up_ = true;
      return done(size);
    }
    case 2:
      if (heard_.size() < 10) return false;
      for (std::size_t port = 0; port < 2; ++port) {
        const auto torque = static_cast<double>(float_at(heard_, 2 + 4 * port));
        torque_n_m_.at(port) =
            std::clamp(std::isfinite(torque) ? torque : 0.0, -strongest_n_m, strongest_n_m);
      }
      done(10);
      push(force());
      if (is_set_up_) answer();
      return true;
    default:
      return done(1);  // it takes what it does not know for the next order
  }
}

void EmulatedTwoDiy::answer() {
  const Eigen::Vector2d now = angles_deg();
  Bytes bytes{drivers::two_diy::board};
  for (std::size_t port = 0; port < 2; ++port) {
    const auto joint = static_cast<Eigen::Index>(version_.port[0] == port + 1 ? 0 : 1);
    const Port& told = ports_.at(port);
    // Whole counts since set-up, from what the offset makes of the count there.
    const double counts = std::round(told.offset_deg * told.counts / 360.0) +
                          std::round((now[joint] - told.zero_deg) * told.counts / 360.0);
    const auto word = std::bit_cast<std::uint32_t>(static_cast<float>(360.0 * counts / told.counts));
    for (unsigned shift : {0U, 8U, 16U, 24U}) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
  }
  say(std::move(bytes), 5e-5);
}

}  // namespace kerf::emulators
