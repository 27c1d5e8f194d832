#include "stability/wall/linear_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

// The same sums in wider packets where the processor has them; without fused multiplications, so that they
// are the same to the bit.
// The choice is made while the program is loaded, when no sanitizer is ready yet.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
#define KERF_WIDE_PACKETS [[gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define KERF_WIDE_PACKETS
#endif

namespace kerf::bench {
namespace {

/// A number of each wall. Loops over them all are what the compiler makes packets of the processor of.
using Lanes = std::array<double, walls_together>;

constexpr double at_rest_share = 1e-9;     ///< of the first displacement
constexpr std::size_t between_looks = 64;  ///< ticks

/// Sums over a stretch of time.
struct PackedStretch {
  Lanes position{}, position_squared{}, speed_squared{};

  [[nodiscard]] double energy(std::size_t wall, double ticks, double mass, double stiffness) const {
    return energy_about_mean(mass, stiffness, position[wall], position_squared[wall], speed_squared[wall],
                             ticks);
  }
};

/// Where the walls of a packet are between two ticks.
struct Moving {
  Lanes position{}, speed{};
  Lanes last{}, velocity{};  ///< as read
  Lanes held{};
};

/// Commands on their way to the motors, from the oldest on.
struct CommandLine {
  std::vector<Lanes> line;
  std::size_t next = 0;
};

/// What moves them.
struct WallMovers {
  Lanes stiffness{}, damping{};
  double gain, per_period;
  std::optional<FreeMotion::Transition> before;  ///< until a late command arrives
  FreeMotion::Transition after;
};

[[gnu::always_inline]] inline void move(Moving& at, const FreeMotion::Transition& by) {
  for (std::size_t i = 0; i < walls_together; ++i) {
    const double position = by.xx * at.position[i] + by.xv * at.speed[i] + by.xf * at.held[i];
    at.speed[i] = by.vx * at.position[i] + by.vv * at.speed[i] + by.vf * at.held[i];
    at.position[i] = position;
  }
}

/// Ticks on copies: what no pointer reaches stays in packets. `late`: commands on their way; none: no delay
/// of whole ticks. Adds to `sums`, if any.
KERF_WIDE_PACKETS void step(std::size_t ticks, Moving& moving, const WallMovers& movers, CommandLine& late,
                            PackedStretch* sums) {
  const WallMovers by = movers;
  Moving at = moving;
  PackedStretch sum;
  if (sums != nullptr) sum = *sums;
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    Lanes arrived;
    for (std::size_t i = 0; i < walls_together; ++i) {
      at.velocity[i] += by.gain * ((at.position[i] - at.last[i]) * by.per_period - at.velocity[i]);
      at.last[i] = at.position[i];
      arrived[i] = -by.stiffness[i] * at.position[i] - by.damping[i] * at.velocity[i];
    }
    if (!late.line.empty()) std::swap(late.line[late.next++ % late.line.size()], arrived);
    if (by.before) move(at, *by.before);
    at.held = arrived;
    move(at, by.after);
    if (sums == nullptr) continue;
    for (std::size_t i = 0; i < walls_together; ++i) {
      sum.position[i] += at.position[i];
      sum.position_squared[i] += at.position[i] * at.position[i];
      sum.speed_squared[i] += at.speed[i] * at.speed[i];
    }
  }
  moving = at;
  if (sums != nullptr) *sums = sum;
}

class WallPacket {
 public:
  WallPacket(const SampledDevice& device, const DeviceMotion& moves, std::span<const Wall> walls,
             double start_m)
      : mass_kg_(device.moving_mass_kg()),
        hand_n_per_m_(device.hand.stiffness_n_per_m),
        start_m_(start_m),
        by_{.gain = device.velocity_gain(),
            .per_period = 1.0 / device.period_s,
            .before = {},
            .after = moves.after.transition()},
        late_{.line = std::vector<Lanes>(moves.delay.ticks)} {
    if (moves.delay.share > 0.0) by_.before = moves.before.transition();
    for (std::size_t i = 0; i < walls_together; ++i) {  // places that are left over repeat the last wall
      const Wall& wall = walls[std::min(i, walls.size() - 1)];
      by_.stiffness[i] = wall.stiffness_n_per_m;
      by_.damping[i] = wall.damping_n_s_per_m;
    }
    at_.position.fill(start_m);
    at_.last.fill(start_m);
  }

  void run(std::size_t ticks_a_quarter) {
    ticks_ = static_cast<double>(ticks_a_quarter);
    const std::array<PackedStretch*, 4> quarters{nullptr, &second_, nullptr, &last_quarter_};
    for (PackedStretch* const stretch : quarters) {
      for (std::size_t tick = 0; tick < ticks_a_quarter; tick += between_looks) {
        if (std::ranges::none_of(at_.position, [&](double at) { return is_here(at); })) return;
        step(std::min(between_looks, ticks_a_quarter - tick), at_, by_, late_, stretch);
      }
    }
  }

  [[nodiscard]] bool comes_to_rest(std::size_t wall) const {
    if (!is_here(at_.position[wall])) return false;
    const double stiffness = by_.stiffness[wall] + hand_n_per_m_;
    const double energy = last_quarter_.energy(wall, ticks_, mass_kg_, stiffness);
    return energy <= stiffness * std::pow(at_rest_share * start_m_, 2) ||
           energy < second_.energy(wall, ticks_, mass_kg_, stiffness);
  }

 private:
  [[nodiscard]] bool is_here(double position_m) const { return std::abs(position_m) < lost_m + start_m_; }

  double mass_kg_, hand_n_per_m_, start_m_;
  WallMovers by_;
  Moving at_;
  CommandLine late_;
  double ticks_ = 0.0;
  PackedStretch second_, last_quarter_;
};

}  // namespace

std::vector<bool> linear_walls_come_to_rest(const SampledDevice& device, const DeviceMotion& moves,
                                            std::span<const Wall> walls, double start_m,
                                            std::size_t ticks_a_quarter) {
  std::vector<bool> rest;
  rest.reserve(walls.size());
  for (std::size_t begin = 0; begin < walls.size(); begin += walls_together) {
    const auto part = walls.subspan(begin, std::min(walls_together, walls.size() - begin));
    WallPacket packet(device, moves, part, start_m);
    packet.run(ticks_a_quarter);
    for (std::size_t i = 0; i < part.size(); ++i) rest.push_back(packet.comes_to_rest(i));
  }
  return rest;
}

}  // namespace kerf::bench
