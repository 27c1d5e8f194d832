#include "run/serve_cells.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <new>
#include <set>
#include <string>
#include <string_view>
#include <system_error>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "plan/plan_file.h"
#include "run/cell_records.h"
#include "run/sweep_fault.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define KERF_SWEEP_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define KERF_SWEEP_SANITIZED
#endif
#endif

namespace kerf::bench {
namespace {

double processor_time_s() {
  timespec time{};
  (void)::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Of what it allocates; the shadow of a sanitizer is larger than any limit.
void limit_memory([[maybe_unused]] std::size_t megabytes) {
#ifndef KERF_SWEEP_SANITIZED
  const rlim_t bytes = static_cast<rlim_t>(megabytes) << 20U;
  const rlimit limit{.rlim_cur = bytes, .rlim_max = bytes};
  (void)::setrlimit(RLIMIT_DATA, &limit);
#endif
}

std::string in_one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

void go_wrong_if_asked(std::uint64_t cell) {
  if (is_fault("crash", cell)) std::raise(SIGKILL);
  while (is_fault("hang", cell)) ::pause();
  if (is_fault("memory", cell)) throw std::bad_alloc();
}

class Server {
 public:
  Server(const PlanFile& file, int connection)
      : plan_(&file.plan), work_(plan_->verb->begin(*plan_)), connection_(connection) {}

  void run() {
    add_head(frames_, "ready");
    send();
    CellOrder order;
    while (receive(order)) {
      for (std::uint64_t cell = order.begin; cell < order.end; ++cell) {
        answer(cell);
        send();
      }
    }
  }

 private:
  void answer(std::uint64_t number) {
    const double begin_s = processor_time_s();
    const auto fail = [&](Failure failure, const std::string& why) {
      add_failed(frames_, {.cell = number,
                           .seconds = processor_time_s() - begin_s,
                           .failure = failure,
                           .why = in_one_line(why)});
    };
    const std::string limit = fmt::format("it takes more than {} MB", plan_->limits.megabytes);
    try {
      go_wrong_if_asked(number);
      const CellNumbers numbers = work_->compute(plan_->cell(number));
      const double seconds = processor_time_s() - begin_s;
      const std::string text = CellLayout{.table = numbers.table, .columns = numbers.columns}.as_text();
      const std::uint64_t layout = CellLayout::number_of(text);
      if (layouts_.insert(layout).second) add_layout(frames_, layout, text);
      add_computed(frames_, number, seconds, layout, numbers.values);
    } catch (const std::bad_alloc&) {
      fail(Failure::no_memory, limit);
    } catch (const std::system_error& error) {
      const bool memory = error.code() == std::errc::not_enough_memory;
      fail(memory ? Failure::no_memory : Failure::no_answer, memory ? limit : error.what());
    } catch (const std::exception& error) {
      fail(Failure::no_answer, error.what());
    }
  }

  /// @returns false at the end.
  bool receive(CellOrder& order) const {
    auto* const bytes = reinterpret_cast<char*>(&order);
    std::size_t have = 0;
    while (have < sizeof order) {
      const auto count = ::read(connection_, bytes + have, sizeof order - have);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      have += static_cast<std::size_t>(count);
    }
    return true;
  }

  void send() {
    std::string_view left = frames_;
    while (!left.empty()) {
      const auto count = ::write(connection_, left.data(), left.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) throw std::system_error(errno, std::generic_category(), "the run is gone");
      left.remove_prefix(static_cast<std::size_t>(count));
    }
    frames_.clear();
  }

  const SweepPlan* plan_;
  std::unique_ptr<CellWork> work_;
  int connection_;
  std::string frames_;
  std::set<std::uint64_t> layouts_;
};

}  // namespace

void serve_cells(const std::filesystem::path& plan, int connection, SweepVerbs verbs) {
  (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const PlanFile file = read_plan(plan, verbs);
  limit_memory(file.plan.limits.megabytes);
  Server(file, connection).run();
}

}  // namespace kerf::bench
