#include "faults.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>
#include <utility>

namespace kerf::emulators {
namespace {

constexpr std::array<std::pair<std::string_view, Fault::Kind>, 5> kinds{{{"drop", Fault::Kind::drop},
                                                                         {"split", Fault::Kind::split},
                                                                         {"corrupt", Fault::Kind::corrupt},
                                                                         {"stall", Fault::Kind::stall},
                                                                         {"unplug", Fault::Kind::unplug}}};

Fault::Kind kind_of(Disturbance disturbance) noexcept {
  switch (disturbance) {
    case Disturbance::split:
      return Fault::Kind::split;
    case Disturbance::corrupt:
      return Fault::Kind::corrupt;
    default:
      return Fault::Kind::drop;
  }
}

template <typename Number>
bool reads(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

Fault parse_fault(std::string_view text) {
  const auto at = text.find('@');
  const auto* kind = std::ranges::find(kinds, text.substr(0, at), [](const auto& one) { return one.first; });
  Fault fault;
  bool good = at != std::string_view::npos && kind != kinds.end();
  if (good) {
    fault.kind = kind->second;
    std::string_view rest = text.substr(at + 1);
    const auto colon = rest.find(':');
    if (colon != std::string_view::npos) good = reads(rest.substr(colon + 1), fault.count) && fault.count > 0;
    good = good && reads(rest.substr(0, colon), fault.at_s) && fault.at_s >= 0.0;
  }
  if (good) return fault;
  throw std::invalid_argument(
      "fault '" + std::string(text) +
      "': expected KIND@SECONDS or KIND@SECONDS:COUNT, KIND one of drop, split, corrupt, "
      "stall, unplug; for example drop@2.0:3");
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

const Fault* FaultPlan::find(Fault::Kind kind, double time_s) const noexcept {
  for (const Fault& fault : faults_) {
    if (fault.kind == kind && fault.count > 0 && time_s >= fault.at_s) return &fault;
  }
  return nullptr;
}

void FaultPlan::count(Fault::Kind kind, double time_s) noexcept {
  if (const Fault* found = find(kind, time_s))
    --faults_[static_cast<std::size_t>(found - faults_.data())].count;
}

Disturbance FaultPlan::due(double time_s) const noexcept {
  if (find(Fault::Kind::drop, time_s) != nullptr) return Disturbance::drop;
  if (find(Fault::Kind::split, time_s) != nullptr) return Disturbance::split;
  if (find(Fault::Kind::corrupt, time_s) != nullptr) return Disturbance::corrupt;
  return Disturbance::none;
}

void FaultPlan::done(Disturbance disturbance, double time_s) noexcept { count(kind_of(disturbance), time_s); }

bool FaultPlan::stalls(double time_s) noexcept {
  const bool does = find(Fault::Kind::stall, time_s) != nullptr;
  count(Fault::Kind::stall, time_s);
  return does;
}

std::optional<double> FaultPlan::unplugged_at_s() const noexcept {
  std::optional<double> first;
  for (const Fault& fault : faults_) {
    if (fault.kind == Fault::Kind::unplug) first = std::min(first.value_or(fault.at_s), fault.at_s);
  }
  return first;
}

}  // namespace kerf::emulators
