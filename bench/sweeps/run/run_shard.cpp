#include "run/run_shard.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <poll.h>

#include <kerf/version.h>

#include "run/sweep_fault.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using Clock = SweepWorker::Clock;

enum class State : std::uint8_t { missing, computed, failed };

/// What of a shard is there.
class Tally {
 public:
  Tally(const PlanFile& plan, const ShardName& name)
      : range_(shard_range(plan.plan.cells(), name.shard, name.shards)),
        states_(range_.size(), State::missing) {}

  void take(const CellRecord& record) {
    if (const auto* const computed = std::get_if<ComputedCell>(&record)) set(computed->cell, State::computed);
    if (const auto* const failed = std::get_if<FailedCell>(&record)) set(failed->cell, State::failed);
  }
  [[nodiscard]] const ShardRange& range() const noexcept { return range_; }
  [[nodiscard]] State at(std::uint64_t cell) const { return states_.at(cell - range_.begin); }
  [[nodiscard]] std::uint64_t count(State state) const noexcept {
    return counts_[static_cast<std::size_t>(state)];
  }
  [[nodiscard]] std::uint64_t missing() const noexcept {
    return states_.size() - count(State::computed) - count(State::failed);
  }

 private:
  void set(std::uint64_t cell, State state) {
    if (cell < range_.begin || cell >= range_.end)
      throw std::invalid_argument(fmt::format("cell {} is none of this shard", cell));
    State& now = states_[cell - range_.begin];
    if (now != State::missing) --counts_[static_cast<std::size_t>(now)];
    ++counts_[static_cast<std::size_t>(state)];
    now = state;
  }

  ShardRange range_;
  std::vector<State> states_;
  std::array<std::uint64_t, 3> counts_{};
};

/// Cells that nobody has been given yet, in order; what a worker left comes first.
class CellsToDo {
 public:
  CellsToDo(const Tally& tally, bool failed_again)
      : tally_(&tally), failed_again_(failed_again), next_(tally.range().begin) {}

  /// Up to `most` neighbours; empty: there is nothing to do.
  CellOrder take(std::uint64_t most) {
    if (!returned_.empty()) {
      CellOrder& last = returned_.back();
      const CellOrder order{.begin = last.begin, .end = std::min(last.end, last.begin + most)};
      last.begin = order.end;
      if (last.begin == last.end) returned_.pop_back();
      return order;
    }
    const std::uint64_t end = tally_->range().end;
    while (next_ < end && !is_to_do(next_)) ++next_;
    CellOrder order{.begin = next_, .end = next_};
    while (order.end < end && order.end - order.begin < most && is_to_do(order.end)) ++order.end;
    next_ = order.end;
    return order;
  }
  void give_back(const CellOrder& cells) {
    if (cells.begin < cells.end) returned_.push_back(cells);
  }

 private:
  [[nodiscard]] bool is_to_do(std::uint64_t cell) const {
    const State state = tally_->at(cell);
    return state == State::missing || (failed_again_ && state == State::failed);
  }

  const Tally* tally_;
  bool failed_again_;
  std::uint64_t next_;
  std::vector<CellOrder> returned_;
};

/// Frames on their way to a shard's file, which are written together.
class Output {
 public:
  Output(ShardWriter& writer, std::chrono::milliseconds synchronise_every)
      : writer_(&writer), every_(synchronise_every) {}

  void add(const CellRecord& record, std::string_view frame) {
    if (const auto* const layout = std::get_if<LayoutRecord>(&record)) {
      writer_->require_layout(layout->layout, layout->text);
      return;
    }
    waiting_ += frame;
    end_here_if_asked(++cells_);
  }
  void write() {
    writer_->append(waiting_);
    waiting_.clear();
    if (Clock::now() - synchronised_ < every_) return;
    writer_->synchronise();
    synchronised_ = Clock::now();
  }

 private:
  /// For trials: as a crash would, between two records or within one.
  void end_here_if_asked(std::uint64_t cells) {
    if (is_fault("tear", cells)) waiting_.resize(waiting_.size() - 5);
    if (!is_fault("kill", cells) && !is_fault("tear", cells)) return;
    writer_->append(waiting_);
    (void)std::raise(SIGKILL);
  }

  ShardWriter* writer_;
  std::chrono::milliseconds every_;
  Clock::time_point synchronised_ = Clock::now();
  std::string waiting_;
  std::uint64_t cells_ = 0;
};

class ShardRun {
 public:
  ShardRun(const PlanFile& plan, const ShardRunOptions& options, Tally& tally, ShardWriter& writer,
           ShardLock& lock, const std::atomic<bool>& stop)
      : plan_(&plan),
        options_(&options),
        tally_(&tally),
        to_do_(tally, options.failed_again),
        output_(writer, options.synchronise_every),
        lock_(&lock),
        stop_(&stop),
        left_(options.failed_again ? tally.missing() + tally.count(State::failed) : tally.missing()) {}

  /// @returns whether all was computed.
  bool run() {
    const auto wanted = std::min<std::uint64_t>(std::max<std::size_t>(options_->workers, 1), left_);
    while (workers_.size() < wanted) workers_.push_back(started());
    while (left_ > 0 && !*stop_) {
      for (auto& worker : workers_) keep_busy(*worker);
      wait();
      for (auto& worker : workers_) attend(worker);
      output_.write();
      lock_->keep();
      tell();
    }
    return left_ == 0;
  }

  [[nodiscard]] ShardProgress progress() const {
    return {.cells = tally_->range().size(),
            .done = tally_->range().size() - tally_->missing(),
            .failed = tally_->count(State::failed),
            .computed = computed_,
            .elapsed_s = std::chrono::duration<double>(Clock::now() - begun_).count()};
  }
  [[nodiscard]] double cells_s() const noexcept { return cells_s_; }

 private:
  [[nodiscard]] std::unique_ptr<SweepWorker> started() const {
    return std::make_unique<SweepWorker>(options_->worker, plan_->file);
  }

  /// A fifth of a second of cells ahead, so that no worker waits for the disk of this process; less towards
  /// the end, so that none is left with what others could do.
  void keep_busy(SweepWorker& worker) {
    constexpr double ahead_s = 0.2;
    constexpr std::uint64_t most = 512;
    const double each_s = computed_ > 0 ? cells_s_ / static_cast<double>(computed_) : ahead_s;
    const auto by_time = static_cast<std::uint64_t>(std::clamp(ahead_s / std::max(each_s, 1e-6), 1.0, 512.0));
    const std::uint64_t share = left_ / (2 * workers_.size()) + 1;
    const std::uint64_t wanted = std::min({by_time, share, most});
    if (worker.ordered() > wanted / 2) return;
    const CellOrder order = to_do_.take(wanted);
    if (order.begin == order.end) return;
    if (!worker.order(order)) to_do_.give_back(order);  // it has ended, which is seen at once
  }

  void wait() const {
    std::vector<pollfd> waited;
    for (const auto& worker : workers_)
      waited.push_back({.fd = worker->descriptor(), .events = POLLIN, .revents = 0});
    (void)::poll(waited.data(), waited.size(), 100);
  }

  void attend(std::unique_ptr<SweepWorker>& worker) {
    const bool lives = worker->receive([&](const CellRecord& record, std::string_view frame) {
      if (!std::holds_alternative<HeadRecord>(record)) keep_record(record, frame);
    });
    if (!lives) {
      replace_dead(worker);
    } else if (is_too_long(*worker)) {
      end_late(worker);
    }
  }

  void keep_record(const CellRecord& record, std::string_view frame) {
    if (const auto* const computed = std::get_if<ComputedCell>(&record)) cells_s_ += computed->seconds;
    if (const auto* const failed = std::get_if<FailedCell>(&record)) cells_s_ += failed->seconds;
    if (!std::holds_alternative<LayoutRecord>(record)) {
      ++computed_;
      --left_;
    }
    tally_->take(record);
    output_.add(record, frame);
  }

  void record_failure(std::uint64_t cell, Failure failure, double seconds, const std::string& why) {
    std::string frame;
    add_failed(frame, {.cell = cell, .seconds = seconds, .failure = failure, .why = why});
    keep_record(first_frame(frame)->record, frame);
  }

  /// What a worker leaves is for others, the cell that it was at set apart.
  std::optional<std::uint64_t> take_back(const SweepWorker& worker) {
    if (worker.is_idle()) return std::nullopt;
    const std::uint64_t at = worker.current();
    for (auto order = worker.orders().rbegin(); order != worker.orders().rend(); ++order)
      to_do_.give_back({.begin = order->begin == at ? at + 1 : order->begin, .end = order->end});
    return at;
  }

  void replace_dead(std::unique_ptr<SweepWorker>& worker) {
    const bool was_ready = worker->is_ready();
    const auto at = take_back(*worker);
    const std::string how = worker->end();
    if (!was_ready)
      throw std::system_error(std::make_error_code(std::errc::no_child_process),
                              fmt::format("a worker does not begin: it {}", how));
    if (at && ++deaths_[*at] < 2) {
      to_do_.give_back({.begin = *at, .end = *at + 1});
    } else if (at) {
      record_failure(*at, Failure::crashed, 0.0, "its worker " + how);
    }
    worker = started();
  }

  [[nodiscard]] bool is_too_long(const SweepWorker& worker) const {
    constexpr double longest_begin_s = 300.0;
    const double waited_s = std::chrono::duration<double>(Clock::now() - worker.since()).count();
    if (!worker.is_ready()) return waited_s > longest_begin_s;
    return !worker.is_idle() && waited_s > plan_->plan.limits.seconds;
  }

  void end_late(std::unique_ptr<SweepWorker>& worker) {
    const bool was_ready = worker->is_ready();
    const auto at = take_back(*worker);
    (void)worker->end();
    if (!was_ready)
      throw std::system_error(std::make_error_code(std::errc::timed_out), "a worker does not begin");
    if (at)
      record_failure(*at, Failure::too_long, plan_->plan.limits.seconds,
                     fmt::format("it takes longer than {} s", plan_->plan.limits.seconds));
    worker = started();
  }

  void tell() {
    if (Clock::now() - told_ < std::chrono::milliseconds(200)) return;
    told_ = Clock::now();
    options_->progress(progress());
  }

  const PlanFile* plan_;
  const ShardRunOptions* options_;
  Tally* tally_;
  CellsToDo to_do_;
  Output output_;
  ShardLock* lock_;
  const std::atomic<bool>* stop_;
  std::uint64_t left_;
  std::uint64_t computed_ = 0;
  double cells_s_ = 0.0;
  std::map<std::uint64_t, int> deaths_;
  std::vector<std::unique_ptr<SweepWorker>> workers_;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point told_ = Clock::now();
};

/// Of a shard that has its final name. @throws std::invalid_argument if it is of another plan.
void take_complete(const PlanFile& plan, const ShardRunOptions& options, const fs::path& place,
                   Tally& tally) {
  const ShardContent content =
      read_shard(place, [&](const CellRecord& record, std::uintmax_t) { tally.take(record); });
  if (content.plan_sha256 != plan.sha256)
    throw std::invalid_argument(
        fmt::format("{}: it is of another plan; the plan was changed since, remove the file to begin anew",
                    place.string()));
  if (content.name.shard != options.name.shard || content.name.shards != options.name.shards ||
      tally.missing() > 0 || content.whole_bytes != content.bytes)
    throw std::invalid_argument(
        fmt::format("{}: it is damaged; remove the file to compute it again", place.string()));
}

ShardOutcome outcome_of(const Tally& tally, const fs::path& place) {
  return {.progress = {.cells = tally.range().size(),
                       .done = tally.range().size() - tally.missing(),
                       .failed = tally.count(State::failed)},
          .complete = true,
          .file = place};
}

}  // namespace

double ShardProgress::left_s() const noexcept {
  if (computed == 0) return std::numeric_limits<double>::quiet_NaN();
  return elapsed_s * static_cast<double>(cells - done) / static_cast<double>(computed);
}

ShardOutcome run_shard(const PlanFile& plan, const ShardRunOptions& options, const std::atomic<bool>& stop) {
  if (options.name.shard >= options.name.shards)
    throw std::invalid_argument(fmt::format("there is no {}: shards are counted from 0 to {}",
                                            options.name.in_words(), options.name.shards - 1));
  const fs::path place = options.name.place_in(options.folder);
  const fs::path partial = partial_shard(place);
  fs::create_directories(place.parent_path());
  const bool was_complete = fs::exists(place);
  if (was_complete) {
    Tally tally(plan, options.name);
    take_complete(plan, options, place, tally);
    if (!options.failed_again || tally.count(State::failed) == 0) return outcome_of(tally, place);
    std::error_code done_by_another;
    fs::rename(place, partial, done_by_another);
  }
  require_planned_files(plan.plan, shard_range(plan.plan.cells(), options.name.shard, options.name.shards));
  ShardLock lock(place, partial, options.lock);
  if (fs::exists(place)) {  // who had it before has just finished
    fs::remove(partial);
    Tally tally(plan, options.name);
    take_complete(plan, options, place, tally);
    return outcome_of(tally, place);
  }
  Tally tally(plan, options.name);
  ShardWriter writer(plan, options.name, place, [&](const CellRecord& record) { tally.take(record); });
  ShardRun run(plan, options, tally, writer, lock, stop);
  const bool complete = run.run();
  if (complete) {
    writer.finish();
  } else {
    writer.synchronise();
  }
  return {.progress = run.progress(),
          .complete = complete,
          .cells_s = run.cells_s(),
          .file = complete ? place : partial};
}

}  // namespace kerf::bench
