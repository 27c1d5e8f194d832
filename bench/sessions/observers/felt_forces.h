#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "observers/observer.h"
#include "protocol/samples.h"

namespace kerf::bench {

/// The forces of a sample as a hand gets them, tick by tick, torques as forces at a lever of 10 mm.
struct FeltForces {
  std::size_t axes = 0;
  std::vector<double> force_n;      ///< ticks x axes, on the device after its limits
  std::uint64_t limited_ticks = 0;  ///< in which the device could not give the whole force, or not so soon
  [[nodiscard]] std::size_t ticks() const noexcept { return axes == 0 ? 0 : force_n.size() / axes; }
  [[nodiscard]] double magnitude_n(std::size_t tick) const noexcept;
  /// Root mean square of the magnitude over the ticks that have a force; 0 where none has.
  [[nodiscard]] double rms_n() const noexcept;
  [[nodiscard]] double peak_n() const noexcept;
};

/// How strength is told from the forces along time.
enum class Loudest : std::uint8_t { rms, peak };

/// Where, how long and how often the samples are rendered.
struct FeltOptions {
  std::string device_uri;  ///< empty: the protocol's, else the first simulated device that all samples fit
  bool open_loop = false;  ///< along the protocol's [motion], which no force disturbs
  double seconds = 0.0;    ///< each time; 0: those of the protocol's [motion], else 6
  /// Times, each with other strokes of the hand and other noise (`seed` of the device): a law that chatters
  /// is felt otherwise every time. Once where the device's URI gives a seed.
  std::size_t renderings = 8;
};

/// What a rendering is like on a simulated device with a hand on it: closed loop, in virtual time, with the
/// laws, the gains, the soft start and the limits of a real run. A device of other kinds is not moved: forces
/// are then those along the protocol's [motion], without limits.
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
  [[nodiscard]] double seconds() const noexcept { return seconds_; }

 private:
  void render_once(const PlayedLaw& law, const std::string& uri, FeltForces& felt) const;
  [[nodiscard]] FeltForces along_motion(const PlayedLaw& law) const;

  const Protocol* protocol_;
  std::string device_uri_;  ///< empty: open loop
  double seconds_ = 6.0;
  std::size_t renderings_ = 1;
};

/// How far two renderings lie apart in kind, in JNDs:
///
///     D = rms over the ticks that have a force of |F1 - F2| / j((|F1| + |F2|) / 2)
///
/// What is stronger by one JND throughout is one JND apart.
/// @throws std::invalid_argument: of unlike length.
[[nodiscard]] double difference_in_jnds(const Observer& observer, const FeltForces& first,
                                        const FeltForces& second);

}  // namespace kerf::bench
