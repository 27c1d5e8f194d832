#include "session/run_session.h"

#include <chrono>
#include <exception>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "laws/plugin_mention.h"
#include "session/blind_rendering.h"

namespace kerf::bench {
namespace {

constexpr double longest_s = 1e6;  ///< of a run
constexpr std::chrono::milliseconds poll_period(5);
constexpr auto jumped = "the position had jumped, and zero force was held";

/// The loop on one side, the subject on the other.
class SessionRun {
 public:
  SessionRun(SessionStore& store, Subject& subject, const SessionRunOptions& options)
      : store_(store),
        subject_(subject),
        options_(options),
        rendering_(store.protocol().ramp_s, store.protocol().switching) {}

  SessionRunResult run(const std::atomic<bool>& stop) {
    RunOptions loop = options_.loop;
    loop.rate_hz = store_.protocol().rate_hz;
    loop.seconds = longest_s;
    loop.rendering = [&](const drivers::DeviceInfo& device) { return start(device); };
    loop.zero_hold = &hold_;
    loop.each_row = [this](const schema::Row& row) {
      rendering_.record(row);
      // Nobody who may answer may also say where the tool is, and a trial without a force is none.
      if (hold_.is_held()) done_.store(true, std::memory_order_release);
      if (options_.loop.each_row) options_.loop.each_row(row);
    };
    SessionRunResult result;
    try {
      result.run = run_on_device(loop, stop);
    } catch (const drivers::DeviceError& error) {
      asking_ = {};
      if (director_) store_.note("quit", "the device was lost");
      throw;
    }
    asking_ = {};
    if (failure_) std::rethrow_exception(failure_);
    if (!director_->over()) store_.note("quit", hold_.was_held() ? jumped : "by a signal");
    if (hold_.was_held() && options_.loop.warn) {
      options_.loop.warn(
          fmt::format("{}; the trial at work is not counted: see where the tool is, and go on", jumped));
    }
    result.end = director_->over() ? director_->end() : SessionEnd::quit;
    result.answered = director_->sequence().answered();
    result.at_most = director_->sequence().at_most();
    return result;
  }

 private:
  OtherRendering start(const drivers::DeviceInfo& device) {
    const double period_s = 1.0 / store_.protocol().rate_hz;
    director_.emplace(store_, rendering_, subject_, device,
                      Director::Options{.period_s = period_s, .progress = options_.progress});
    store_.note("run", options_.loop.device_uri);
    note_plugins();
    if (!options_.loop.virtual_time)
      asking_ = std::jthread([this](const std::stop_token& stop) { ask(stop); });
    return {
        .step = [this](const drivers::Sample& sample, double elapsed_s) { return step(sample, elapsed_s); },
        .finished = [this] { return done_.load(std::memory_order_acquire); }};
  }

  /// Of all samples, whichever the subject is given: it tells nothing of the order.
  void note_plugins() {
    std::set<std::string> plugins;
    for (const SessionSample& sample : store_.protocol().samples)
      plugins.insert(plugin_in_words(sample.law.law));
    plugins.erase("");
    for (const std::string& plugin : plugins) store_.note("plugin", plugin);
  }

  Command step(const drivers::Sample& sample, double elapsed_s) noexcept {
    if (options_.each_sample) options_.each_sample(sample);
    if (options_.loop.virtual_time) poll(virtual_s_ += elapsed_s);
    return rendering_(sample, elapsed_s);
  }

  void ask(const std::stop_token& stop) {
    const auto begin = std::chrono::steady_clock::now();
    while (!stop.stop_requested() && !done_) {
      poll(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
      std::this_thread::sleep_for(poll_period);
    }
  }

  void poll(double now_s) noexcept {
    try {
      director_->poll(now_s);
    } catch (...) {
      failure_ = std::current_exception();
    }
    if (failure_ || director_->over()) done_.store(true, std::memory_order_release);
  }

  SessionStore& store_;
  Subject& subject_;
  const SessionRunOptions& options_;
  BlindRendering rendering_;
  ZeroHold hold_;
  std::optional<Director> director_;
  std::atomic<bool> done_{false};
  std::exception_ptr failure_;
  double virtual_s_ = 0.0;
  std::jthread asking_;
};

}  // namespace

SessionRunResult run_session(SessionStore& store, Subject& subject, const SessionRunOptions& options,
                             const std::atomic<bool>& stop) {
  return SessionRun(store, subject, options).run(stop);
}

}  // namespace kerf::bench
