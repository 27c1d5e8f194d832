#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "loop/command.h"
#include "probe/push_judgement.h"

namespace kerf::bench {

/// The largest force of a push along an axis: a tenth of what may be commanded, at most 1 N or 0.05 N·m; 0
/// where the axis has no force.
[[nodiscard]] double push_force(const drivers::AxisInfo& axis) noexcept;

/// What the pushes along one axis came to.
struct ProbedAxis {
  std::size_t axis = 0;
  double force = 0.0;  ///< of a push, in the unit of the axis' force
  std::size_t pushes = 0;
  std::size_t stopped = 0;  ///< of them, because the handle went too far or the wrong way
  PushJudgement judgement;
};

/// Small pushes along each axis with force, one axis after the other, in pairs of one each way in the order
/// + - - + - + + -, until judge_pushes() is sure or there were most_push_pairs of them.
///
/// Before each push there is no force for at least 150 ms, and until the handle stands still (5 mm/s, or
/// 0.05 rad/s where the force is a torque) or a second is over. The straight line along which it goes
/// in the last 60 ms is where it would be without the push. A push comes and goes within 30 ms and is held
/// for 100 ms; what counts is how far the handle is from the line between 50 and 100 ms after its begin: late
/// enough to have moved, early enough that the hand has not answered. A push ends at once where an axis is
/// 10 mm (0.1 rad) from its line, or the pushed one 3 mm (0.03 rad) on the wrong side; how far it was then
/// counts. A push whose force Safety took or lessened is made anew.
///
/// Distances are those of the point where the force acts (AxisInfo::lever). After the constructor nothing
/// allocates, locks or throws.
class ProbeRendering {
 public:
  explicit ProbeRendering(const drivers::DeviceInfo& device);

  [[nodiscard]] Command step(const drivers::Sample& sample, double elapsed_s) noexcept;
  /// What became of the tick.
  void see(const schema::Row& row) noexcept;
  [[nodiscard]] bool finished() const noexcept { return at_ == probed_.size(); }

  /// One for each axis with force, in their order.
  [[nodiscard]] const std::vector<ProbedAxis>& probed() const noexcept { return probed_; }
  /// No run is longer, if nothing disturbs it.
  [[nodiscard]] double longest_s() const noexcept;

 private:
  static constexpr std::size_t line_samples = 60;

  struct Line {
    drivers::Axes position{};
    drivers::Axes speed{};
  };

  [[nodiscard]] Line fitted_line() const noexcept;
  [[nodiscard]] double lever_of(std::size_t axis) const noexcept;
  [[nodiscard]] bool is_still(const Line& line) const noexcept;
  void rest(const drivers::Sample& sample) noexcept;
  [[nodiscard]] Command push(const drivers::Sample& sample) noexcept;
  void end_push() noexcept;
  void begin_rest() noexcept;

  drivers::DeviceInfo device_;
  std::vector<ProbedAxis> probed_;
  std::size_t at_ = 0;        ///< of probed_
  std::vector<Push> pushes_;  ///< along that axis
  bool is_pushing_ = false;
  double time_s_ = 0.0;  ///< since the push or the rest began
  struct Seen {
    double time_s = 0.0;
    drivers::Axes position{};
  };
  std::array<Seen, line_samples> seen_{};  ///< the last ones of a rest
  std::size_t seen_count_ = 0;
  Line line_;
  drivers::Axes moved_{};  ///< sums over the part of a push that counts
  drivers::Axes moved_last_{};
  std::size_t moved_count_ = 0;
};

}  // namespace kerf::bench
