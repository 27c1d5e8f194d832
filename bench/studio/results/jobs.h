#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>

#include "http/routes.h"

namespace kerf::bench {

/// What a job that takes a while is given: when to stop, and where to say how far it is.
struct JobProgress {
  std::atomic<bool> stop{false};
  std::atomic<std::size_t> done{0};   ///< of the steps
  std::atomic<std::size_t> steps{0};  ///< JobOrder::steps, or what the work makes of it; 0: not known
};

/// A piece of work for the studio, such as a fit. `work` gives back the id of its result's file.
struct JobOrder {
  std::string kind;       ///< "fit"
  std::string title;      ///< "Fit of cut.h5"
  std::size_t steps = 0;  ///< that JobProgress::done counts to; 0: not known
  /// May throw: what it says is then shown. To end because it was stopped it throws whatever it likes.
  std::function<std::string(JobProgress&)> work;
};

/// Work in the order it was asked for, one piece at a time, by a thread that gives way to the loop: off its
/// processor, and less urgent than everything else. The last 50 that ended are remembered.
class Jobs {
 public:
  Jobs();
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;
  ~Jobs();  ///< stops the one at work, and waits for it

  /// @throws RequestError 503 where 20 are waiting.
  std::size_t add(JobOrder order);
  /// For the end of the program: asks the one at work to stop, and begins none any more.
  void close();
  /// Asks one to stop; nothing if there is none such or it has ended.
  void stop(std::size_t job);
  /// As the page's Job, newest first.
  [[nodiscard]] nlohmann::ordered_json list() const;

 private:
  struct Entry;
  void work(const std::stop_token& stop);
  void run(Entry& entry);
  void forget_oldest();

  mutable std::mutex mutex_;  ///< of what follows, and of the entries but their progress
  std::condition_variable_any changed_;
  std::deque<std::shared_ptr<Entry>> entries_;  ///< oldest first
  std::size_t last_ = 0;
  std::jthread thread_;  ///< last: uses the rest
};

}  // namespace kerf::bench
