#include "calibrate/prepared_holds.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace kerf::bench {

namespace cal = fitting::calibration;

namespace {

/// Rounded, so that loads of one direction have the same.
std::vector<double> direction_of(std::vector<double> load) {
  double size = 0.0;
  for (const double one : load) size += one * one;
  for (double& one : load) one = size > 0.0 ? std::round(1e3 * one / std::sqrt(size)) + 0.0 : 0.0;
  return load;
}

}  // namespace

PreparedHolds::PreparedHolds(MeasuredHolds& measured, const LoadScript* script,
                             const SensorCalibrationOptions& options, std::vector<std::string>& warnings)
    : measured_(measured), script_(script), options_(options), warnings_(warnings) {
  components_ = options.components.empty() ? measured.components : options.components;
  leave_out();
  holds_ = as_holds();
  take_copies_out();
  take_errors();
}

std::vector<cal::Candidate> PreparedHolds::candidates() const {
  std::vector<cal::Candidate> all;
  const auto add = [&](std::string name, const Wrench& load) {
    cal::Candidate one{.name = std::move(name), .load = {}};
    for (const std::size_t k : components_) one.load.push_back(load(static_cast<Eigen::Index>(k)));
    all.push_back(std::move(one));
  };
  double force = 0.0;
  double torque = 0.0;
  for (const MeasuredHold& hold : measured_.holds) {
    force = std::max(force, hold.load.head<3>().norm());
    torque = std::max(torque, hold.load.tail<3>().norm());
  }
  if (!(force > 0.0)) force = 1.0;
  const double lever = torque > 0.0 ? torque / force : 0.05;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const Eigen::Vector3d push = sign * force * Eigen::Vector3d::Unit(axis);
      const std::string way = fmt::format("{:.3g} N along {}{}", force, sign > 0.0 ? '+' : '-',
                                          "xyz"[static_cast<std::size_t>(axis)]);
      Wrench load = Wrench::Zero();
      load.head<3>() = push;
      add(way, load);
      for (Eigen::Index arm = 0; arm < 3; ++arm) {
        if (arm == axis) continue;
        load.tail<3>() = (lever * Eigen::Vector3d::Unit(arm)).cross(push);
        add(fmt::format("{} at {:.3g} mm along {}", way, 1e3 * lever, "xyz"[static_cast<std::size_t>(arm)]),
            load);
      }
    }
  }
  return all;
}

void PreparedHolds::leave_out() {
  const std::size_t before = measured_.holds.size();
  std::erase_if(measured_.holds, [&](const MeasuredHold& one) {
    return std::ranges::find(options_.leave_out, one.row) != options_.leave_out.end();
  });
  if (before - measured_.holds.size() < options_.leave_out.size())
    warnings_.emplace_back("of the rows to leave out some are not there, or stand within a hold");
  for (const MeasuredHold& one : measured_.holds) {
    if (!one.settled)
      warnings_.push_back(fmt::format("row {}: it never became steady, and is left out", one.row));
  }
  std::erase_if(measured_.holds, [](const MeasuredHold& one) { return !one.settled; });
}

cal::Holds PreparedHolds::as_holds() const {
  cal::Holds holds{.components = {}, .signals = measured_.signals, .holds = {}, .load_error = {}};
  for (const std::size_t k : components_) holds.components.emplace_back(wrench_components.at(k));
  std::map<std::vector<double>, std::size_t> load_numbers;
  std::map<std::vector<double>, std::size_t> placements;
  std::map<std::size_t, std::size_t> tares;
  for (const MeasuredHold& one : measured_.holds) {
    cal::Hold hold{.load = {}, .signal = one.signal, .time_s = one.time_s, .temperature = one.temperature};
    for (const std::size_t k : components_) hold.load.push_back(one.load(static_cast<Eigen::Index>(k)));
    hold.row = one.row;
    if (script_ != nullptr && one.step > 0) {
      const LoadStep& step = script_->steps.at(one.step - 1);
      hold.load_number = step.load_number;
      hold.placement = step.placement;
      hold.tare = tares.emplace(step.tare, tares.size()).first->second;
    } else {
      hold.load_number = load_numbers.emplace(hold.load, load_numbers.size()).first->second;
      hold.placement = placements.emplace(direction_of(hold.load), placements.size()).first->second;
    }
    holds.holds.push_back(std::move(hold));
  }
  return holds;
}

void PreparedHolds::take_copies_out() {
  auto copies = cal::copies(holds_);
  std::ranges::sort(copies, {}, [](const auto& pair) { return pair.second; });
  for (auto pair = copies.rbegin(); pair != copies.rend(); ++pair) {
    warnings_.push_back(
        fmt::format("rows {} and {} are the same to the last digit, load and signals: one of them "
                    "counts",
                    holds_.holds[pair->first].row, holds_.holds[pair->second].row));
    const auto at = static_cast<std::ptrdiff_t>(pair->second);
    holds_.holds.erase(holds_.holds.begin() + at);
    measured_.holds.erase(measured_.holds.begin() + at);
  }
}

void PreparedHolds::take_errors() {
  if (script_ != nullptr) {
    std::vector<const LoadStep*> steps;
    for (const MeasuredHold& one : measured_.holds) steps.push_back(&script_->steps.at(one.step - 1));
    holds_.load_error = load_errors(steps, components_);
    return;
  }
  if (!(options_.tolerance > 0.0)) return;
  std::size_t loads = 0;
  for (const cal::Hold& hold : holds_.holds) loads = std::max(loads, hold.load_number + 1);
  const auto count = static_cast<Eigen::Index>(components_.size());
  holds_.load_error.setZero(static_cast<Eigen::Index>(holds_.holds.size()) * count,
                            static_cast<Eigen::Index>(loads));
  for (std::size_t i = 0; i < holds_.holds.size(); ++i) {
    for (Eigen::Index k = 0; k < count; ++k) {
      holds_.load_error(static_cast<Eigen::Index>(i) * count + k,
                        static_cast<Eigen::Index>(holds_.holds[i].load_number)) =
          options_.tolerance / std::numbers::sqrt3 * holds_.holds[i].load[static_cast<std::size_t>(k)];
    }
  }
}

}  // namespace kerf::bench
