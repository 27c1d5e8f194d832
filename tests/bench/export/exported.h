#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <kerf/kerf.h>

#include "exported_law.h"
#include "libkerf/opened.h"
#include "support/program.h"

namespace kerf::test {

// A sanitizer's library would have to be in the host as well.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool hosts_can_load_libkerf = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
inline constexpr bool hosts_can_load_libkerf = false;
#else
inline constexpr bool hosts_can_load_libkerf = true;
#endif
#else
inline constexpr bool hosts_can_load_libkerf = true;
#endif

/// A law as `kerf export` hands it to a host.
inline bench::ExportedLaw exported(const std::string& name, const std::string& text) {
  return {.name = name,
          .file = bench::parse_law_file(text, name + ".law.toml"),
          .text = text,
          .sha256 = kerf_law_sha256(parsed(text).get()),
          .plain_c = ""};
}

/// The host's files in a folder of their own.
inline void write_files(const bench::Host& host, const bench::ExportedLaw& law,
                        const std::filesystem::path& folder) {
  for (const bench::HostFile& file : host.files(law)) {
    std::filesystem::create_directories((folder / file.name).parent_path());
    write_text(folder / file.name, file.content);
  }
}

/// Presses from -2 mm to `deep` and back in `ticks`, unevenly in time, about a contact that leads that way.
inline std::vector<bench::HostSample> pressed(double contact, double direction, double deep, int ticks) {
  std::vector<bench::HostSample> samples;
  double last = contact;
  for (int tick = 0; tick < ticks; ++tick) {
    const double elapsed_s = 1e-3 * (1.0 + 0.5 * std::sin(0.7 * tick));
    const double depth = deep * std::sin(3.1 * tick / ticks) - 0.002;
    const double position = contact + direction * depth;
    samples.push_back({position, (position - last) / elapsed_s, elapsed_s});
    last = position;
  }
  return samples;
}

/// What kerf_step() gives along the same ticks.
inline std::vector<double> forces_of_library(const std::string& text,
                                             const std::vector<bench::HostSample>& samples) {
  const OpenLaw law = parsed(text);
  const OpenState state = state_of(law);
  std::vector<double> forces;
  for (const bench::HostSample& sample : samples) {
    double force = 0.0;
    const std::uint32_t flags =
        kerf_step(state.get(), sample.position, sample.velocity, sample.elapsed_s, &force);
    forces.push_back(flags == 0 ? force : std::nan(""));
  }
  return forces;
}

/// Bit for bit; all that is no number is the same.
inline std::vector<std::uint64_t> bits_of(const std::vector<double>& numbers) {
  std::vector<std::uint64_t> bits;
  for (const double number : numbers)
    bits.push_back(std::bit_cast<std::uint64_t>(std::isnan(number) ? std::nan("") : number));
  return bits;
}

/// A law with memory on an axis of its own, from 10 mm down, in a file whose text could end a literal, a line
/// or a comment of a source.
inline const std::string nasty_law = R"(# "quoted" \ )"
                                     "\t"
                                     R"(%NAME% %TEXT% ??/ */ /* )delimiter" µ · @"{0}
# \
model = "maxwell"
axis = "x"
[contact]
position = { value = 10, unit = "mm" }
direction = "decreasing"
[parameters]
parallel_stiffness = { value = 100, unit = "N/m" }
stiffness = { value = [50, 70], unit = "N/m" }
relaxation_time = { value = [0.02, 0.4], unit = "s" }
[fit]
recording = "%TEXT%\n#error \" */ \u2028 \u202e \\"
sha256 = "0"
rmse = { value = 0.01, unit = "N" }
date = "2026-11-30"
software = "\r\n#error"
)";

}  // namespace kerf::test
