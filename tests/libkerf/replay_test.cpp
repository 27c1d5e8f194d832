#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "laws/placement.h"
#include "libkerf/opened.h"
#include "replay/open_loop.h"
#include "support/law_paths.h"

// What `kerf replay` makes of a recording, and what the library gives on the same ticks.

namespace kerf::bench {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true;
#elif defined(__has_feature)
constexpr bool sanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool sanitized = false;
#endif

/// A million, and fewer where the sanitizers watch.
std::uint64_t ticks_for(std::string_view model) {
  if (sanitized) return model == "scissors_mesh" ? 500 : 10'000;
  return 1'000'000;
}

/// Where the tool is, `seconds` after the beginning: in and out of the tissue, each time to another place.
models::AxisValues place_at(const test::LawPath& path, double seconds) {
  const std::array stations{path.outside, path.pressed, path.deeper, path.outside, path.cut, path.reach};
  const double at = std::fmod(2.5 * seconds, static_cast<double>(stations.size()));
  const auto from = static_cast<std::size_t>(at);
  const double share = 0.5 - 0.5 * std::cos(3.14159265358979 * (at - std::floor(at)));
  return test::between(stations[from], stations[(from + 1) % stations.size()], share);
}

/// A recording of the loop at 1 kHz that the tool's way through the law's tissue would have left.
schema::Recording recording_along(const LawFile& law, std::uint64_t ticks) {
  schema::Recording recording;
  recording.header = schema::new_header("kerf test");
  for (const models::LawAxis& axis : axes_of(law))
    recording.axes.push_back(
        {.name = axis.name, .position_unit = axis.position_unit, .force_unit = axis.force_unit});
  const test::LawPath path = test::path_of(law.law.model());
  models::AxisValues before = place_at(path, 0.0);
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    recording.tick.push_back(tick);
    recording.time.push_back(static_cast<double>(tick) * (1.0 / 1000.0));
    const models::AxisValues here = place_at(path, recording.time.back());
    for (std::size_t axis = 0; axis < recording.axes.size(); ++axis) {
      const double along = law.law.is_spatial() ? 1.0 : law.contact.direction;
      recording.position.push_back(law.contact.position + along * here[axis]);
      recording.velocity.push_back(along * (here[axis] - before[axis]) * 1000.0);
      recording.force_commanded.push_back(1.0);
    }
    before = here;
  }
  return recording;
}

class EveryLaw : public testing::TestWithParam<std::string> {};

TEST_P(EveryLaw, GivesInTheLibraryWhatReplayGivesToTheLastBit) {
  const std::string file = test::example_file(GetParam());
  const auto named = read_named_laws({file});
  const Source source = select_rows(recording_along(named[0].file, ticks_for(GetParam())), {}, "a test");
  const std::atomic<bool> stop{false};
  const OpenLoopResult replayed = run_open_loop(source, named, {}, stop);
  const SampledMotion motion = motion_of(source);

  const test::OpenLaw law = test::opened(file);
  const test::OpenState state = test::state_of(law);
  const std::size_t axes = kerf_law_axis_count(law.get());
  ASSERT_EQ(axes, source.recording.dimensions());
  std::size_t pushed = 0;
  for (std::size_t tick = 0; tick < motion.ticks(); ++tick) {
    drivers::Axes force{};
    const auto& [position, velocity] = motion.sample[tick];
    const std::uint32_t flags =
        kerf_step_axes(state.get(), position.data(), velocity.data(), motion.period_s[tick], force.data());
    ASSERT_EQ(flags, replayed.laws[0].flags[tick]) << "tick " << tick;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const double theirs = replayed.laws[0].force[tick][axis];
      ASSERT_EQ(std::bit_cast<std::uint64_t>(force[axis]), std::bit_cast<std::uint64_t>(theirs))
          << "tick " << tick << ", axis " << axis << ": " << force[axis] << " and " << theirs;
      if (force[axis] != 0.0) ++pushed;
    }
  }
  // A law that breaks has its say before it does.
  EXPECT_GT(pushed, sanitized ? 100U : 1000U) << "the tool was hardly in the tissue";
}

std::vector<std::string> all_models() {
  std::vector<std::string> names;
  for (const models::LawInfo& info : models::registry()) names.emplace_back(info.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Libkerf, EveryLaw, testing::ValuesIn(all_models()),
                         [](const auto& of) { return of.param; });

}  // namespace
}  // namespace kerf::bench
