#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <vector>

namespace kerf::fitting {

/// Calls `work(k)` for each k below `count`, each of `threads` taking the next. Throws what one of them
/// threw.
template <typename Work>
void share_out(std::size_t count, std::size_t threads, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto take = [&] {
    for (std::size_t k = next++; k < count; k = next++) work(k);
  };
  std::vector<std::future<void>> helpers;
  for (std::size_t i = 1; i < std::min(threads, count); ++i)
    helpers.push_back(std::async(std::launch::async, take));
  take();
  for (auto& helper : helpers) helper.get();
}

}  // namespace kerf::fitting
