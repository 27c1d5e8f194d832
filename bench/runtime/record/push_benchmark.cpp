#include <atomic>
#include <thread>

#include <fmt/core.h>

#include "host/histogram.h"
#include "loop/clock.h"
#include "record/row_ring.h"

// What a push to the recorder's ring costs while another thread empties it, row after row at 100 kHz. Prints
// JSON.

namespace {

constexpr int pushes = 1'000'000;
constexpr std::int64_t period_ns = 10'000;

}  // namespace

int main() {
  using namespace kerf;
  bench::RowRing ring(8192);
  std::atomic<bool> done{false};
  std::jthread writer([&] {
    std::vector<schema::Row> chunk(bench::RowRing::max_popped);
    while (!done) {
      ring.pop(chunk.data());
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  bench::Histogram cost;
  bench::Histogram nothing;
  schema::Row row;
  std::int64_t next_ns = bench::WallClock::now_ns();
  for (int i = 0; i < pushes; ++i) {
    next_ns += period_ns;
    while (bench::WallClock::now_ns() < next_ns) {
    }
    row.tick = static_cast<std::uint64_t>(i);
    const std::int64_t begin_ns = bench::WallClock::now_ns();
    const bool pushed = ring.push(row);
    const std::int64_t end_ns = bench::WallClock::now_ns();
    nothing.add(bench::WallClock::now_ns() - end_ns);
    if (pushed) cost.add(end_ns - begin_ns);
  }
  done = true;
  fmt::print(R"({{"p50_ns": {}, "p99_ns": {}, "p999_ns": {}, "clock_p50_ns": {}, "pushes": {}}})"
             "\n",
             cost.percentile_ns(0.5), cost.percentile_ns(0.99), cost.percentile_ns(0.999),
             nothing.percentile_ns(0.5), cost.count());
}
