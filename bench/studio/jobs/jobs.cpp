#include "jobs/jobs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "host/realtime.h"
#include "loop/without_signals.h"

namespace kerf::bench {
namespace {

constexpr std::ptrdiff_t max_waiting = 20;
constexpr std::ptrdiff_t max_remembered = 50;
constexpr double shortest_clock_set_s = 2.0;  ///< less is a clock that is steered

double seconds_between(auto from, auto to) { return std::chrono::duration<double>(to - from).count(); }

}  // namespace

struct Jobs::Entry {
  JobRecord record;
  JobOrder order;
  JobProgress progress;
  std::string log{};        ///< of this studio; that of an earlier one is on disk
  bool is_earlier = false;  ///< of an earlier studio
  bool is_changed = false;  ///< the disk has not heard of it yet
  bool is_forgotten = false;
  std::chrono::steady_clock::time_point begun{};
  std::chrono::system_clock::time_point begun_by_the_wall{};

  [[nodiscard]] double share() const {
    if (record.state == JobState::done) return 1.0;
    const std::size_t steps = progress.steps;
    if (steps == 0) return record.state == JobState::running ? -1.0 : 0.0;
    return std::min(1.0, static_cast<double>(progress.done) / static_cast<double>(steps));
  }
};

Jobs::Jobs(std::filesystem::path folder, JobClocks clocks)
    : clocks_(std::move(clocks)), store_(std::move(folder)) {
  for (JobRecord& record : store_.load()) {
    auto entry = std::make_shared<Entry>();
    last_ = std::max(last_, record.number);
    entry->is_earlier = true;
    entry->is_changed = record.state == JobState::interrupted || record.state == JobState::stopped;
    entry->record = std::move(record);
    entries_.push_back(std::move(entry));
  }
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
  auto entry = std::make_shared<Entry>();
  {
    const std::scoped_lock lock(mutex_);
    const auto waiting = std::ranges::count_if(
        entries_, [](const auto& one) { return one->record.state == JobState::waiting; });
    if (waiting >= max_waiting)
      throw RequestError(503, fmt::format("{} jobs are waiting already; stop some, or wait", max_waiting));
    entry->record = {.number = ++last_,
                     .kind = order.kind,
                     .title = order.title,
                     .outputs = order.outputs,
                     .created = iso_8601(clocks_.wall()),
                     .again = std::move(order.again)};
    entry->progress.steps = order.steps;
    entry->progress.log = [this, it = entry.get()](std::string_view text) { say(*it, text); };
    entry->order = std::move(order);
    entries_.push_back(entry);
  }
  keep(*entry);  // before it begins, so that whatever ends the studio, it is known to have been asked for
  changed_.notify_all();
  return entry->record.number;
}

void Jobs::stop(std::size_t job) {
  std::shared_ptr<Entry> stopped;
  {
    const std::scoped_lock lock(mutex_);
    for (const auto& entry : entries_) {
      if (entry->record.number != job || entry->record.has_ended()) continue;
      entry->progress.stop = true;
      entry->record.is_unwanted = true;
      if (entry->record.state == JobState::waiting) entry->record.state = JobState::stopped;
      stopped = entry;
    }
  }
  changed_.notify_all();
  if (stopped) keep(*stopped);  // a kill before the work has heard of it is no interruption
}

std::shared_ptr<Jobs::Entry> Jobs::find(std::size_t job) const {
  const auto found =
      std::ranges::find_if(entries_, [job](const auto& entry) { return entry->record.number == job; });
  if (found == entries_.end()) throw RequestError(404, fmt::format("there is no job {} any more", job));
  return *found;
}

void Jobs::forget(std::size_t job) {
  const std::scoped_lock disk(disk_);
  {
    const std::scoped_lock lock(mutex_);
    const auto entry = find(job);
    if (!entry->record.has_ended()) throw RequestError(409, "the job is under way: stop it first");
    entry->is_forgotten = true;  // its thread may be about to keep how it ended
    std::erase(entries_, entry);
  }
  store_.forget(job);
}

nlohmann::ordered_json Jobs::list() const {
  const std::scoped_lock lock(mutex_);
  auto list = nlohmann::ordered_json::array();
  for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) {
    const Entry& one = **entry;
    const bool runs = one.record.state == JobState::running;
    auto json = to_json(one.record);
    for (const char* on_disk_alone : {"format", "unwanted"}) json.erase(on_disk_alone);
    json["share"] = one.share();
    if (runs) json["seconds"] = seconds_between(one.begun, clocks_.steady());
    json["stopping"] = runs && one.progress.stop;
    json["not_kept"] = not_kept_;
    list.push_back(std::move(json));
  }
  return list;
}

std::string Jobs::log_of(std::size_t job) const {
  const std::scoped_lock disk(disk_);
  std::shared_ptr<Entry> entry;
  {
    const std::scoped_lock lock(mutex_);
    entry = find(job);
    if (!entry->is_earlier) return entry->log;
  }
  return store_.log_of(job);
}

JobRecord Jobs::record_of(std::size_t job) const {
  const std::scoped_lock lock(mutex_);
  return find(job)->record;
}

void Jobs::say(Entry& entry, std::string_view text) {
  {
    const std::scoped_lock lock(mutex_);
    if (entry.log.size() < JobStore::longest_log)
      entry.log += text.substr(0, JobStore::longest_log - entry.log.size());
  }
  const std::scoped_lock disk(disk_);
  const std::string failure = store_.append(entry.record.number, text);
  const std::scoped_lock lock(mutex_);
  if (!failure.empty()) not_kept_ = failure;
}

void Jobs::keep(Entry& entry) {
  const std::scoped_lock disk(disk_);
  JobRecord record;
  {
    const std::scoped_lock lock(mutex_);
    entry.is_changed = false;
    if (entry.is_forgotten) return;
    record = entry.record;
  }
  std::string failure = store_.keep(record);
  const std::scoped_lock lock(mutex_);
  not_kept_ = std::move(failure);
}

void Jobs::keep_changed() {
  std::vector<std::shared_ptr<Entry>> changed;
  std::vector<std::size_t> forgotten;
  {
    const std::scoped_lock lock(mutex_);
    forgotten = forget_oldest();
    std::ranges::copy_if(entries_, std::back_inserter(changed),
                         [](const auto& entry) { return entry->is_changed; });
  }
  for (const auto& entry : changed) keep(*entry);
  forget_on_disk(forgotten);
}

std::vector<std::size_t> Jobs::forget_oldest() {
  std::vector<std::size_t> forgotten;
  auto ended = std::ranges::count_if(entries_, [](const auto& it) { return it->record.has_ended(); });
  for (auto entry = entries_.begin(); entry != entries_.end() && ended > max_remembered;) {
    if (!(*entry)->record.has_ended()) {
      ++entry;
      continue;
    }
    forgotten.push_back((*entry)->record.number);
    (*entry)->is_forgotten = true;
    entry = entries_.erase(entry);
    --ended;
  }
  return forgotten;
}

void Jobs::forget_on_disk(const std::vector<std::size_t>& jobs) {
  const std::scoped_lock disk(disk_);
  for (const std::size_t job : jobs) store_.forget(job);
}

void Jobs::work(const std::stop_token& stop) {
  stay_off_loop_processor();
  give_way();
  const auto is_next = [](const auto& entry) { return entry->record.state == JobState::waiting; };
  const auto is_changed = [](const auto& entry) { return entry->is_changed; };
  while (true) {
    keep_changed();
    std::shared_ptr<Entry> next;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, stop, [&] {
        return std::ranges::any_of(entries_, is_next) || std::ranges::any_of(entries_, is_changed);
      });
      if (stop.stop_requested()) return;
      const auto found = std::ranges::find_if(entries_, is_next);
      if (found == entries_.end()) continue;
      next = *found;
      next->record.state = JobState::running;
      next->begun = clocks_.steady();
      next->begun_by_the_wall = clocks_.wall();
    }
    keep(*next);
    run(*next);
  }
}

void Jobs::run(Entry& entry) {
  JobEnd end("");
  std::string error;
  auto state = JobState::done;
  try {
    end = entry.order.work(entry.progress);
  } catch (const std::exception& failure) {
    state = JobState::failed;
    error = failure.what();
  } catch (...) {
    state = JobState::failed;
    error = "it failed without saying why";
  }
  if (state == JobState::failed && entry.progress.stop) {
    const std::scoped_lock lock(mutex_);
    state = entry.record.state_without_studio();
    error.clear();
  }
  std::vector<std::size_t> forgotten;
  {
    const std::scoped_lock lock(mutex_);
    JobRecord& record = entry.record;
    record.state = state;
    record.error = std::move(error);
    record.file = std::move(end.file);
    record.outcome = std::move(end.outcome);
    record.seconds = seconds_between(entry.begun, clocks_.steady());
    const double by_the_wall = seconds_between(entry.begun_by_the_wall, clocks_.wall());
    if (std::abs(by_the_wall - record.seconds) > shortest_clock_set_s)
      record.clock_set_s = by_the_wall - record.seconds;
    entry.order.work = {};  // lets go of what it holds
    forgotten = forget_oldest();
  }
  keep(entry);
  forget_on_disk(forgotten);
}

}  // namespace kerf::bench
