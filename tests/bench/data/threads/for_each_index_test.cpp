#include "threads/for_each_index.h"

#include <atomic>
#include <new>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

TEST(ForEachIndex, CallsForEachOnce) {
  for (const std::size_t threads : {0U, 1U, 2U, 7U}) {
    std::vector<std::atomic<int>> calls(100);
    for_each_index(calls.size(), threads, [&](std::size_t i) { ++calls[i]; });
    for (const auto& count : calls) EXPECT_EQ(count, 1) << threads;
  }
  for_each_index(0, 4, [](std::size_t) { FAIL(); });
}

TEST(ForEachIndex, ThrowsHereWhatAnotherThreadThrew) {
  const auto here = std::this_thread::get_id();
  std::atomic<bool> is_thrown{false};
  const auto throw_elsewhere = [&](std::size_t) {
    while (std::this_thread::get_id() == here && !is_thrown) std::this_thread::yield();
    is_thrown = true;
    if (std::this_thread::get_id() != here) throw std::bad_alloc();
  };
  EXPECT_THROW(for_each_index(1000, 2, throw_elsewhere), std::bad_alloc);
}

TEST(ForEachIndex, BeginsNothingMoreOnceSomethingWasThrown) {
  int calls = 0;
  const auto throw_at_third = [&](std::size_t) {
    if (++calls == 3) throw std::runtime_error("third");
  };
  EXPECT_THROW(for_each_index(1000, 1, throw_at_third), std::runtime_error);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace kerf::bench
