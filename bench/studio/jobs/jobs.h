#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "http/routes.h"
#include "jobs/job_record.h"
#include "jobs/job_store.h"

namespace kerf::bench {

/// What a job that takes a while is given: when to stop, and where to say how far it is.
struct JobProgress {
  std::atomic<bool> stop{false};
  std::atomic<std::size_t> done{0};   ///< of the steps
  std::atomic<std::size_t> steps{0};  ///< JobOrder::steps, or what the work makes of it; 0: not known
  /// Adds to the job's log. By the thread of the work.
  std::function<void(std::string_view)> log = [](std::string_view) {};
};

/// What comes of a job that did not fail.
struct JobEnd {
  std::string file;     ///< id of its result's file; empty: none that has a page of its own
  std::string outcome;  ///< as JobRecord::outcome
  // NOLINTNEXTLINE(google-explicit-constructor): work that has a file alone says that
  JobEnd(std::string of_file, std::string of_outcome = {})
      : file(std::move(of_file)), outcome(std::move(of_outcome)) {}
};

/// A piece of work for the studio, such as a fit.
// NOLINTNEXTLINE(bugprone-exception-escape): of what moves JSON, which does not throw
struct JobOrder {
  std::string kind;       ///< "fit"
  std::string title;      ///< "Fit of cut.h5"
  std::size_t steps = 0;  ///< that JobProgress::done counts to; 0: not known
  /// May throw: what it says is then shown. To end because it was stopped it throws whatever it likes.
  std::function<JobEnd(JobProgress&)> work;
  std::vector<std::string> outputs = {};  ///< as JobRecord::outputs
  JobAgain again = {};
};

/// The two clocks of a job: what it says of the time of day, and how long it took.
struct JobClocks {
  std::function<std::chrono::system_clock::time_point()> wall = std::chrono::system_clock::now;
  std::function<std::chrono::steady_clock::time_point()> steady = std::chrono::steady_clock::now;
};

/// Work in the order it was asked for, one piece at a time, by a thread that gives way to the loop: off its
/// processor, and less urgent than everything else. The last 50 that ended are remembered, with a folder also
/// by the next studio; what was under way when the last one ended is interrupted.
class Jobs {
 public:
  /// @param folder as JobStore's; empty: nothing outlives this.
  explicit Jobs(std::filesystem::path folder = {}, JobClocks clocks = {});
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;
  ~Jobs();  ///< stops the one at work, and waits for it

  /// @throws RequestError 503 where 20 are waiting.
  std::size_t add(JobOrder order);
  /// For the end of the program: asks the one at work to stop, and begins none any more.
  void close();
  /// Asks one to stop; nothing if there is none such or it has ended. It is asked before the disk is waited
  /// for.
  void stop(std::size_t job);
  /// No more is known of one that has ended. May wait for the disk. @throws RequestError 404, 409.
  void forget(std::size_t job);
  /// As the page's Job, newest first. Never waits.
  [[nodiscard]] nlohmann::ordered_json list() const;
  /// What it has said so far; may wait for the disk. @throws RequestError 404.
  [[nodiscard]] std::string log_of(std::size_t job) const;
  /// @throws RequestError 404.
  [[nodiscard]] JobRecord record_of(std::size_t job) const;

 private:
  struct Entry;
  void work(const std::stop_token& stop);
  void run(Entry& entry);
  /// Writes the record as it is now. Not with mutex_ held: a disk may take its time.
  void keep(Entry& entry);
  void keep_changed();
  void say(Entry& entry, std::string_view text);
  [[nodiscard]] std::vector<std::size_t> forget_oldest();  ///< with mutex_ held
  void forget_on_disk(const std::vector<std::size_t>& jobs);
  [[nodiscard]] std::shared_ptr<Entry> find(std::size_t job) const;  ///< with mutex_ held

  JobClocks clocks_;
  mutable std::mutex disk_;  ///< of store_; taken before mutex_, if both are
  JobStore store_;
  mutable std::mutex mutex_;  ///< of what follows, and of the entries but their progress
  std::condition_variable_any changed_;
  std::deque<std::shared_ptr<Entry>> entries_;  ///< oldest first
  std::size_t last_ = 0;
  std::string not_kept_;  ///< why records are not on disk; empty: they are
  std::jthread thread_;   ///< last: uses the rest
};

}  // namespace kerf::bench
