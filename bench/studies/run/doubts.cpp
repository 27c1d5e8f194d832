#include "run/doubts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <span>
#include <string_view>

#include <fmt/core.h>

#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

struct MistakenUnit {
  double factor;  ///< by which values are too large
  std::string_view words;
};

constexpr double degrees = 180.0 / std::numbers::pi;
constexpr std::array mistaken_positions{
    MistakenUnit{1000.0, "mm taken for m"}, MistakenUnit{10.0, "mm taken for cm"},
    MistakenUnit{25.4, "mm taken for inches"}, MistakenUnit{degrees, "degrees taken for radians"}};
constexpr std::array mistaken_forces{
    MistakenUnit{1000.0, "mN taken for N, or gf for kgf"}, MistakenUnit{101.97, "gf taken for N"},
    MistakenUnit{9.80665, "N taken for kgf, or gf for mN"}, MistakenUnit{4.4482, "N taken for lbf"}};
constexpr std::array mistaken_times{MistakenUnit{1000.0, "ms taken for s"},
                                    MistakenUnit{1e6, "us taken for s"},
                                    MistakenUnit{60.0, "s taken for min"}};

constexpr double near_a_unit = 1.4;  // of another unit's factor: none are nearer to each other than 2.2 times
constexpr double far_whatever_unit = 5.0;  // no tissue differs so from its like
constexpr std::size_t fewest_others = 3;
constexpr double fewest_spreads = 3.0;

struct HeldQuantity {
  std::string_view name;
  std::function<double(const StudiedRecording&)> of;
  std::span<const MistakenUnit> mistakes;
  bool of_the_tissue = false;  ///< and of the speed, where there are enough of it
};

bool is_comparable(const DrawerRecording& one, const DrawerRecording& other) {
  return other.result.failure.empty() && !other.file.blank &&
         other.result.axis.empty() == one.result.axis.empty() &&
         other.result.position_unit == one.result.position_unit &&
         other.result.force_unit == one.result.force_unit;
}

/// Logarithms of what the others have.
std::vector<double> of_others(const std::vector<DrawerRecording>& recordings, std::size_t at,
                              const HeldQuantity& quantity, bool of_the_speed) {
  const DrawerRecording& one = recordings[at];
  std::vector<double> others;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const DrawerRecording& other = recordings[i];
    if (i == at || !is_comparable(one, other)) continue;
    if (quantity.of_the_tissue && other.file.tissue != one.file.tissue) continue;
    if (of_the_speed && other.file.speed != one.file.speed) continue;
    if (const double there = quantity.of(other.result); there > 0.0) others.push_back(std::log(there));
  }
  return others;
}

/// "9.8 times" or "1/9.8 of".
std::string times_in_words(double ratio) {
  return ratio >= 1.0 ? fmt::format("{:.3g} times", ratio) : fmt::format("1/{:.3g} of", 1.0 / ratio);
}

std::string unit_in_words(double ratio, std::span<const MistakenUnit> mistakes) {
  for (const MistakenUnit& mistake : mistakes) {
    if (std::abs(std::log(ratio / mistake.factor)) < std::log(near_a_unit))
      return fmt::format(": {}?", mistake.words);
    if (std::abs(std::log(ratio * mistake.factor)) < std::log(near_a_unit))
      return fmt::format(": the other way round than {}?", mistake.words);
  }
  return "";
}

void doubt_unit(std::vector<DrawerRecording>& recordings, std::size_t at, const HeldQuantity& quantity) {
  DrawerRecording& one = recordings[at];
  const double value = quantity.of(one.result);
  std::vector<double> others = of_others(recordings, at, quantity, quantity.of_the_tissue);
  if (others.size() < fewest_others) others = of_others(recordings, at, quantity, false);
  if (others.size() < fewest_others || !(value > 0.0)) return;
  const double usual = quantile(others, 0.5);
  std::vector<double> apart;
  for (const double other : others) apart.push_back(std::abs(other - usual));
  const double distance = std::abs(std::log(value) - usual);
  if (distance < fewest_spreads * quantile(apart, 0.5)) return;
  const double ratio = value / std::exp(usual);
  const std::string words = unit_in_words(ratio, quantity.mistakes);
  if (words.empty() && distance < std::log(far_whatever_unit)) return;
  one.doubts.push_back(
      fmt::format("its {} is {} what is usual for the other {} recordings{} ({:.3g} against {:.3g}){}",
                  quantity.name, times_in_words(ratio), others.size(),
                  quantity.of_the_tissue ? " of " + one.file.tissue : "", value, std::exp(usual), words));
}

/// One law cannot serve an angle and a length.
void doubt_kind_of_axis(std::vector<DrawerRecording>& recordings) {
  std::map<std::string, std::size_t> kinds;
  const auto kind_of = [](const DrawerRecording& one) {
    return one.result.force_unit + " over " + one.result.position_unit;
  };
  for (const DrawerRecording& one : recordings)
    if (one.result.failure.empty() && !one.file.blank) ++kinds[kind_of(one)];
  if (kinds.size() < 2) return;
  const auto usual = std::ranges::max_element(kinds, {}, [](const auto& kind) { return kind.second; });
  for (DrawerRecording& one : recordings)
    if (one.result.failure.empty() && kind_of(one) != usual->first)
      one.doubts.push_back(fmt::format("it has {}, and most have {}", kind_of(one), usual->first));
}

void doubt_cycles(std::vector<DrawerRecording>& recordings) {
  for (DrawerRecording& one : recordings) {
    const auto& cycles = one.result.cycles;
    if (one.file.blank || cycles.empty()) continue;
    if (std::ranges::none_of(cycles, [](const StudiedCycle& cycle) { return cycle.is_good; }))
      one.doubts.push_back(fmt::format("none of its {} cycles is good; of the first, {}", cycles.size(),
                                       cycles.front().reason));
  }
}

void doubt_closing(std::vector<DrawerRecording>& recordings) {
  double directions = 0.0;
  for (const DrawerRecording& one : recordings)
    if (!one.file.blank) directions += one.result.closing_direction;
  for (DrawerRecording& one : recordings) {
    if (!one.file.blank && directions * one.result.closing_direction < 0.0)
      one.doubts.emplace_back(
          "it closes the other way round than most; 'closing' in study.toml says which way it is");
  }
}

/// What is less a blank and what is not are no recordings of one kind.
void doubt_blanks(std::vector<DrawerRecording>& recordings) {
  const auto is_less = [](const DrawerRecording& one) {
    return one.result.blank && one.result.blank->is_taken();
  };
  for (DrawerRecording& one : recordings) {
    if (!one.result.blank || is_less(one)) continue;
    const auto others = std::ranges::count_if(recordings, [&](const DrawerRecording& other) {
      return other.file.tissue == one.file.tissue && other.file.speed == one.file.speed && is_less(other);
    });
    if (others > 0)
      one.doubts.push_back(fmt::format("no blank was taken off it, but off {} of its tissue and speed ({})",
                                       others, one.result.blank->why_none));
  }
}

double mean_peak(const StudiedRecording& result) {
  const std::vector<double> peaks = of_cycles(result, &StudiedCycle::peak);
  if (peaks.empty()) return result.peak;
  return std::accumulate(peaks.begin(), peaks.end(), 0.0) / static_cast<double>(peaks.size());
}

void hold_to_blanks(std::vector<DrawerRecording>& recordings) {
  constexpr double large_share = 0.3;
  const auto is_blank = [](const DrawerRecording& one) {
    return one.file.blank && one.result.failure.empty();
  };
  for (DrawerRecording& one : recordings) {
    if (one.file.blank || !one.result.failure.empty()) continue;
    if (one.result.blank && one.result.blank->is_taken()) continue;
    const bool has_own = std::ranges::any_of(recordings, [&](const DrawerRecording& other) {
      return is_blank(other) && other.file.speed == one.file.speed;
    });
    double most = 0.0;
    for (const DrawerRecording& other : recordings)
      if (is_blank(other) && (!has_own || other.file.speed == one.file.speed))
        most = std::max(most, mean_peak(other.result));
    const double share = most / mean_peak(one.result);
    if (share > large_share) one.share_of_tool = share;
  }
}

}  // namespace

void doubt_recordings(std::vector<DrawerRecording>& recordings, bool all_cycles) {
  const std::array quantities{
      HeldQuantity{"travel", [](const StudiedRecording& one) { return one.travel; }, mistaken_positions},
      HeldQuantity{"usual step of time", [](const StudiedRecording& one) { return one.period_s; },
                   mistaken_times},
      HeldQuantity{"peak force", mean_peak, mistaken_forces, true}};
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (recordings[i].file.blank || !recordings[i].result.failure.empty()) continue;
    for (const HeldQuantity& quantity : quantities) doubt_unit(recordings, i, quantity);
  }
  if (!all_cycles) doubt_cycles(recordings);
  doubt_kind_of_axis(recordings);
  doubt_closing(recordings);
  doubt_blanks(recordings);
  hold_to_blanks(recordings);
}

}  // namespace kerf::bench
