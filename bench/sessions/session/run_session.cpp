#include "session/run_session.h"

#include <array>
#include <chrono>
#include <exception>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "laws/placement.h"
#include "laws/plugin_mention.h"
#include "sealed/trials/trial_counts.h"
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
        rendering_(store.protocol().ramp_s, store.protocol().switching, store.protocol().guide) {}

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
      note_counts();
      throw;
    }
    asking_ = {};
    if (failure_) std::rethrow_exception(failure_);
    if (!director_->over()) {
      store_.note("quit", hold_.was_held() ? jumped : "by a signal");
      subject_.show(stopped_view(store_.protocol()));
    }
    note_counts();
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
    if (const auto& guide = store_.protocol().guide; guide && guide->has_target())
      led_axis_ = axes_for(store_.protocol().samples.front().law, device).front();
    director_.emplace(store_, rendering_, subject_, device,
                      Director::Options{.period_s = period_s,
                                        .progress = options_.progress,
                                        .recorded = options_.recorded,
                                        .position = [this] { return position(); }});
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

  /// By the rules of the protocol, so that the receipt is of them too.
  void note_counts() {
    if (store_.protocol().rules.may_void()) store_.note("counts", in_words(counts_of(store_)));
  }

  drivers::Axes position() const noexcept {
    drivers::Axes position{};
    for (std::size_t axis = 0; axis < position_.size(); ++axis)
      position[axis] = position_[axis].load(std::memory_order_relaxed);
    return position;
  }

  Command step(const drivers::Sample& sample, double elapsed_s) noexcept {
    if (options_.each_sample) options_.each_sample(sample);
    for (std::size_t axis = 0; axis < position_.size(); ++axis)
      position_[axis].store(sample.position[axis], std::memory_order_relaxed);
    if (options_.loop.virtual_time) poll(virtual_s_ += elapsed_s);
    const Command command = rendering_(sample, elapsed_s);
    if (options_.live_guide != nullptr)
      options_.live_guide->store(rendering_.guide_time_s(), sample.position[led_axis_]);
    return command;
  }

  void ask(const std::stop_token& stop) {
    const auto begin = std::chrono::steady_clock::now();
    while (!stop.stop_requested() && !done_) {
      poll(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
      std::this_thread::sleep_for(poll_period);
    }
  }

  /// A note that cannot be kept, as on a full disk, is no reason to end a session.
  void keep_note() {
    const std::optional<std::string> text = options_.notes ? options_.notes() : std::nullopt;
    if (!text || text->empty()) return;
    try {
      store_.note("note", *text);
      if (options_.noted) options_.noted();
    } catch (const std::system_error& error) {
      if (options_.loop.warn)
        options_.loop.warn(fmt::format("a note could not be kept ({}): {}", error.code().message(), *text));
    }
  }

  void poll(double now_s) noexcept {
    try {
      keep_note();
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
  std::array<std::atomic<double>, std::tuple_size_v<drivers::Axes>> position_{};  ///< of the last tick
  std::size_t led_axis_ = 0;  ///< of the device, that a subject is shown
  std::atomic<bool> done_{false};
  std::exception_ptr failure_;
  double virtual_s_ = 0.0;
  std::jthread asking_;
};

}  // namespace

SubjectView stopped_view(const Protocol& protocol) {
  return {.stage = SessionStage::finished,
          .study = protocol.title,
          .text = (*protocol.texts)("finished_for_now"),
          .texts = protocol.texts};
}

SessionRunResult run_session(SessionStore& store, Subject& subject, const SessionRunOptions& options,
                             const std::atomic<bool>& stop) {
  try {
    return SessionRun(store, subject, options).run(stop);
  } catch (...) {
    subject.show(stopped_view(store.protocol()));
    throw;
  }
}

}  // namespace kerf::bench
