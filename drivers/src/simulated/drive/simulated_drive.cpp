#include "kerf/drivers/simulated_drive.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "kerf/drivers/gaussian.h"
#include "kerf/drivers/toml_text.h"
#include "kerf/drivers/velocity_filter.h"
#include "simulated/drive/commands_on_the_way.h"
#include "simulated/drive/drive_plant.h"
#include "simulated/drive/tremor.h"

namespace kerf::drivers {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double at_once_s = 1e-10;        ///< what lies closer together is one moment
constexpr double sensor_step_share = 0.1;  ///< step over noise of the force sensor

double step_to(double value, double step) noexcept {
  return step > 0.0 ? step * std::round(value / step) : value;
}
double value_of(const Known& known, double otherwise) noexcept { return known ? known->value : otherwise; }

/// How often forces have to be asked for; 0: only when something arrives.
double grid_of(const SimulatedDrive::Options& options, const Surroundings& surroundings) {
  constexpr double tissue_s = 50e-6;
  double grid_s = 0.0;
  const auto at_least = [&](double wanted_s) {
    grid_s = grid_s > 0.0 ? std::min(grid_s, wanted_s) : wanted_s;
  };
  if (surroundings.tissue_of_axes) at_least(tissue_s);
  for (std::size_t at = 0; at < options.axes.size(); ++at) {
    const SimulatedDrive::Axis& axis = options.axes[at];
    if (options.with_hand && axis.tremor_n > 0.0) at_least(Tremor::period_s);
    if (surroundings.tissue[at] || (options.with_hand && axis.sway_m > 0.0)) at_least(tissue_s);
    if (is_stepped_finely(axis)) at_least(TwoMasses::step_s);
  }
  return grid_s;
}

std::string configuration_of(const SimulatedDrive::Options& options) {
  const auto word = [](bool flag) { return flag ? "true" : "false"; };
  std::string text = "model = \"sim:axis\"\nseed = " + std::to_string(options.seed) +
                     "\nhand = " + word(options.with_hand) + "\nnoise = " + word(options.with_noise) +
                     "\nencoder = " + word(options.with_encoder) + "\nmotor = " + word(options.with_motor) +
                     "\n";
  if (!options.model_file.empty()) text += "device_model = " + toml_text(options.model_file) + "\n";
  for (const SimulatedDrive::Axis& axis : options.axes) {
    text += "\n[axes." + toml_text(axis.model.name) + "]\n";
    for (const AxisNumber& one : axis_numbers()) {
      const Known& number = axis.model.*one.member;
      if (!number) continue;
      text += std::string(one.key) + " = { value = " + toml_number(number->value) + ", unit = \"" +
              unit_of(one, axis.model) + "\" }\n";
    }
    const std::array<std::pair<const char*, double>, 12> others{
        {{"delay_ticks", axis.delay_ticks},
         {"hand_mass", axis.hand.mass_kg},
         {"hand_damping", axis.hand.damping_n_s_per_m},
         {"grip", axis.hand.stiffness_n_per_m},
         {"sway", axis.sway_m},
         {"tremor", axis.tremor_n},
         {"backlash", axis.backlash_m},
         {"cogging", axis.cogging_n},
         {"cogging_period", axis.cogging_period_m},
         {"flexible", axis.flexible_n_per_m},
         {"flexible_damping", axis.flexible_n_s_per_m},
         {"flexible_share", axis.flexible_share}}};
    for (const auto& [key, value] : others) text += std::string(key) + " = " + toml_number(value) + "\n";
  }
  return text;
}

AxisInfo info_of(const SimulatedDrive::Axis& axis, const SimulatedDrive::Options& options) {
  const AxisModel& model = axis.model;
  return {.name = model.name,
          .position_unit = model.position_unit,
          .force_unit = model.force_unit,
          .lever = model.lever,
          .resolution = options.with_encoder ? value_of(model.encoder_step, 0.0) : 0.0,
          .lower = model.limits.lower,
          .upper = model.limits.upper,
          .force_limit = model.limits.force,
          .slew_limit = model.limits.slew,
          .speed_limit = model.limits.speed,
          .acceleration_limit = model.limits.acceleration,
          .mechanics = options.tells_mechanics ? model.mechanics() : std::nullopt,
          .delay_s = options.tells_mechanics ? value_of(model.delay, 0.0) : 0.0,
          .velocity_corner_rad_s = options.tells_mechanics && model.velocity_corner
                                       ? std::optional(model.velocity_corner->value)
                                       : std::nullopt};
}

DeviceInfo info_of(std::string_view uri, const SimulatedDrive::Options& options) {
  DeviceInfo info{
      .uri = std::string(uri),
      .model = "sim:axis",
      .about = "an axis of drawn truth: mass, friction, delay, resolution and hand as asked, simulated",
      .axes = {},
      .channels = {},
      .measures_force = options.with_sensor,
      .simulated = true,
      .button_channel = std::nullopt,
      .configuration = configuration_of(options),
      .mounts = {},
      .serial = options.serial};
  for (const SimulatedDrive::Axis& axis : options.axes) info.axes.push_back(info_of(axis, options));
  if (!options.with_truth) return info;
  for (const char* what : {"_true", "_force_true", "_motor_true"}) {
    for (const AxisInfo& axis : info.axes) {
      const bool place = std::string_view(what) == "_true";
      info.channels.push_back(
          {.name = axis.name + what, .unit = place ? axis.position_unit : axis.force_unit});
    }
  }
  return info;
}

}  // namespace

class SimulatedDrive::World {
 public:
  World(const Options& options, Surroundings surroundings)
      : options_(options),
        grid_s_(grid_of(options, surroundings)),
        tissue_(std::move(surroundings.tissue)),
        tissue_of_axes_(std::move(surroundings.tissue_of_axes)),
        noise_(options.seed),
        jitter_(options.seed ^ 0x6a09e667f3bcc908U) {
    constexpr double otherwise_s = 1e-3;
    for (std::size_t at = 0; at < options.axes.size(); ++at) {
      const Axis& axis = options.axes[at];
      plants_.emplace_back(axis, options.with_hand, grid_s_ > 0.0 ? grid_s_ : otherwise_s);
      pushes_[at].hand_place_m = plants_[at].home_m();
      tremors_.emplace_back(options.with_hand ? axis.tremor_n : 0.0, options.seed + 1000003U * (at + 1));
    }
    on_the_way_.resize(plants_.size());
    ask();
  }

  void run_until(double now_s) noexcept {
    while (true) {
      const bool released = time_s_ + at_once_s >= released_at_s_.load(std::memory_order_relaxed);
      for (std::size_t at = 0; at < plants_.size(); ++at) {
        while (!on_the_way_[at].empty() && on_the_way_[at].next_s() <= time_s_ + at_once_s)
          held_[at] = on_the_way_[at].take();
        pushes_[at].motor_n = released ? 0.0 : acting(at, held_[at]);
      }
      if (time_s_ >= now_s - at_once_s) return;
      const double next_s = next_event(now_s);
      for (std::size_t at = 0; at < plants_.size(); ++at) plants_[at].move(pushes_[at], next_s - time_s_);
      time_s_ = next_s;
      if (grid_s_ > 0.0 && time_s_ >= next_of_grid() - at_once_s) {
        ++grid_index_;
        ask();
      }
    }
  }

  void measure(double now_s, const DeviceInfo& info, Sample& sample) noexcept {
    const std::size_t count = plants_.size();
    for (std::size_t at = 0; at < count; ++at) {
      const AxisModel& model = options_.axes[at].model;
      const double truth = plants_[at].motor().position_m / model.lever;
      const double seen = options_.encoder_noise > 0.0 ? truth + options_.encoder_noise * noise_() : truth;
      const double position = step_to(seen, info.axes[at].resolution);
      sample.position[at] = position;
      sample.velocity[at] = velocity_.update(at, position, now_s,
                                             value_of(model.velocity_corner, VelocityFilter::corner_rad_s));
      const double outer_n = plants_[at].outer_force_n(pushes_[at]);
      sample.force_measured[at] =
          options_.with_sensor ? sensed(outer_n) : std::numeric_limits<double>::quiet_NaN();
      if (!options_.with_truth) continue;
      sample.channels[at] = truth;
      sample.channels[count + at] = outer_n;
      sample.channels[2 * count + at] = pushes_[at].motor_n;
    }
    velocity_.advance(now_s);
    if (has_read_) period_s_ = now_s - read_at_s_;
    read_at_s_ = now_s;
    has_read_ = true;
  }

  Status write(const Axes& force) noexcept {
    if (released_at_s_.exchange(never, std::memory_order_relaxed) != never) forget();
    for (std::size_t at = 0; at < plants_.size(); ++at) {
      if (!std::isfinite(force[at])) {
        forget();
        return Status::fault;
      }
      const AxisModel& model = options_.axes[at].model;
      const double jitter_s = value_of(model.delay_jitter, 0.0);
      const double delay_s = value_of(model.delay, 0.0) + options_.axes[at].delay_ticks * period_s_ +
                             (jitter_s > 0.0 ? jitter_s * jitter_() : 0.0);
      on_the_way_[at].send(read_at_s_ + std::max(0.0, delay_s),
                           std::clamp(force[at], -model.limits.force, model.limits.force));
    }
    return Status::ok;
  }

  void release(double at_s) noexcept {
    double expected = never;
    released_at_s_.compare_exchange_strong(expected, at_s, std::memory_order_relaxed);
  }

 private:
  [[nodiscard]] double next_of_grid() const noexcept {
    return static_cast<double>(grid_index_ + 1) * grid_s_;
  }
  [[nodiscard]] double next_event(double now_s) const noexcept {
    double next_s = now_s;
    if (grid_s_ > 0.0) next_s = std::min(next_s, next_of_grid());
    for (const CommandsOnTheWay& line : on_the_way_) {
      if (!line.empty()) next_s = std::min(next_s, line.next_s());
    }
    const double released_s = released_at_s_.load(std::memory_order_relaxed);
    return released_s > time_s_ + at_once_s ? std::min(next_s, released_s) : next_s;
  }
  /// What the motor gives of a command.
  [[nodiscard]] double acting(std::size_t at, double command) const noexcept {
    if (!options_.with_motor) return 0.0;
    const AxisModel& model = options_.axes[at].model;
    const double most = value_of(model.saturation, never);
    return std::clamp(options_.motor_sign * value_of(model.motor_constant, 1.0) * command, -most, most);
  }
  [[nodiscard]] double sensed(double outer_n) noexcept {
    const double read_n = options_.sensor_sign * outer_n;
    if (!options_.with_noise) return read_n;
    const double noise_n = options_.sensor_noise_n;
    return step_to(read_n + noise_n * noise_(), sensor_step_share * noise_n);
  }
  void forget() noexcept {
    for (CommandsOnTheWay& line : on_the_way_) line.forget();
    held_ = {};
  }
  /// Where the hand wants to be, how it trembles, and what the tissue exerts.
  void ask() noexcept {
    const double now_s = static_cast<double>(grid_index_) * grid_s_;
    const auto each =
        static_cast<std::uint64_t>(grid_s_ > 0.0 ? std::llround(Tremor::period_s / grid_s_) : 1);
    for (std::size_t at = 0; at < plants_.size(); ++at) {
      DrivePlant::Push& push = pushes_[at];
      const Axis& axis = options_.axes[at];
      if (grid_index_ % each == 0) push.tremor_n = tremors_[at].next();
      const double omega = 2.0 * std::numbers::pi * (0.23 + 0.12 * static_cast<double>(at));
      push.hand_place_m = plants_[at].home_m() + axis.sway_m * std::sin(omega * now_s);
      push.hand_speed_m_s = axis.sway_m * omega * std::cos(omega * now_s);
      const mechanisms::AxisMotion& handle = plants_[at].handle();
      position_[at] = handle.position_m / axis.model.lever;
      speed_[at] = handle.speed_m_s / axis.model.lever;
      if (tissue_[at]) push.tissue_n = tissue_[at](position_[at], speed_[at], grid_s_);
    }
    if (!tissue_of_axes_) return;
    const Axes all = tissue_of_axes_(position_, speed_, grid_s_);
    for (std::size_t at = 0; at < plants_.size(); ++at) pushes_[at].tissue_n = all[at];
  }

  Options options_;
  double grid_s_;
  std::array<Tissue, max_axes> tissue_;
  TissueOfAxes tissue_of_axes_;
  Gaussian noise_;
  Gaussian jitter_;
  std::vector<DrivePlant> plants_;
  std::vector<Tremor> tremors_;
  std::vector<CommandsOnTheWay> on_the_way_;
  std::array<DrivePlant::Push, max_axes> pushes_{};
  Axes held_{};  ///< commands that have arrived
  Axes position_{};
  Axes speed_{};
  std::atomic<double> released_at_s_{never};
  double time_s_ = 0.0;
  std::uint64_t grid_index_ = 0;
  double read_at_s_ = 0.0;
  double period_s_ = 1e-3;  ///< between the last two readings
  bool has_read_ = false;
  VelocityFilter velocity_;
};

SimulatedDrive::SimulatedDrive(std::string_view uri, const Options& options, Surroundings surroundings)
    : info_(info_of(uri, options)), world_(std::make_unique<World>(options, std::move(surroundings))) {}

SimulatedDrive::~SimulatedDrive() = default;

Status SimulatedDrive::read(double now_s, Sample& sample) noexcept {
  world_->run_until(now_s);
  world_->measure(now_s, info_, sample);
  return Status::ok;
}

Status SimulatedDrive::write(const Axes& force) noexcept { return world_->write(force); }

void SimulatedDrive::release(double at_s) noexcept { world_->release(at_s); }

}  // namespace kerf::drivers
