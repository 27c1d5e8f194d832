#include "regress/path.h"

#include <bit>
#include <cstdint>
#include <stdexcept>

#include <fmt/core.h>

#include "laws/law_toml.h"
#include "laws/plugin_laws.h"
#include "recordings/provenance.h"
#include "regress/renderers/recorded_table.h"

namespace kerf::bench {
namespace {

void add_bytes(std::string& bytes, double value) {
  auto bits = std::bit_cast<std::uint64_t>(value);
  for (int i = 0; i < 8; ++i, bits >>= 8U) bytes += static_cast<char>(bits & 0xFFU);
}

}  // namespace

SampledMotion path_of(const RegressionCase& one) {
  SampledMotion path;
  try {
    path = !one.trajectory.empty() ? read_trajectory(one.trajectory, axes_of(one))
           : one.outside           ? sampled(one.motion, one.outside->axes)
                                   : sampled(one.motion, one.law);
  } catch (const std::invalid_argument& error) {
    const std::string source =
        one.motion.recording.empty() ? one.motion.scene.string() : one.motion.recording.string();
    const std::string what = error.what();
    throw std::invalid_argument(fmt::format(
        "case '{}': {}{}", one.name, source.empty() || what.starts_with(source) ? "" : source + ": ", what));
  }
  if (path.ticks() == 0)
    throw std::invalid_argument(fmt::format("case '{}': its trajectory has no tick", one.name));
  return path;
}

std::string checksum(const SampledMotion& motion, std::size_t axes) {
  std::string bytes;
  for (std::size_t tick = 0; tick < motion.ticks(); ++tick) {
    add_bytes(bytes, motion.period_s[tick]);
    for (std::size_t i = 0; i < axes; ++i) {
      add_bytes(bytes, motion.sample[tick].position[i]);
      add_bytes(bytes, motion.sample[tick].velocity[i]);
    }
  }
  return sha256_of(std::string_view(bytes));
}

std::string checksum(const LawFile& law) {
  LawFile bare = law;
  bare.std_errors.clear();
  bare.fit = {};
  std::string text = to_toml(bare);
  // A plug-in that was built anew is the same law, whose forces are compared.
  const std::string plugin = plugin_text(law.law);
  if (!plugin.empty()) text.erase(text.find(plugin), plugin.size());
  return sha256_of(std::string_view(text));
}

std::string checksum(const RegressionCase& one) {
  return one.outside ? checksum(*one.outside) : checksum(one.law);
}

}  // namespace kerf::bench
