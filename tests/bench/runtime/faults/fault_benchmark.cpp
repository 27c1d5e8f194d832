#include <atomic>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <exception>
#include <thread>
#include <vector>

#include <fmt/core.h>

#include "fault_schedule.h"

// Random fault schedules on all processors: kerf_fault_benchmark EXAMPLES FIRST COUNT. Prints every violation
// with its seed, and JSON at the end.

namespace {

int benchmark(int argc, char** argv) {
  using namespace kerf;
  std::uint64_t first = 1;
  std::uint64_t count = 0;
  const auto reads = [&](int at, std::uint64_t& number) {
    return std::from_chars(argv[at], argv[at] + std::strlen(argv[at]), number).ec == std::errc{};
  };
  if (argc != 4 || !reads(2, first) || !reads(3, count)) {
    fmt::print(stderr, "usage: {} EXAMPLES FIRST COUNT\n", argv[0]);
    return 2;
  }
  const std::vector<bench::LawFile> laws = test::every_law(argv[1]);
  std::atomic<std::uint64_t> next{first};
  std::atomic<std::uint64_t> ticks{0};
  std::atomic<std::uint64_t> with_force{0};
  std::atomic<std::uint64_t> violations{0};
  {
    std::vector<std::jthread> workers;
    for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) {
      workers.emplace_back([&] {
        for (std::uint64_t seed = next++; seed < first + count; seed = next++) {
          const test::ScheduleOutcome outcome = test::run_schedule(seed, laws);
          ticks += outcome.ticks;
          with_force += outcome.with_force;
          if (outcome.violation.empty()) continue;
          ++violations;
          fmt::print("{}\n", outcome.violation);
        }
      });
    }
  }
  fmt::print(R"({{"schedules": {}, "ticks": {}, "with_force": {}, "violations": {}}})"
             "\n",
             count, ticks.load(), with_force.load(), violations.load());
  return violations == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return benchmark(argc, argv);
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
    return 1;
  }
}
