#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "protocol/felt_level.h"
#include "protocol/samples.h"

namespace kerf::bench {

/// The forces of a sample as a hand gets them, tick by tick, torques as forces at a lever of 10 mm.
struct FeltForces {
  std::size_t axes = 0;
  double rate_hz = 0.0;
  std::vector<double> force_n;      ///< ticks x axes, on the device after its limits
  std::uint64_t limited_ticks = 0;  ///< in which the device could not give the whole force, or not so soon
  std::vector<std::size_t> begins;  ///< first ticks of the renderings that follow each other
  [[nodiscard]] std::size_t ticks() const noexcept { return axes == 0 ? 0 : force_n.size() / axes; }
  [[nodiscard]] double magnitude_n(std::size_t tick) const noexcept;
  /// Root mean square of the magnitude over the ticks that have a force of more than so much; 0 where none
  /// has.
  [[nodiscard]] double rms_n(double above_n = 1e-9) const noexcept;
  [[nodiscard]] double peak_n() const noexcept;
  /// As trials are judged by it: the rms over the ticks with least_felt_force_n.
  [[nodiscard]] FeltLevel level() const;
};

/// How strength is told from the forces along time.
enum class Loudest : std::uint8_t { rms, peak };

/// Where, how long and how often the samples are rendered.
struct FeltOptions {
  std::string device_uri;  ///< empty: the protocol's, else the first simulated device that all samples fit
  bool open_loop = false;  ///< along the protocol's [motion], which no force disturbs
  bool stand_in = false;   ///< the first simulated device that fits is taken in a real one's place
  double seconds = 0.0;    ///< each time; 0: those of the protocol's [motion], else 6
  /// Times, each with other strokes of the hand and other noise (`seed` of the device): a law that chatters
  /// is felt otherwise every time. Once where the device's URI gives a seed.
  std::size_t renderings = 8;
};

/// What a rendering is like on a simulated device with a hand on it: closed loop, in virtual time, with the
/// laws, the gains, the soft start and the limits of a real run; a guide that leads the trials leads that
/// hand (led_hand()), and where it is felt its force is rendered too and not counted as the law's. A device
/// of other kinds is not moved: forces are then those along the protocol's [motion], without limits, or those
/// on a simulated one in its place.
class FeltRenderer {
 public:
  /// @throws std::invalid_argument: no device, no [motion] where one is needed.
  FeltRenderer(const Protocol& protocol, const FeltOptions& options);

  /// All renderings one after the other, each without its first 0.5 s, while the soft start makes everything
  /// weaker.
  /// @throws std::invalid_argument: the law faults. drivers::DeviceError.
  [[nodiscard]] FeltForces rendered(const PlayedLaw& law) const;

  [[nodiscard]] bool is_open_loop() const noexcept { return device_uri_.empty(); }
  [[nodiscard]] const std::string& device_uri() const noexcept { return device_uri_; }
  /// The real device in whose place that is; empty: none.
  [[nodiscard]] const std::string& stands_for() const noexcept { return stands_for_; }
  [[nodiscard]] double seconds() const noexcept { return seconds_; }

 private:
  void render_once(const PlayedLaw& law, const std::string& uri, FeltForces& felt) const;
  [[nodiscard]] FeltForces along_motion(const PlayedLaw& law) const;

  const Protocol* protocol_;
  std::string device_uri_;  ///< empty: open loop
  std::string stands_for_;
  double seconds_ = 6.0;
  std::size_t renderings_ = 1;
};

}  // namespace kerf::bench
