#include "calibrate/live_holds.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <toml++/toml.h>

#include <kerf/drivers/device.h>
#include <kerf/drivers/gaussian.h>
#include <kerf/drivers/simulated_sensor.h>

#include "inspect/signal_facts.h"
#include "signal/blocked_values.h"

namespace kerf::bench {
namespace {

constexpr double reading_s = 1e-3;
constexpr std::size_t window = 500;  ///< readings by which steadiness is told
constexpr double put_on_s = 1.0;     ///< how long a simulated hand takes
constexpr double standard_errors = 4.0;

/// Puts loads on a simulated sensor, along a minimum-jerk way.
struct SimulatedHand {
  Wrench from = Wrench::Zero();
  Wrench to = Wrench::Zero();
  double since_s = put_on_s;

  [[nodiscard]] drivers::Axes load() const {
    const double s = std::clamp(since_s / put_on_s, 0.0, 1.0);
    const Wrench now = from + (to - from) * (s * s * s * (10.0 - 15.0 * s + 6.0 * s * s));
    drivers::Axes axes{};
    std::copy_n(now.data(), axes.size(), axes.begin());
    return axes;
  }
};

/// A matrix as rows.
nlohmann::ordered_json rows_of(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    rows.push_back(std::vector<double>(matrix.row(row).begin(), matrix.row(row).end()));
  return rows;
}

BlockedValues blocks_of(const std::vector<double>& values) {
  return {values.size(), [&values](std::uint64_t first, std::span<double> some) {
            std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(first), some.size(), some.begin());
          }};
}

class Measuring {
 public:
  Measuring(const LoadScript& script, const LiveHoldsOptions& options, const std::atomic<bool>& stop)
      : script_(script), options_(options), stop_(stop), simulated_(options.uri.starts_with("sim:")) {
    drivers::Surroundings surroundings;
    if (simulated_) {
      surroundings.tissue_of_axes = [this](const drivers::Axes&, const drivers::Axes&, double step_s) {
        hand_.since_s += step_s;
        return hand_.load();
      };
    } else {
      surroundings.stop = &stop;
    }
    device_ = drivers::open_device(uri(), std::move(surroundings));
    find_channels();
    draw_errors();
    begun_ = std::chrono::steady_clock::now();
  }

  LiveHolds run(const MeasuredHolds& before) {
    LiveHolds live;
    live.measured = before;
    live.measured.source = options_.uri;
    live.measured.has_time = true;
    live.measured.signals = names_;
    live.labjack = labjack();
    live.truth = truth();
    for (const MeasuredHold& one : before.holds) time_offset_s_ = std::max(time_offset_s_, one.time_s + 10.0);
    if (!simulated_)
      time_offset_s_ =
          std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    for (const LoadStep& step : script_.steps) {
      const bool has =
          std::ranges::any_of(before.holds, [&](const MeasuredHold& one) { return one.step == step.number; });
      if (has) continue;
      if (!put_on(step)) return finish(std::move(live), false);
      const bool settled = settle();
      if (stop_ || !problem_.empty()) return finish(std::move(live), false);
      if (!settled)
        options_.say(fmt::format("  step {}: it did not become steady within {:g} s; it is left out",
                                 step.number, options_.settle_timeout_s));
      if (!read_for(step.hold_s) || readings_.front().empty()) return finish(std::move(live), false);
      live.measured.holds.push_back(hold(step, settled));
    }
    return finish(std::move(live), true);
  }

 private:
  [[nodiscard]] bool is_labjack() const {
    return options_.uri.starts_with("u6:") || options_.uri.starts_with("t7:");
  }
  /// The volts of a LabJack are channels when they are asked for.
  [[nodiscard]] std::string uri() const {
    if (!is_labjack() || options_.uri.find("raw=") != std::string::npos) return options_.uri;
    return options_.uri + (options_.uri.find('?') == std::string::npos ? "?raw=on" : "&raw=on");
  }

  void find_channels() {
    const auto& channels = device_->info().channels;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (channels[i].name.starts_with("signal_")) {
        places_.push_back(i);
        names_.push_back(channels[i].name);
      }
      if (channels[i].name == "temperature") temperature_place_ = i;
      if (channels[i].name == "force_scan") scan_place_ = i;
    }
    if (places_.empty()) {
      throw std::invalid_argument(
          fmt::format("{}: it has no signals to calibrate; sensors are u6:N and sim:sensor", options_.uri));
    }
    readings_.resize(places_.size());
  }

  void draw_errors() {
    drivers::Gaussian gaussian(options_.seed);
    for (const LoadStep& step : script_.steps) {
      for (const LoadError& one : step.errors) {
        if (!drawn_.contains(one.source)) drawn_[one.source] = gaussian();
      }
    }
  }

  [[nodiscard]] bool put_on(const LoadStep& step) {
    if (!simulated_)
      options_.say(fmt::format("step {} of {}: {}", step.number, script_.steps.size(), step.words));
    if (simulated_) {
      hand_.from = hand_.to;
      hand_.to = step.load;
      for (const LoadError& one : step.errors) hand_.to += drawn_.at(one.source) * one.effect;
      hand_.since_s = 0.0;
      return read_for(put_on_s);
    }
    if (options_.hands_free_s) return read_for(*options_.hands_free_s);
    return options_.wait();
  }

  /// Reads until half a second is steady. False: it never was.
  [[nodiscard]] bool settle() {
    const auto most = static_cast<std::size_t>(options_.settle_timeout_s / reading_s / window) + 1;
    for (std::size_t attempt = 0; attempt < most; ++attempt) {
      if (!read_for(window * reading_s)) return false;
      if (is_steady()) return true;
    }
    return false;
  }

  [[nodiscard]] bool is_steady() const {
    return std::ranges::all_of(readings_, [](const std::vector<double>& values) {
      const std::size_t half = values.size() / 2;
      if (half < 10) return false;
      double first = 0.0;
      double second = 0.0;
      for (std::size_t i = 0; i < half; ++i) {
        first += values[i];
        second += values[values.size() - 1 - i];
      }
      const BlockedValues blocks = blocks_of(values);
      const double noise = noise_of(blocks, quantum_of(blocks)).value_or(0.0);
      const auto count = static_cast<double>(half);
      return std::abs(second - first) / count <= standard_errors * noise * std::sqrt(2.0 / count);
    });
  }

  /// Reads anew for so long. False: it was stopped.
  [[nodiscard]] bool read_for(double seconds) {
    for (auto& values : readings_) values.clear();
    temperature_sum_ = 0.0;
    const double until_s = now_s() + seconds;
    first_s_ = now_s();
    while (now_s() < until_s) {
      if (stop_) return false;
      pass_a_reading();
      drivers::Sample sample;
      const drivers::Status status = device_->read(now_s(), sample);
      if (status == drivers::Status::lost) {
        problem_ = options_.uri + ": the sensor was lost";
        return false;
      }
      if (status == drivers::Status::ok) take(sample);
    }
    last_s_ = now_s();
    return true;
  }

  void take(const drivers::Sample& sample) {
    if (scan_place_) {
      const double scan = sample.channels.at(*scan_place_);
      if (scan == last_scan_) return;
      last_scan_ = scan;
    }
    for (std::size_t i = 0; i < places_.size(); ++i) readings_[i].push_back(sample.channels.at(places_[i]));
    if (temperature_place_) temperature_sum_ += sample.channels.at(*temperature_place_);
  }

  [[nodiscard]] double now_s() const {
    if (simulated_) return virtual_s_;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
  }
  void pass_a_reading() {
    if (simulated_) {
      virtual_s_ += reading_s;
    } else {
      std::this_thread::sleep_for(std::chrono::duration<double>(reading_s));
    }
  }

  [[nodiscard]] MeasuredHold hold(const LoadStep& step, bool settled) {
    MeasuredHold one{.row = step.number, .step = step.number, .load = step.load};
    one.time_s = time_offset_s_ + 0.5 * (first_s_ + last_s_);
    one.settled = settled;
    one.readings = readings_.front().size();
    if (temperature_place_) one.temperature = temperature_sum_ / static_cast<double>(one.readings);
    quantum_.resize(readings_.size(), 0.0);
    for (std::size_t i = 0; i < readings_.size(); ++i) {
      const std::vector<double>& values = readings_[i];
      double sum = 0.0;
      for (const double value : values) sum += value;
      one.signal.push_back(sum / static_cast<double>(values.size()));
      const BlockedValues blocks = blocks_of(values);
      const auto quantum = quantum_of(blocks);
      if (quantum) quantum_[i] = quantum_[i] > 0.0 ? std::min(quantum_[i], *quantum) : *quantum;
      one.noise.push_back(noise_of(blocks, quantum).value_or(0.0));
    }
    return one;
  }

  [[nodiscard]] LiveHolds finish(LiveHolds live, bool finished) const {
    live.finished = finished;
    live.problem = problem_;
    live.measured.quantum = quantum_;
    live.measured.quantum.resize(names_.size(), 0.0);
    return live;
  }

  [[nodiscard]] std::optional<std::uint32_t> labjack() const {
    if (!is_labjack()) return std::nullopt;
    const toml::table settings = toml::parse(device_->info().configuration);
    const auto serial = settings["labjack"]["serial"].value<std::int64_t>();
    return serial ? std::optional(static_cast<std::uint32_t>(*serial)) : std::nullopt;
  }

  [[nodiscard]] std::string truth() const {
    const auto* sensor = dynamic_cast<const drivers::SimulatedSensor*>(device_.get());
    if (sensor == nullptr) return {};
    const auto& drawn = sensor->truth();
    nlohmann::ordered_json json{{"sensitivity", rows_of(drawn.sensitivity)},
                                {"matrix", rows_of(drawn.sensitivity.inverse())},
                                {"bias", rows_of(drawn.bias.transpose())[0]},
                                {"hysteresis_width", rows_of(drawn.hysteresis.transpose())[0]},
                                {"drift_per_s", rows_of(drawn.drift_per_s.transpose())[0]},
                                {"per_kelvin", rows_of(drawn.per_kelvin.transpose())[0]},
                                {"temperature", drawn.temperature},
                                {"noise", sensor->options().noise_v}};
    return json.dump();
  }

  const LoadScript& script_;
  const LiveHoldsOptions& options_;
  const std::atomic<bool>& stop_;
  bool simulated_;
  SimulatedHand hand_;
  std::map<std::string, double> drawn_;  ///< of each source of errors
  std::unique_ptr<drivers::Device> device_;
  std::vector<std::size_t> places_;
  std::vector<std::string> names_;
  std::optional<std::size_t> temperature_place_;
  std::optional<std::size_t> scan_place_;
  std::vector<std::vector<double>> readings_;
  std::vector<double> quantum_;
  std::string problem_;
  double temperature_sum_ = 0.0;
  double last_scan_ = -1.0;
  double virtual_s_ = 0.0;
  double first_s_ = 0.0;
  double last_s_ = 0.0;
  double time_offset_s_ = 0.0;
  std::chrono::steady_clock::time_point begun_;
};

}  // namespace

LiveHolds measure_holds(const LoadScript& script, const LiveHoldsOptions& options,
                        const MeasuredHolds& before, const std::atomic<bool>& stop) {
  return Measuring(script, options, stop).run(before);
}

}  // namespace kerf::bench
