#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <vector>

namespace kerf::bench {

/// Calls `work(i)` for every i below `count`, on so many threads, this one among them; each takes the next
/// that nobody has begun. What one of them throws is thrown here when all have ended, and ends the others
/// early: an allocation that fails on another thread must not end the program.
template <typename Work>
void for_each_index(std::size_t count, std::size_t threads, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto work_through = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      next = count;
      throw;
    }
  };
  std::vector<std::future<void>> others;
  for (std::size_t i = 1; i < std::min(threads, count); ++i)
    others.push_back(std::async(std::launch::async, work_through));
  work_through();
  for (auto& other : others) other.get();
}

}  // namespace kerf::bench
