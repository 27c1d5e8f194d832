#include "stability/stability_verdict.h"

namespace kerf::bench {

std::string_view name_of(Stable stable) noexcept {
  switch (stable) {
    case Stable::yes:
      return "yes";
    case Stable::no:
      return "no";
    case Stable::not_judged:
      break;
  }
  return "not judged";
}

std::string why_not_judged(const StabilityVerdict& verdict) {
  return verdict.stable == Stable::not_judged ? verdict.why : std::string();
}

nlohmann::ordered_json to_json(Stable stable) {
  if (stable == Stable::not_judged) return nullptr;
  return stable == Stable::yes;
}

Stable stable_from(const nlohmann::ordered_json& value) {
  if (value.is_null()) return Stable::not_judged;
  return value.get<bool>() ? Stable::yes : Stable::no;
}

}  // namespace kerf::bench
