#include <algorithm>
#include <cmath>
#include <string_view>

#include <kerf/drivers/protocols/inverse3.h>

#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

using namespace drivers;

/// Whatever a service sends: what is taken for a state has a place that is one.
void fuzz_inverse3(Bytes bytes) {
  // NOLINTNEXTLINE(*-reinterpret-cast): what comes is text
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  (void)inverse3::naming_of(text);
  for (const char* const device : {"", "04BA"}) {
    const auto state = inverse3::parse(text, device);
    if (!state) continue;
    const auto finite = [](const auto& vector) {
      return std::ranges::all_of(vector, [](double one) { return std::isfinite(one); });
    };
    promise(finite(state->position_m) && finite(state->velocity_m_s), "a state has numbers");
    promise(!state->force_n || finite(*state->force_n), "a force that is told is one");
    promise(*device == '\0' || state->device == device, "it is the one that was asked for");
  }
}

const Registered registered("inverse3", fuzz_inverse3);

}  // namespace
}  // namespace kerf::fuzz
