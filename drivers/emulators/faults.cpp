#include "faults.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

namespace kerf::emulators {
namespace {

using Kind = Fault::Kind;

/// What stands behind the second.
enum class Takes : std::uint8_t { nothing, count, count_and_seed, time_and_duration, duration };
struct Name {
  std::string_view text;
  Kind kind;
  Takes takes;
};
constexpr std::array<Name, 14> names{{{"drop", Kind::drop, Takes::count},
                                      {"split", Kind::split, Takes::count},
                                      {"corrupt", Kind::corrupt, Takes::count},
                                      {"stall", Kind::stall, Takes::count},
                                      {"duplicate", Kind::duplicate, Takes::count},
                                      {"flip", Kind::flip, Takes::count_and_seed},
                                      {"delay", Kind::delay, Takes::time_and_duration},
                                      {"refuse-out", Kind::refuse_out, Takes::duration},
                                      {"stick", Kind::stick, Takes::duration},
                                      {"unplug", Kind::unplug, Takes::nothing},
                                      {"swap", Kind::swap, Takes::count},
                                      {"silence", Kind::silence, Takes::duration},
                                      {"overload", Kind::overload, Takes::duration},
                                      {"restart", Kind::restart, Takes::duration}}};
constexpr std::array of_network{Kind::drop,  Kind::corrupt, Kind::duplicate,
                                Kind::delay, Kind::stick,   Kind::unplug};

Kind kind_of(Disturbance disturbance) noexcept {
  switch (disturbance) {
    case Disturbance::split:
      return Kind::split;
    case Disturbance::corrupt:
      return Kind::corrupt;
    default:
      return Kind::drop;
  }
}

template <typename Number>
bool reads(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

/// "20ms" or "1.5s".
bool reads_time(std::string_view text, double& time_s) {
  double scale = 1.0;
  if (text.ends_with("ms")) {
    scale = 1e-3;
    text.remove_suffix(1);
  }
  if (!text.ends_with('s') && scale == 1.0) return false;
  text.remove_suffix(1);
  if (!reads(text, time_s) || !(time_s > 0.0)) return false;
  time_s *= scale;
  return true;
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (auto colon = text.find(':'); colon != std::string_view::npos; colon = text.find(':')) {
    words.push_back(text.substr(0, colon));
    text.remove_prefix(colon + 1);
  }
  words.push_back(text);
  return words;
}

bool reads_words(const std::vector<std::string_view>& words, Takes takes, Fault& fault) {
  const bool first = words.size() > 1;
  const bool second = words.size() > 2;
  if (words.size() > 3 || !reads(words[0], fault.at_s) || !(fault.at_s >= 0.0)) return false;
  switch (takes) {
    case Takes::nothing:
      return !first;
    case Takes::count:
      return !second && (!first || (reads(words[1], fault.count) && fault.count > 0));
    case Takes::count_and_seed:
      return (!first || (reads(words[1], fault.count) && fault.count > 0)) &&
             (!second || reads(words[2], fault.seed));
    case Takes::time_and_duration:
      return first && reads_time(words[1], fault.delay_s) &&
             (!second || reads_time(words[2], fault.duration_s));
    case Takes::duration:
      return first && !second && reads_time(words[1], fault.duration_s);
  }
  return false;
}

Fault parse_fault(std::string_view text) {
  const auto at = text.find('@');
  const auto* name = std::ranges::find(names, text.substr(0, at), &Name::text);
  Fault fault;
  if (at != std::string_view::npos && name != names.end()) {
    fault.kind = name->kind;
    if (reads_words(words_of(text.substr(at + 1)), name->takes, fault)) return fault;
  }
  throw std::invalid_argument(
      "fault '" + std::string(text) +
      "': expected KIND@SECONDS, for drop, split, corrupt, stall, duplicate and swap with :COUNT, for flip "
      "with "
      ":COUNT:SEED, for delay with :TIME:DURATION, for refuse-out, stick, silence, overload and restart with "
      ":DURATION, or unplug; for example drop@2.0:3 or refuse-out@2.0:30ms");
}

/// A number that looks drawn, the next of a row by its place in it (SplitMix64).
std::uint64_t drawn(std::uint64_t place) noexcept {
  std::uint64_t bits = place * 0x9E3779B97F4A7C15U;
  bits = (bits ^ bits >> 30U) * 0xBF58476D1CE4E5B9U;
  bits = (bits ^ bits >> 27U) * 0x94D049BB133111EBU;
  return bits ^ bits >> 31U;
}

}  // namespace

std::vector<Fault> parse_faults(std::string_view text) {
  std::vector<Fault> faults;
  while (!text.empty()) {
    const auto comma = std::min(text.find(','), text.size());
    faults.push_back(parse_fault(text.substr(0, comma)));
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return faults;
}

namespace {

void check(const std::vector<Fault>& faults, std::string_view where, bool (*happens)(Kind)) {
  for (const Fault& fault : faults) {
    if (happens(fault.kind)) continue;
    const auto* name = std::ranges::find(names, fault.kind, &Name::kind);
    throw std::invalid_argument("fault '" + std::string(name->text) + "': it does not happen " +
                                std::string(where));
  }
}

}  // namespace

void check_faults_of_usb(const std::vector<Fault>& faults) {
  check(faults, "on the USB", [](Kind kind) { return kind <= Kind::unplug; });
}

void check_faults_of_network(const std::vector<Fault>& faults) {
  check(faults, "in the network", [](Kind kind) {
    return kind >= Kind::unplug || std::ranges::find(of_network, kind) != of_network.end();
  });
}

void check_faults_of_line(const std::vector<Fault>& faults) {
  check_faults_of_network(faults);
  check(faults, "on a serial line",
        [](Kind kind) { return kind != Kind::delay && kind != Kind::stick && kind != Kind::swap; });
}

const Fault* FaultPlan::find(Kind kind, double time_s) const noexcept {
  for (const Fault& fault : faults_) {
    if (fault.kind == kind && fault.count > 0 && time_s >= fault.at_s &&
        time_s < fault.at_s + fault.duration_s) {
      return &fault;
    }
  }
  return nullptr;
}

bool FaultPlan::count(Kind kind, double time_s) noexcept {
  const Fault* found = find(kind, time_s);
  if (found == nullptr) return false;
  --faults_[static_cast<std::size_t>(found - faults_.data())].count;
  return true;
}

Disturbance FaultPlan::due(double time_s) const noexcept {
  if (find(Kind::drop, time_s) != nullptr) return Disturbance::drop;
  if (find(Kind::split, time_s) != nullptr) return Disturbance::split;
  if (find(Kind::corrupt, time_s) != nullptr) return Disturbance::corrupt;
  return Disturbance::none;
}

void FaultPlan::done(Disturbance disturbance, double time_s) noexcept {
  (void)count(kind_of(disturbance), time_s);
}

bool FaultPlan::stalls(double time_s) noexcept { return count(Kind::stall, time_s); }

bool FaultPlan::duplicates(double time_s) noexcept { return count(Kind::duplicate, time_s); }

std::optional<std::uint64_t> FaultPlan::flips(double time_s) noexcept {
  const Fault* found = find(Kind::flip, time_s);
  if (found == nullptr) return std::nullopt;
  const std::uint64_t number = drawn(found->seed << 32U ^ found->count);
  (void)count(Kind::flip, time_s);
  return number;
}

double FaultPlan::delay_s(double time_s) const noexcept {
  const Fault* found = find(Kind::delay, time_s);
  return found == nullptr ? 0.0 : found->delay_s;
}

std::optional<double> FaultPlan::refuses_until_s(double time_s) const noexcept {
  const Fault* found = find(Kind::refuse_out, time_s);
  return found == nullptr ? std::nullopt : std::optional(found->at_s + found->duration_s);
}

bool FaultPlan::sticks(double time_s) const noexcept { return find(Kind::stick, time_s) != nullptr; }

bool FaultPlan::swaps(double time_s) noexcept { return count(Kind::swap, time_s); }

bool FaultPlan::is_silent(double time_s) const noexcept { return find(Kind::silence, time_s) != nullptr; }

bool FaultPlan::is_overloaded(double time_s) const noexcept {
  return find(Kind::overload, time_s) != nullptr;
}

bool FaultPlan::is_without_power(double time_s) const noexcept {
  return find(Kind::restart, time_s) != nullptr;
}

std::optional<double> FaultPlan::unplugged_at_s() const noexcept {
  std::optional<double> first;
  for (const Fault& fault : faults_) {
    if (fault.kind == Kind::unplug) first = std::min(first.value_or(fault.at_s), fault.at_s);
  }
  return first;
}

}  // namespace kerf::emulators
