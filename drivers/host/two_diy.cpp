#include "kerf/drivers/protocols/two_diy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <kerf/mechanisms/pantograph.h>

#include "built_in.h"
#include "kerf/drivers/uri.h"
#include "own_device.h"
#include "serial/serial_port.h"
#include "work.h"

namespace kerf::host {
namespace {

using namespace drivers;
using two_diy::Version;
using Vector = mechanisms::Pantograph::Vector;
using Matrix = mechanisms::Pantograph::Matrix;
using Angles = std::array<double, 2>;

constexpr double degree = std::numbers::pi / 180.0;
constexpr int answer_ms = 10;
constexpr int first_answer_ms = 300;
constexpr int quiet_ms = 3;
constexpr int most_wrong_in_a_row = 20;
constexpr double most_off_at_rest_deg = 2.0;
constexpr double force_limit_n = 2.0;
/// About the middle of the linkage, where its forearms are far from being in line: assumed.
constexpr double lowest_y_m = 0.03;
constexpr double highest_y_m = 0.14;
constexpr double sideways_m = 0.05;

/// A Haply 2DIY: bytes without a frame or a sum, an answer to each torque, no watchdog. A torque stands until
/// the next one, whatever becomes of the host.
class TwoDiy {
 public:
  static constexpr const char* name = "2diy";
  static constexpr std::array<const char*, 3> options{"port", "version", nullptr};
  static std::unique_ptr<TwoDiy> open(UriOptions& given) {
    const std::string wanted = given.text("version").value_or("v3.1");
    const Version* const version = two_diy::find(wanted);
    if (version == nullptr)
      throw std::runtime_error(fmt::format("version={}: expected original, v2, v3 or v3.1", wanted));
    return std::make_unique<TwoDiy>(given.text("port").value_or(""), *version);
  }

  TwoDiy(const std::string& path, const Version& version)
      : port_(path, 115200), version_(version), mechanism_(version.made) {
    const Angles first = set_up(path);
    for (std::size_t i = 0; i < 2; ++i) {
      if (std::abs(first.at(i) - version.rest_deg.at(i)) <= most_off_at_rest_deg) continue;
      throw std::runtime_error(
          fmt::format("{}: right after set-up its angles are {:.1f} and {:.1f} deg, expected {:g} and {:g}: "
                      "hold its arms still "
                      "where they rest, or name another version ({})",
                      path, first[0], first[1], version.rest_deg[0], version.rest_deg[1], version.name));
    }
    take(first);
  }

  void describe(kerf_device_facts_v1& facts) const {
    facts.flags = KERF_ANSWERS_AT_ONCE;
    facts.rate_hz = 1000.0;
    facts.jitter_s = 1e-3;
    tell(facts.model, fmt::format("Haply 2DIY ({})", version_.name));
    tell(facts.about, "Haply 2DIY, 2 axes with force; 1 kHz");
    const double middle = 0.5 * version_.made.between_m;
    const auto angles = mechanism_.angles_of({middle, 0.5 * (lowest_y_m + highest_y_m)});
    const Vector count(2.0 * std::numbers::pi / version_.counts_per_turn[0],
                       2.0 * std::numbers::pi / version_.counts_per_turn[1]);
    const Vector step =
        angles ? Vector(mechanism_.jacobian(*angles).cwiseAbs() * count) : Vector(Vector::Zero());
    add_axis(facts, {"x", step.x(), middle - sideways_m, middle + sideways_m, force_limit_n});
    add_axis(facts, {"y", step.y(), lowest_y_m, highest_y_m, force_limit_n});
    for (const char* const angle : {"angle_1", "angle_2"}) add_channel(facts, angle, "rad");
    for (const char* const torque : {"torque_1", "torque_2"}) add_channel(facts, torque, "N·m");
    tell(facts.settings, fmt::format("version = \"{}\"\nrest = {{ value = [{}, {}], unit = \"deg\" }}\n"
                                     "provenance = \"public sketches, not measured on this device\"\n",
                                     version_.name, version_.rest_deg[0], version_.rest_deg[1]));
  }

  int read(kerf_device_reading_v1& reading) {
    // Where a byte was lost the board takes the next torque for another number, but zeros for next to
    // nothing.
    if (!send(wrong_in_a_row_ > 0 ? Angles{} : wanted_)) return -1;
    const auto angles = answer_within(answer_ms);
    if (gone_) return -1;
    if (!angles) {
      // All that follows is shifted then, and only a set-up at rest would mend that.
      return ++wrong_in_a_row_ > most_wrong_in_a_row ? -1 : 0;
    }
    wrong_in_a_row_ = 0;
    take(*angles);
    for (std::size_t i = 0; i < 2; ++i) {
      reading.position[i] = handle_[static_cast<Eigen::Index>(i)];
      reading.channels[i] = angles_[static_cast<Eigen::Index>(i)];
      reading.channels[2 + i] = sent_.at(i);
    }
    if (!handle_.allFinite()) reading.flags |= KERF_DOUBTED;
    return 1;
  }

  int write(const double* force) noexcept {
    const Matrix jacobian = mechanism_.jacobian(angles_);
    Vector torque = version_.gain * jacobian.transpose() * Vector(force[0], force[1]);
    if (!torque.allFinite()) torque.setZero();  // its forearms are in line
    // Both alike, so that the force keeps its direction.
    torque /= std::max(1.0, torque.cwiseAbs().maxCoeff() / two_diy::most_torque_n_m);
    wanted_ = {torque[0], torque[1]};
    return 0;
  }

  /// A message is ten bytes, and goes out as a whole or not at all: whatever was on the way, this is the
  /// next.
  void release() noexcept {
    wanted_ = {};
    for (int round = 0; round < 3; ++round) {
      if (!send(wanted_)) return;
      if (answer_within(answer_ms)) return;
    }
  }

  [[nodiscard]] const char* trouble() const noexcept {
    return gone_ ? "its port is gone" : "it does not answer, or what it answers is no angle";
  }

 private:
  bool send(const std::array<double, 2>& torque_n_m) {
    port_.forget();
    if (!port_.send(two_diy::torques(version_, torque_n_m))) gone_ = true;
    sent_ = torque_n_m;
    return !gone_;
  }

  std::optional<Angles> answer_within(int most_ms) {
    std::array<std::uint8_t, 64> bytes{};
    std::size_t filled = 0;
    const std::int64_t until = now_ns() + std::int64_t{most_ms} * 1'000'000;
    while (filled < two_diy::answer_size) {
      const std::int64_t left_ns = until - now_ns();
      if (left_ns <= 0) return std::nullopt;
      const auto size =
          port_.receive_within(std::span(bytes).subspan(filled), 1 + static_cast<int>(left_ns / 1'000'000));
      if (size < 0) gone_ = true;
      if (size < 0) return std::nullopt;
      filled += static_cast<std::size_t>(size);
    }
    return two_diy::parse(version_, std::span(bytes).first(filled));
  }

  /// Declares the pose that it has now to be that of rest.
  Angles set_up(const std::string& path) {
    std::array<std::uint8_t, 64> unread{};
    (void)port_.send(two_diy::reset());
    while (port_.receive_within(unread, quiet_ms) > 0) {
    }
    (void)port_.send(two_diy::set_up(version_));
    for (int round = 0; round < 4 && send({}); ++round) {
      if (const auto angles = answer_within(first_answer_ms)) return *angles;
    }
    throw std::runtime_error(
        fmt::format("{}: it does not answer as the board of a 2DIY; look whether it is its port, and switch "
                    "it off and on",
                    path));
  }

  void take(const Angles& angles_deg) {
    angles_ = degree * Vector(angles_deg[0], angles_deg[1]);
    handle_ = mechanism_.handle(angles_);
  }

  SerialPort port_;
  Version version_;
  mechanisms::Pantograph mechanism_;
  Vector angles_ = Vector::Zero();
  Vector handle_ = Vector::Zero();
  std::array<double, 2> wanted_{};
  std::array<double, 2> sent_{};
  int wrong_in_a_row_ = 0;
  bool gone_ = false;
};

}  // namespace

const kerf_device_v1 two_diy_device = as_plugin<TwoDiy>("Haply 2DIY");

}  // namespace kerf::host
