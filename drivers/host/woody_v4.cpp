#include "kerf/drivers/protocols/woody_v4.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <kerf/mechanisms/woodenhaptics.h>

#include "built_in.h"
#include "kerf/drivers/uri.h"
#include "own_device.h"
#include "serial/serial_port.h"
#include "woodenhaptics/woodenhaptics_axes.h"
#include "work.h"

namespace kerf::host {
namespace {

using namespace drivers;
using namespace drivers::woodenhaptics;
using woody_v4::Answer;
using Vector = mechanisms::WoodenHaptics::Vector;

constexpr int answer_ms = 10;
constexpr std::int64_t handshake_ns = 1'800'000'000;
constexpr int again_ms = 100;
constexpr int quiet_ms = 3;
constexpr int rounds_of_release = 3;

/// hfabapi (2026): the configuration that is woody-2016's, with encoders and motors of B and C turned round.
constexpr mechanisms::WoodenHaptics::Signs signs{.encoder = {1.0, -1.0, -1.0}, .motor = {1.0, -1.0, -1.0}};

mechanisms::WoodenHaptics::Configuration made_with(double most_current_a) {
  auto made = *mechanisms::WoodenHaptics::find("woody-2016");
  made.max_current_a = most_current_a;
  return made;
}

/// A WoodenHaptics of the fourth generation: one message, one answer, never two messages on the way.
class WoodyV4 {
 public:
  static constexpr const char* name = "woody-v4";
  static constexpr std::array<const char*, 4> options{"port", "most_current", "calibrate", nullptr};
  static std::unique_ptr<WoodyV4> open(UriOptions& given) {
    const double most = given.number("most_current", {"A", 3.0, 0.0, 1e-3 * woody_v4::most_current_ma});
    const bool calibrate = given.flag("calibrate", false);
    return std::make_unique<WoodyV4>(given.text("port").value_or(""), most, calibrate);
  }

  WoodyV4(const std::string& path, double most_current_a, bool calibrate)
      : port_(path, 115200), mechanism_(made_with(most_current_a), signs) {
    const Answer first = handshake(path);
    if (first.model != static_cast<int>(woody_v4::Model::woody)) {
      throw std::runtime_error(
          fmt::format("{}: it says that it is model {}, expected 3, a WoodenHaptics; kinematics of the "
                      "others are not known here",
                      path, first.model));
    }
    if (calibrate) std::copy_n(first.counter.begin(), 3, home_.begin());
    take(first);
    const Vector& middle = mechanism_.configuration().centre_m;
    if (!((tip_ - middle).norm() <= 2.0 * workspace_m + (mechanism_.home() - middle).norm())) {
      throw std::runtime_error(
          fmt::format("{}: by its counters its tip is {:.2f} m from the middle of its workspace; it was not "
                      "at home when it was "
                      "switched on: hold it there and press its button, or open it with calibrate=on",
                      path, (tip_ - middle).norm()));
    }
  }

  void describe(kerf_device_facts_v1& facts) const {
    const auto& made = mechanism_.configuration();
    facts.flags = KERF_ANSWERS_AT_ONCE;
    facts.rate_hz = 1000.0;
    facts.jitter_s = 1e-3;
    tell(facts.model, "WoodenHaptics (V4)");
    tell(facts.about, "WoodenHaptics of 2022 on, 3 axes with force; 1 kHz");
    const Vector step = steps_in_the_middle(mechanism_).rowwise().maxCoeff();
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double middle = made.centre_m[i];
      add_axis(facts, {std::string_view("xyz").substr(static_cast<std::size_t>(i), 1), step[i],
                       middle - workspace_m, middle + workspace_m, made.max_force_n});
    }
    for (const char* const current : {"current_a", "current_b", "current_c"})
      add_channel(facts, current, "A");
    add_channel(facts, "error_bits", "1");
    tell(facts.settings,
         fmt::format("home_counts = [{}, {}, {}]\nmost_current = {{ value = {}, unit = \"A\" }}\n"
                     "provenance = \"hfabapi, not measured on this device\"\n",
                     home_[0], home_[1], home_[2], made.max_current_a));
  }

  int read(kerf_device_reading_v1& reading) {
    if (!on_the_way_ && !send()) return -1;
    const auto text = answer_within(answer_ms);
    if (gone_) return -1;
    if (!text) {
      // It may only be late; the second time it is lost, and asked for anew.
      if (std::exchange(was_late_, true)) on_the_way_ = was_late_ = false;
      return 0;
    }
    on_the_way_ = was_late_ = false;
    const auto answer = woody_v4::parse(*text);
    if (!answer) return 0;
    take(*answer);
    for (std::size_t i = 0; i < 3; ++i) {
      reading.position[i] = tip_[static_cast<Eigen::Index>(i)];
      reading.channels[i] = 1e-3 * sent_ma_.at(i);
    }
    reading.channels[3] = answer->error;
    // Its counters are then those of the message before.
    if ((answer->error & woody_v4::not_taken) != 0 || !tip_.allFinite()) reading.flags |= KERF_DOUBTED;
    return 1;
  }

  int write(const double* force) noexcept {
    const auto currents = mechanism_.currents({force[0], force[1], force[2]}, angles_);
    for (std::size_t i = 0; i < 3; ++i)
      wanted_ma_.at(i) = static_cast<int>(std::lround(1e3 * currents.ampere.at(i)));
    return 0;
  }

  /// In a copy of the process nobody knows what is on the way: a line that is quiet has nothing.
  void release() noexcept {
    wanted_ma_ = {};
    for (int round = 0; round < rounds_of_release; ++round) {
      std::array<std::uint8_t, 256> unread{};
      for (int burst = 0; burst < 4 && port_.receive_within(unread, quiet_ms) > 0; ++burst) {
      }
      if (!send()) return;
      const auto text = answer_within(answer_ms);
      const auto answer = text ? woody_v4::parse(*text) : std::nullopt;
      on_the_way_ = false;
      if (answer && (answer->error & woody_v4::not_taken) == 0) return;
    }
  }

  [[nodiscard]] static const char* trouble() noexcept { return "its port is gone"; }

 private:
  bool send() {
    port_.forget();
    answers_.clear();
    on_the_way_ = port_.send(woody_v4::order(wanted_ma_));
    if (on_the_way_) sent_ma_ = wanted_ma_;
    return on_the_way_;
  }

  std::optional<std::string> answer_within(int most_ms) {
    const std::int64_t until = now_ns() + std::int64_t{most_ms} * 1'000'000;
    for (;;) {
      if (auto text = answers_.next()) return text;
      const std::int64_t left_ns = until - now_ns();
      if (left_ns <= 0) return std::nullopt;
      std::array<char, 256> bytes{};
      const auto size = port_.receive_within(
          {reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size()},  // NOLINT(*-reinterpret-cast): text
          1 + static_cast<int>(left_ns / 1'000'000));
      if (size < 0) {
        gone_ = true;
        return std::nullopt;
      }
      answers_.add({bytes.data(), static_cast<std::size_t>(size)});
    }
  }

  /// Its answer to a message of which it is sure: the one before, and nothing since.
  Answer handshake(const std::string& path) {
    std::string wrong = "it does not answer";
    for (const std::int64_t until = now_ns() + handshake_ns; now_ns() < until && !gone_;) {
      if (!send()) break;
      const bool is_there = answer_within(again_ms).has_value();
      on_the_way_ = false;
      if (!is_there) continue;
      // What was asked before may be answered later still.
      while (now_ns() < until && answer_within(2 * again_ms)) wrong = "its answers come too late";
      if (now_ns() >= until || !send()) break;
      const auto text = answer_within(2 * answer_ms);
      on_the_way_ = false;
      const auto answer = text ? woody_v4::parse(*text) : std::nullopt;
      if (answer && answer->error == 0) return *answer;
      if (!text) wrong = "its answers come too late";
      if (text && !answer) wrong = "what it answers is not [model,e0,...,e5,error]";
      if (answer)
        wrong = fmt::format("it answers with error {}: {}", answer->error, woody_v4::in_words(answer->error));
    }
    throw std::runtime_error(fmt::format(
        "{}: {}; look whether it is its port, and its firmware that of 2022 on (V4)", path, wrong));
  }

  void take(const Answer& answer) {
    std::array<int, 3> count{};
    for (std::size_t i = 0; i < 3; ++i) count.at(i) = answer.counter.at(i) - home_.at(i);
    angles_ = mechanism_.angles(count);
    tip_ = mechanism_.tip(angles_);
  }

  SerialPort port_;
  mechanisms::WoodenHaptics mechanism_;
  woody_v4::AnswerReader answers_;
  std::array<int, 3> home_{};  ///< counters there
  Vector angles_ = Vector::Zero();
  Vector tip_ = Vector::Zero();
  std::array<int, 3> wanted_ma_{};
  std::array<int, 3> sent_ma_{};
  bool on_the_way_ = false;
  bool was_late_ = false;
  bool gone_ = false;
};

}  // namespace

const kerf_device_v1 woody_v4_device = as_plugin<WoodyV4>("WoodenHaptics of the fourth generation");

}  // namespace kerf::host
