#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulated_device.h"

namespace kerf::emulators {

/// One thing that goes wrong, from so many seconds after the device was attached.
///
/// | kind | what | then |
/// |---|---|---|
/// | drop, split, corrupt | an answer is lost, torn in two, has a byte lost or turned | COUNT |
/// | stall | a transfer is refused for good, as by an endpoint that has halted | COUNT |
/// | duplicate | an answer comes twice | COUNT |
/// | flip | one bit anywhere in an answer is turned, drawn by the seed | COUNT:SEED |
/// | delay | every answer comes so much later | TIME:DURATION, for ever without one |
/// | refuse-out | nothing that the host sends is taken (NAK), and it waits | DURATION |
/// | stick | the counters stand still | DURATION |
/// | unplug | it is gone | |
/// | swap | an answer comes after the next one | COUNT |
/// | silence | nothing is sent, and time goes on | DURATION |
/// | overload | the sensor says that it is overloaded | DURATION |
/// | restart | it is without power, and begins anew | DURATION |
///
/// What is on the USB knows those to `unplug`, what is in the network `drop`, `corrupt`, `duplicate`,
/// `delay`, `stick`, and those from `unplug` on.
struct Fault {
  enum class Kind : std::uint8_t {
    drop,
    split,
    corrupt,
    stall,
    duplicate,
    flip,
    delay,
    refuse_out,
    stick,
    unplug,
    swap,
    silence,
    overload,
    restart
  };
  Kind kind = Kind::drop;
  double at_s = 0.0;
  std::uint64_t count = 1;
  std::uint64_t seed = 1;
  double delay_s = 0.0;
  double duration_s = std::numeric_limits<double>::infinity();
};

/// Reads "drop@2.0,flip@3:10:7,delay@5:20ms:1s,unplug@8": KIND@SECONDS and what the kind takes behind colons.
/// @throws std::invalid_argument with what was expected.
[[nodiscard]] std::vector<Fault> parse_faults(std::string_view text);
/// @throws std::invalid_argument for one that does not happen there.
void check_faults_of_usb(const std::vector<Fault>& faults);
void check_faults_of_network(const std::vector<Fault>& faults);
void check_faults_of_line(const std::vector<Fault>& faults);

/// The faults of one run, as they come due. Times are seconds since the device was attached.
class FaultPlan {
 public:
  FaultPlan() = default;
  explicit FaultPlan(std::vector<Fault> faults) : faults_(std::move(faults)) {}

  /// What disturbs the next answer at this time, if anything.
  [[nodiscard]] Disturbance due(double time_s) const noexcept;
  /// One answer was disturbed so.
  void done(Disturbance disturbance, double time_s) noexcept;
  /// Whether the next transfer on a data endpoint stalls; counts it.
  [[nodiscard]] bool stalls(double time_s) noexcept;
  /// Whether the answer that is sent now comes twice; counts it.
  [[nodiscard]] bool duplicates(double time_s) noexcept;
  /// A number to choose the bit by that is turned in the answer that is sent now, if any; counts it.
  [[nodiscard]] std::optional<std::uint64_t> flips(double time_s) noexcept;
  /// How much later answers are that are ready now.
  [[nodiscard]] double delay_s(double time_s) const noexcept;
  /// Until when nothing that the host sends is taken, if that is so now.
  [[nodiscard]] std::optional<double> refuses_until_s(double time_s) const noexcept;
  [[nodiscard]] bool sticks(double time_s) const noexcept;
  /// Whether the answer that is sent now comes after the next one; counts it.
  [[nodiscard]] bool swaps(double time_s) noexcept;
  [[nodiscard]] bool is_silent(double time_s) const noexcept;
  [[nodiscard]] bool is_overloaded(double time_s) const noexcept;
  [[nodiscard]] bool is_without_power(double time_s) const noexcept;
  /// When the device is unplugged, if ever.
  [[nodiscard]] std::optional<double> unplugged_at_s() const noexcept;

 private:
  [[nodiscard]] const Fault* find(Fault::Kind kind, double time_s) const noexcept;
  bool count(Fault::Kind kind, double time_s) noexcept;

  std::vector<Fault> faults_;
};

}  // namespace kerf::emulators
