#include <thread>

#include <gtest/gtest.h>

#include <kerf/drivers/device.h>

#include "loop/clock.h"
#include "loop/law_switch.h"
#include "loop/loop.h"
#include "loop/recorder.h"
#include "loop/watchdog.h"
#include "support/program.h"

// Everything that runs beside the loop, at once: the writer, the watchdog on a device that stalls, and a
// thread that changes laws. Built and run with the thread sanitizer by scripts/test; without it, it shows
// that nothing is lost.

namespace kerf::bench {
namespace {

LawRendering spring(double stiffness) {
  const std::array values{stiffness, 1.0, 1.0};
  return {models::Law::make("kelvin", values), {.position = 1.0, .direction = -1.0}, {0}};
}

TEST(Race, IsNoneBetweenLoopWriterWatchdogAndWhoChangesLaws) {
  const test::TemporaryFolder folder;
  const auto device = drivers::open_device("sim:scissors?fault=stall@0.1:40ms,stall@0.3:40ms,nan@0.4");
  Recorder recorder({folder / "r.h5",
                     schema::new_header("kerf test"),
                     {{.name = "theta", .position_unit = "rad"}, {.name = "x_s"}},
                     {.measures_force = true}},
                    {});
  LawSwitch laws({{.rendering = spring(1.0)}, {.rendering = spring(2.0)}}, 0.02);
  std::atomic<bool> stop{false};
  std::atomic<std::size_t> done{0};
  Heartbeat heartbeat;
  LoopReport report;
  {
    const Watchdog watchdog(*device, heartbeat, 1e-3);
    std::jthread loop([&] {
      WallClock clock;
      run_loop(clock, *device, laws, recorder, {.ticks = 600},
               {.stop = stop, .done = done, .heartbeat = heartbeat}, report);
    });
    for (std::size_t turn = 0; done < 600; ++turn) {
      laws.select(turn % 2);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  recorder.close("complete");
  EXPECT_EQ(report.ticks(), 600U);
  EXPECT_GE(report.ticks_with(schema::flag_watchdog), 2U);
  EXPECT_EQ(schema::read_recording(folder / "r.h5").rows() + recorder.lost(), report.executed);
}

}  // namespace
}  // namespace kerf::bench
