#include <cstddef>
#include <mutex>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "views/rows/row_preparation.h"

// Built and run with the thread sanitizer by scripts/test; without it, it shows that nothing is lost.

namespace kerf::bench {
namespace {

TEST(Race, IsNoneBetweenThePreparationOfRowsAndRequests) {
  constexpr int parts = 1000;
  std::mutex mutex;
  std::vector<int> made;
  RowPreparation preparation;
  preparation.start(parts, [&](const RowPreparation::GoOn& go_on) {
    for (int part = 0; part < parts; ++part) {
      go_on(1);
      const std::lock_guard lock(mutex);
      made.push_back(part);
    }
  });
  std::vector<std::thread> viewers;
  for (int viewer = 0; viewer < 3; ++viewer) {
    viewers.emplace_back([&] {
      for (int turn = 0; turn < 200; ++turn) {
        const RowPreparation::Request request(preparation);
        preparation.rethrow_failure();
        const std::lock_guard lock(mutex);
        const bool is_done = preparation.done() == 1.0;
        EXPECT_TRUE(!is_done || made.size() == parts);
      }
    });
  }
  for (std::thread& viewer : viewers) viewer.join();
  while (preparation.done() < 1.0) std::this_thread::yield();
  EXPECT_EQ(made.size(), std::size_t{parts});
}

}  // namespace
}  // namespace kerf::bench
