#include "results/jobs.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "host/realtime.h"
#include "loop/without_signals.h"

namespace kerf::bench {
namespace {

constexpr std::ptrdiff_t max_waiting = 20;
constexpr std::ptrdiff_t max_remembered = 50;

}  // namespace

struct Jobs::Entry {
  enum class State : std::uint8_t { waiting, running, done, failed, stopped };

  std::size_t number = 0;
  JobOrder order;
  JobProgress progress;
  State state = State::waiting;
  std::string error;
  std::string file;

  [[nodiscard]] bool has_ended() const { return state != State::waiting && state != State::running; }

  [[nodiscard]] const char* state_name() const {
    switch (state) {
      case State::waiting:
        return "waiting";
      case State::running:
        return "running";
      case State::done:
        return "done";
      case State::failed:
        return "failed";
      case State::stopped:
        return "stopped";
    }
    return "failed";
  }

  [[nodiscard]] double share() const {
    if (state == State::done) return 1.0;
    const std::size_t steps = progress.steps;
    if (steps == 0) return state == State::running ? -1.0 : 0.0;
    return std::min(1.0, static_cast<double>(progress.done) / static_cast<double>(steps));
  }
};

Jobs::Jobs() {
  const WithoutSignals none;
  thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

Jobs::~Jobs() { close(); }

void Jobs::close() {
  const std::scoped_lock lock(mutex_);
  thread_.request_stop();
  for (const auto& entry : entries_) entry->progress.stop = true;
}

std::size_t Jobs::add(JobOrder order) {
  const std::scoped_lock lock(mutex_);
  const auto waiting = std::ranges::count_if(
      entries_, [](const auto& entry) { return entry->state == Entry::State::waiting; });
  if (waiting >= max_waiting)
    throw RequestError(503, fmt::format("{} jobs are waiting already; stop some, or wait", max_waiting));
  auto entry = std::make_shared<Entry>();
  entry->number = ++last_;
  entry->progress.steps = order.steps;
  entry->order = std::move(order);
  entries_.push_back(std::move(entry));
  changed_.notify_all();
  return last_;
}

void Jobs::stop(std::size_t job) {
  const std::scoped_lock lock(mutex_);
  for (const auto& entry : entries_) {
    if (entry->number != job || entry->has_ended()) continue;
    entry->progress.stop = true;
    if (entry->state == Entry::State::waiting) entry->state = Entry::State::stopped;
  }
  forget_oldest();
}

nlohmann::ordered_json Jobs::list() const {
  const std::scoped_lock lock(mutex_);
  auto list = nlohmann::ordered_json::array();
  for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) {
    const Entry& one = **entry;
    list.push_back({{"job", one.number},
                    {"kind", one.order.kind},
                    {"title", one.order.title},
                    {"state", one.state_name()},
                    {"share", one.share()},
                    {"error", one.error},
                    {"file", one.file}});
  }
  return list;
}

void Jobs::forget_oldest() {
  auto ended = std::ranges::count_if(entries_, [](const auto& entry) { return entry->has_ended(); });
  for (auto entry = entries_.begin(); entry != entries_.end() && ended > max_remembered;) {
    if (!(*entry)->has_ended()) {
      ++entry;
      continue;
    }
    entry = entries_.erase(entry);
    --ended;
  }
}

void Jobs::work(const std::stop_token& stop) {
  stay_off_loop_processor();
  give_way();
  while (true) {
    std::shared_ptr<Entry> next;
    {
      std::unique_lock lock(mutex_);
      const auto is_next = [](const auto& entry) { return entry->state == Entry::State::waiting; };
      changed_.wait(lock, stop, [&] { return std::ranges::any_of(entries_, is_next); });
      if (stop.stop_requested()) return;
      next = *std::ranges::find_if(entries_, is_next);
      next->state = Entry::State::running;
    }
    run(*next);
  }
}

void Jobs::run(Entry& entry) {
  std::string file;
  std::string error;
  auto state = Entry::State::done;
  try {
    file = entry.order.work(entry.progress);
  } catch (const std::exception& failure) {
    state = Entry::State::failed;
    error = failure.what();
  } catch (...) {
    state = Entry::State::failed;
    error = "it failed without saying why";
  }
  if (state == Entry::State::failed && entry.progress.stop) {
    state = Entry::State::stopped;
    error.clear();
  }
  const std::scoped_lock lock(mutex_);
  entry.state = state;
  entry.error = std::move(error);
  entry.file = std::move(file);
  entry.order.work = {};  // lets go of what it holds
  forget_oldest();
}

}  // namespace kerf::bench
