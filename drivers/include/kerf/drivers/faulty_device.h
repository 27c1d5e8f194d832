#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>

namespace kerf::drivers {

/// Something that goes wrong at a moment of loop time.
struct Fault {
  enum class Kind : std::uint8_t {
    unplug,  ///< the device is lost
    stall,   ///< one read() takes `size` seconds longer, and answers with the state at its end
    late,    ///< one write() takes `size` seconds longer
    nan,     ///< positions are not finite for `size` seconds, at least one sample
    jump,    ///< axis 0 reads a travel that is off by `size` metres, from then on
    flip,    ///< likewise in one sample: a bit was turned on the way
  };
  Kind kind = Kind::nan;
  double at_s = 0.0;
  double size = 0.0;
};

/// Reads "unplug@2.5,stall@1.0:50ms,nan@3.0,jump@4.0:20mm,flip@4.5:20mm,late@5.0:3ms": KIND@SECONDS[:SIZE],
/// sizes in s or ms, those of jumps and flips in m or mm.
/// @throws DeviceError that says what was found and what was expected.
[[nodiscard]] std::vector<Fault> parse_faults(std::string_view text);

/// A simulated device to which faults happen, so that what the bench does about them can be tested.
class FaultyDevice final : public Device {
 public:
  /// `pass_time` as in Surroundings; empty: the calling thread sleeps.
  FaultyDevice(std::unique_ptr<Device> device, const std::vector<Fault>& faults,
               std::function<void(double)> pass_time);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return device_->info(); }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override;
  [[nodiscard]] Status write(const Axes& force) noexcept override;
  void release(double at_s) noexcept override { device_->release(at_s); }
  [[nodiscard]] std::vector<Figure> figures() const override { return device_->figures(); }
  [[nodiscard]] std::string trouble() const override { return device_->trouble(); }

 private:
  struct Pending {
    Fault fault;
    bool done = false;
  };
  /// Seconds by which a call is slower, now.
  double delay(Fault::Kind kind) noexcept;
  void spoil(Sample& sample) noexcept;

  std::unique_ptr<Device> device_;
  std::vector<Pending> faults_;
  std::function<void(double)> pass_time_;
  double now_s_ = 0.0;
  bool unplugged_ = false;
};

}  // namespace kerf::drivers
