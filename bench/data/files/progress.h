#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>

namespace kerf::bench {

/// Work that counts its own progress up to a total, in any unit and from any thread.
using CountedWork = std::function<void(std::atomic<std::size_t>& done)>;

/// Runs `work` once and shows meanwhile how far it is. What a terminal shows is for whoever has one to
/// decide, so long work takes one of these.
using ShowProgress =
    std::function<void(const std::string& label, std::size_t total, const CountedWork& work)>;

/// Runs the work and shows nothing.
inline void show_no_progress(const std::string& /*label*/, std::size_t /*total*/, const CountedWork& work) {
  std::atomic<std::size_t> done{0};
  work(done);
}

}  // namespace kerf::bench
