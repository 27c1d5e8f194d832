#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

#include <kerf/processes/helper.h>

#include "run/cell_records.h"
#include "run/serve_cells.h"

namespace kerf::bench {

/// How workers are started.
struct WorkerProgram {
  std::filesystem::path
      program;  ///< which runs serve_cells() as `PROGRAM sweep worker PLAN`; empty: this one
  std::vector<std::string> plugins;
};

/// A process that computes cells, as who gives it orders sees it.
class SweepWorker {
 public:
  using Clock = std::chrono::steady_clock;

  /// @throws std::system_error if it cannot be started.
  SweepWorker(const WorkerProgram& program, const std::filesystem::path& plan);
  SweepWorker(const SweepWorker&) = delete;
  SweepWorker& operator=(const SweepWorker&) = delete;
  /// Ends it.
  ~SweepWorker();

  /// @returns false if it takes none any more.
  [[nodiscard]] bool order(const CellOrder& cells);
  [[nodiscard]] std::uint64_t ordered() const noexcept { return ordered_; }
  [[nodiscard]] bool is_idle() const noexcept { return orders_.empty(); }
  /// The one that it is at, while it is not idle.
  [[nodiscard]] std::uint64_t current() const { return orders_.front().begin; }
  /// What it was ordered and has not answered.
  [[nodiscard]] const std::deque<CellOrder>& orders() const noexcept { return orders_; }
  [[nodiscard]] bool is_ready() const noexcept { return ready_; }
  /// Since when it is at its cell, or begins.
  [[nodiscard]] Clock::time_point since() const noexcept { return since_; }

  /// Takes what it has answered. Each record comes with its frame. @returns false if it has ended.
  [[nodiscard]] bool receive(const std::function<void(const CellRecord&, std::string_view frame)>& take);
  /// Ends it. @returns how it ended, in words.
  std::string end();
  [[nodiscard]] int descriptor() const noexcept { return connection_.number(); }
  [[nodiscard]] pid_t process() const noexcept { return process_; }

 private:
  void answered(std::uint64_t cell);

  processes::Descriptor connection_;
  pid_t process_ = -1;
  std::deque<CellOrder> orders_;
  std::uint64_t ordered_ = 0;  ///< cells among them
  bool ready_ = false;
  Clock::time_point since_ = Clock::now();
  std::string received_;
};

}  // namespace kerf::bench
