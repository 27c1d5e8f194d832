#include <thread>

#include <gtest/gtest.h>

#include <kerf/drivers/device.h>

#include "live/live_rendering.h"
#include "live/row_history.h"
#include "loop/clock.h"
#include "loop/law_switch.h"
#include "loop/loop.h"
#include "loop/watchdog.h"
#include "record/recorder.h"
#include "record/row_tap.h"
#include "support/program.h"

// Everything that runs beside the loop, at once: the writer, the watchdog on a device that stalls, who
// changes laws, takes rows out, looks at them and takes the force away. Built and run with the thread
// sanitizer by scripts/test; without it, it shows that nothing is lost.

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

/// What the tick leaves goes to the rendering and then to the tap, as LiveHub has it.
struct TapLog {
  LiveRendering& rendering;
  RowTap& tap;
  void push(const schema::Row& row) noexcept {
    rendering.record(row);
    tap.push(row);
  }
};

TEST(Race, IsNoneBetweenLoopDrainViewersAndWhoSteers) {
  const auto device = drivers::open_device("sim:scissors");
  LiveRendering rendering(0.01);
  RowTap tap(64);
  RowHistory history(device->info(), 1e-3);
  const std::atomic<bool> stop{false};
  std::atomic<std::size_t> done{0};
  std::atomic<bool> is_over{false};
  std::uint64_t drained = 0;
  std::uint64_t changes = 0;
  Heartbeat heartbeat;
  LoopReport report;
  const auto drain = [&] {
    std::vector<schema::Row> rows(RowRing::max_popped);
    while (const std::size_t count = tap.pop(rows.data())) {
      history.append({rows.data(), count});
      drained += count;
    }
    for (LiveChange change; rendering.take_change(change);) ++changes;
    (void)rendering.collect();
  };
  {
    std::jthread loop([&] {
      WallClock clock;
      TapLog log{rendering, tap};
      run_loop(clock, *device, rendering, log, {.ticks = 600},
               {.stop = stop, .done = done, .heartbeat = heartbeat}, report);
      is_over = true;
    });
    std::jthread hub([&] {
      while (!is_over) {
        drain();
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    });
    std::jthread viewer([&] {
      const std::vector<std::size_t> traces{0, 1};
      for (std::uint64_t next = 0; !is_over;) {
        next = history.frame_since(next, 3, 100).next;
        (void)history.view(traces, 0.0, 1.0, 50);
        std::this_thread::sleep_for(std::chrono::milliseconds(3));
      }
    });
    std::jthread other([&] {
      for (std::size_t turn = 0; !is_over; ++turn) {
        turn % 4 == 0 ? rendering.release() : rendering.resume();
        (void)rendering.is_blending();
        std::this_thread::sleep_for(std::chrono::milliseconds(7));
      }
    });
    for (std::size_t turn = 0; !is_over; ++turn) {
      (void)rendering.offer(turn % 3 == 0 ? nullptr : std::make_unique<LawRendering>(spring(1.0)));
      std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
  }
  drain();
  EXPECT_EQ(drained + tap.lost(), report.executed);
  EXPECT_GT(changes, 2U);
}

}  // namespace
}  // namespace kerf::bench
