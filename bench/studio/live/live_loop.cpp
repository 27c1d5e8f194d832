#include "live/live_loop.h"

#include <chrono>
#include <exception>
#include <stdexcept>
#include <utility>

#include <kerf/drivers/bench_file.h>

#include "host/realtime.h"
#include "laws/placement.h"
#include "laws/plugin_mention.h"
#include "loop/without_signals.h"

namespace kerf::bench {
namespace {

constexpr double longest_s = 1e6;  ///< of a loop
constexpr std::chrono::microseconds drain_period(16'667);

RunOptions run_options(const LiveOptions& options) {
  RunOptions run;
  run.seconds = longest_s;
  run.rate_hz = options.rate_hz;
  run.ramp_s = options.ramp_s;
  run.passivity_control = options.passivity_control;
  run.scene = options.scene;
  if (!options.device_uri.empty()) {
    run.device_uri = options.device_uri;
  } else if (options.scene) {
    run.device_uri = device_of(*options.scene);
  }
  run.sensor_uri = drivers::sensor_beside(run.device_uri, options.sensor_uri);
  if (!run.scene && run.device_uri.starts_with("sim:scissors")) run.scene = default_scene();
  return run;
}

}  // namespace

LiveLoop::~LiveLoop() { stop(); }

void LiveLoop::start(const LiveOptions& options) {
  const std::lock_guard only(starting_);
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return phase_ != Phase::over; });
    if (phase_ != Phase::idle) throw std::invalid_argument("the loop runs already: stop it first");
    phase_ = Phase::starting;
    stop_ = is_run_over_ = false;
    ended_.clear();
    warning_.clear();
  }
  if (closed_) stop_ = true;  // close() may have come before the line above
  try {
    open(options);
  } catch (...) {
    stop_ = true;
    running_ = {};
    enter(Phase::idle);
    throw;
  }
}

void LiveLoop::open(const LiveOptions& options) {
  running_ = {};  // of the last loop, which is over
  watching_ = {};
  rendering_.restart(options.ramp_s);
  (void)hold_.exchange(false);  // what the last loop held
  std::promise<void> opened;
  std::future<void> is_open = opened.get_future();
  {
    const WithoutSignals none;
    running_ = std::jthread([this, run = run_options(options), promise = std::move(opened)]() mutable {
      this->run(std::move(run), promise);
    });
  }
  is_open.get();
  enter(Phase::running);
  const WithoutSignals none;
  watching_ = std::jthread([this, hub = running_hub()] { watch(*hub); });
}

void LiveLoop::enter(Phase phase) {
  const std::lock_guard lock(mutex_);
  phase_ = phase;
  changed_.notify_all();
}

void LiveLoop::run(RunOptions options, std::promise<void>& opened) {
  LiveHub* hub = nullptr;
  options.rendering = [&](const drivers::DeviceInfo& device) {
    const auto made = std::make_shared<LiveHub>(rendering_, device, options.scene, options.rate_hz);
    hub = made.get();
    {
      const std::lock_guard lock(mutex_);
      hub_ = made;
      ++runs_;
    }
    opened.set_value();
    return OtherRendering{.step = [this](const drivers::Sample& sample,
                                         double elapsed_s) { return rendering_(sample, elapsed_s); },
                          .finished = {}};
  };
  options.warn = [this](std::string_view line) {
    const std::lock_guard lock(mutex_);
    warning_ = line;
  };
  options.zero_hold = &hold_;
  options.each_row = [&hub](const schema::Row& row) { hub->push(row); };
  fault_.clear();
  figures_.clear();
  try {
    figures_ = run_on_device(options, stop_).figures;
  } catch (const std::exception& error) {
    if (hub == nullptr) return opened.set_exception(std::current_exception());
    fault_ = error.what();
  }
  is_run_over_ = true;
}

void LiveLoop::watch(LiveHub& hub) {
  stay_off_loop_processor();
  for (auto next = std::chrono::steady_clock::now();; std::this_thread::sleep_until(next)) {
    const bool is_last = is_run_over_;  // nothing comes after what is drained now
    try {
      hub.drain();
    } catch (const std::exception&) {  // no memory: nobody is to hold a device that nobody can watch
      close();
    }
    if (is_last) break;
    if (on_rows_) on_rows_();
    next = std::max(next + drain_period, std::chrono::steady_clock::now());
  }
  hub.end(fault_, figures_);
  {
    const std::lock_guard lock(mutex_);
    ended_ = fault_;
    phase_ = Phase::over;
  }
  if (on_rows_) on_rows_();
  enter(Phase::idle);
}

void LiveLoop::stop() {
  std::unique_lock lock(mutex_);
  stop_ = true;
  changed_.wait(lock, [this] { return phase_ == Phase::idle; });
}

void LiveLoop::tell_fault(const std::string& fault) {
  const std::lock_guard lock(mutex_);
  ended_ = fault;
}

void LiveLoop::require_running() const {
  if (phase_ != Phase::running) throw std::invalid_argument("no loop is running: start it first");
}

std::shared_ptr<LiveHub> LiveLoop::running_hub() const {
  const std::lock_guard lock(mutex_);
  require_running();
  return hub_;
}

void LiveLoop::render(const LawFile& law, const std::string& name) {
  const std::lock_guard lock(mutex_);  // no other loop begins meanwhile
  require_running();
  const std::vector<std::size_t> axes = named_axes_for(law, hub_->device());
  hub_->offer(std::make_unique<LawRendering>(law.law, law.contact, axes),
              {.law = name, .plugin = plugin_in_words(law.law)});
}

void LiveLoop::render_nothing() {
  const std::lock_guard lock(mutex_);
  require_running();
  hub_->offer(nullptr, {});
}

void LiveLoop::start_recording(const std::filesystem::path& file, bool replace) {
  const WithoutSignals none;
  running_hub()->start_recording(file, replace);
}

void LiveLoop::mark(const std::string& text) { running_hub()->mark(text); }

void LiveLoop::stop_recording() { running_hub()->stop_recording(); }

LiveLoop::Watched LiveLoop::watched() const {
  const std::lock_guard lock(mutex_);
  return {.run = runs_, .hub = hub_};
}

LiveStatus LiveLoop::status() const {
  LiveStatus status;
  std::shared_ptr<LiveHub> hub;
  {
    const std::lock_guard lock(mutex_);
    status.is_running = phase_ == Phase::running;
    status.is_starting = phase_ == Phase::starting;
    status.run = runs_;
    status.ended = ended_;
    status.warning = warning_;
    hub = hub_;
  }
  if (hub) hub->tell(status);
  if (!status.is_running) status.law.clear();
  status.is_released = rendering_.is_released();
  status.is_held = status.is_running && hold_.is_held();
  status.is_blending = status.is_running && rendering_.is_blending();
  return status;
}

}  // namespace kerf::bench
