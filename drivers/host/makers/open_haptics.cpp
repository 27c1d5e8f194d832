#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "age_limits.h"
#include "built_in.h"
#include "hosted/host_page.h"
#include "kerf/drivers/toml_text.h"
#include "kerf/drivers/uri.h"
#include "makers/hd.h"
#include "makers/vendor_library.h"
#include "own_device.h"
#include "work.h"

namespace kerf::host {
namespace {

using drivers::UriOptions;
using drivers::hosted::SharedRing;

constexpr int frame_ms = 10;
constexpr std::int64_t stands_ns = 20'000'000;
constexpr std::int64_t stood_too_long_ns = 1'000'000'000;
constexpr std::int64_t errs_too_long_ns = 1'000'000'000;
constexpr int calibration_rounds = 200;  // of 10 ms
constexpr int frames_to_let_go = 2;
constexpr int most_errors_of_a_frame = 8;
constexpr std::uint64_t temperature_every = 100;
constexpr double highest_force_n = 50.0;

/// What the servo loop of the maker's library has read, and what went wrong in that frame.
struct Frame {
  std::array<double, 3> position_mm{};
  std::array<double, 3> gimbal_rad{};
  std::array<double, 3> temperature{};
  std::int32_t buttons = 0;
  std::uint32_t error = 0;
  double write_delay_s = 0.0;
  std::int64_t begun_ns = 0;
};

struct Given {
  std::array<double, 3> force_n{};
  std::int64_t at_ns = 0;
};

/// A Touch, Omni, Desktop or Premium by OpenHaptics. Its scheduler, a thread of the maker's, reads and
/// writes; this hands forces to it and takes what it read.
class OpenHaptics {
 public:
  static constexpr const char* name = "openhaptics";
  static constexpr double open_s = 10.0;
  static constexpr std::array<const char*, 4> options{"device", "library", "most_force", nullptr};
  static std::unique_ptr<OpenHaptics> open(UriOptions& given) {
    VendorLibrary library = find(given.text("library").value_or("libHD.so"));
    const double most = given.number("most_force", {"N", 0.0, 0.1, highest_force_n});
    return std::make_unique<OpenHaptics>(library, given.text("device").value_or(""), most);
  }

  [[nodiscard]] static VendorLibrary find(const std::string& file) {
    return VendorLibrary({.files = std::array{file},
                          .what = "3D Systems' OpenHaptics",
                          .mend =
                              "install its Linux package and the Touch Device Driver, or name the library: "
                              "library=/path/libHD.so"});
  }

  OpenHaptics(VendorLibrary& library, std::string device, double most_n)
      : hd_(library),
        file_(library.file()),
        device_(std::move(device)),
        wakes_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    const bool is_default = device_.empty() || device_ == "default";
    handle_ = hd_.init_device(is_default ? nullptr : device_.c_str());
    if (const std::uint32_t error = newest_error(); handle_ == hd::invalid || error != 0) {
      throw std::runtime_error(fmt::format("the device '{}' of OpenHaptics does not start: {}",
                                           is_default ? "default" : device_, told(error)));
    }
    hd_.make_current(handle_);
    try {
      look(most_n);
      calibrate();
    } catch (...) {
      hd_.disable_device(handle_);
      throw;
    }
  }
  OpenHaptics(const OpenHaptics&) = delete;
  OpenHaptics& operator=(const OpenHaptics&) = delete;
  ~OpenHaptics() {
    stop();
    hd_.disable_device(handle_);
    ::close(wakes_);
  }

  void describe(kerf_device_facts_v1& facts) const {
    facts.flags = KERF_WRITES_ANY_TIME | KERF_COUNTS_READINGS;
    facts.rate_hz = 1000.0;
    facts.jitter_s = 1e-3;
    tell(facts.model, model_);
    tell(facts.about, fmt::format("{} by OpenHaptics, 3 axes with force; 1 kHz", model_));
    tell(facts.serial, serial_);
    for (std::size_t i = 0; i < 3; ++i) {
      add_axis(facts, {std::string_view("xyz").substr(i, 1), 0.0, 1e-3 * workspace_mm_.at(i),
                       1e-3 * workspace_mm_.at(i + 3), most_n_});
    }
    add_channel(facts, "buttons", "1", KERF_CHANNEL_BUTTON);
    for (const char* const angle : {"gimbal_1", "gimbal_2", "gimbal_3"}) add_channel(facts, angle, "rad");
    add_channel(facts, "motor_temperature", "1");
    add_channel(facts, "write_delay", "s");
    add_channel(facts, "error", "1");
    tell(facts.settings, fmt::format("library = {}\nlibrary_version = {}\ndriver_version = "
                                     "{}\nnominal_max_force = {{ value = {}, unit = "
                                     "\"N\" }}\nnominal_continuous_force = {{ value = {}, unit = \"N\" }}\n",
                                     drivers::toml_text(file_), drivers::toml_text(version_),
                                     drivers::toml_text(driver_), peak_n_, continuous_n_));
  }

  int read(kerf_device_reading_v1& reading) {
    // Not before: what stands by is a copy of this process, and would have none of the library's threads.
    if (!runs_ && !start()) return -1;
    pollfd wakes{.fd = wakes_, .events = POLLIN, .revents = 0};
    (void)poll(&wakes, 1, frame_ms);
    std::uint64_t count = 0;
    [[maybe_unused]] const auto taken = ::read(wakes_, &count, sizeof count);
    const std::uint64_t newest = frames_.count();
    Frame frame;
    if (newest == seen_ || !frames_.get(newest, frame)) return servo_stands();
    seen_ = newest;
    last_ns_ = now_ns();
    if (is_cut_.exchange(false)) hd_.enable(hd::force_output);
    if (!is_bearable(frame.error)) return -1;
    if (frame.error != 0) reading.flags |= KERF_DOUBTED;
    for (std::size_t i = 0; i < 3; ++i) {
      reading.position[i] = 1e-3 * frame.position_mm.at(i);
      reading.channels[1 + i] = frame.gimbal_rad.at(i);
    }
    reading.channels[0] = frame.buttons;
    reading.channels[4] = *std::ranges::max_element(frame.temperature);
    reading.channels[5] = frame.write_delay_s;
    reading.channels[6] = frame.error;
    reading.taken_ns = frame.begun_ns;
    reading.number = newest;
    return 1;
  }

  int write(const double* force) noexcept {
    given_.put({.force_n = {force[0], force[1], force[2]}, .at_ns = now_ns()});
    return 0;
  }

  void release() noexcept {
    if (getpid() != opened_by_ || !runs_) return cut();
    const std::uint64_t before = frames_.count();
    given_.put({.at_ns = now_ns()});
    // A servo loop that stands takes no zero either.
    for (int round = 0; round < frame_ms; ++round) {
      if (frames_.count() >= before + frames_to_let_go) return;
      usleep(1000);
    }
    cut();
  }

  [[nodiscard]] const char* trouble() const noexcept { return trouble_.c_str(); }

 private:
  /// What it says of itself. @throws std::runtime_error where that leaves a limit open
  void look(double most_n) {
    const auto text = [&](std::uint32_t what) {
      const char* const said = hd_.get_string(what);
      return std::string(said == nullptr ? "" : said);
    };
    model_ = text(hd::device_model);
    if (model_.empty()) model_ = "OpenHaptics device";
    serial_ = text(hd::serial_number);
    version_ = text(hd::version);
    driver_ = text(hd::driver_version);
    hd_.get_doubles(hd::nominal_max_force, &peak_n_);
    hd_.get_doubles(hd::nominal_continuous_force, &continuous_n_);
    hd_.get_doubles(hd::usable_workspace, workspace_mm_.data());
    (void)newest_error();  // what it does not know, it has left as it was
    const auto is_limit = [](double one) {
      return std::isfinite(one) && one > 0.0 && one <= highest_force_n;
    };
    if (most_n == 0.0 && !is_limit(continuous_n_)) {
      throw std::runtime_error(fmt::format(
          "{} tells no force that it bears for long; give the largest that it may have: most_force=1N",
          model_));
    }
    if (is_limit(peak_n_) && most_n > peak_n_) {
      throw std::runtime_error(
          fmt::format("most_force={:g}N: {} gives at most {:g} N", most_n, model_, peak_n_));
    }
    most_n_ = most_n == 0.0 ? continuous_n_ : most_n;
    for (std::size_t i = 0; i < 3; ++i) {
      const double lower = workspace_mm_.at(i);
      const double upper = workspace_mm_.at(i + 3);
      if (std::isfinite(lower) && std::isfinite(upper) && lower < upper) continue;
      throw std::runtime_error(fmt::format("{} tells a workspace of {:g} to {:g} mm along {}: is it set up?",
                                           model_, lower, upper, std::string_view("xyz").substr(i, 1)));
    }
  }

  /// @throws std::runtime_error with what a person has to do
  void calibrate() {
    std::int32_t styles = 0;
    hd_.get_integers(hd::calibration_style, &styles);
    const auto has = [&](std::uint32_t style) { return (static_cast<std::uint32_t>(styles) & style) != 0; };
    std::uint32_t style = hd::style_inkwell;
    if (has(hd::style_auto)) {
      style = hd::style_auto;
    } else if (!has(hd::style_inkwell) && has(hd::style_encoder_reset)) {
      style = hd::style_encoder_reset;
    }
    const auto state = [&] {
      // In a frame, so that it is the state of now though no servo loop runs yet.
      hd_.begin_frame(handle_);
      const std::uint32_t told = hd_.check_calibration();
      hd_.end_frame(handle_);
      return told;
    };
    std::uint32_t now = state();
    if (now != hd::calibration_ok && style == hd::style_encoder_reset) hd_.update_calibration(style);
    for (int round = 0; round < calibration_rounds && now != hd::calibration_ok; ++round) {
      if (now == hd::calibration_needs_update) hd_.update_calibration(style);
      usleep(10'000);
      now = state();
    }
    if (now == hd::calibration_ok) return (void)newest_error();
    const std::uint32_t error = newest_error();
    throw std::runtime_error(
        fmt::format("{} is not calibrated: {}{}", model_,
                    style == hd::style_inkwell ? "put the stylus into the inkwell, and begin again"
                    : style == hd::style_auto  ? "move it through its workspace, and begin again"
                                               : "hold it where it rests, and begin again",
                    error == 0 ? "" : " (" + told(error) + ")"));
  }

  bool start() {
    hd_.set_scheduler_rate(1000);
    hd_.enable(hd::force_output);
    scheduled_ = hd_.schedule_asynchronous(&OpenHaptics::servo, this, hd::usual_priority);
    hd_.start_scheduler();
    runs_ = true;
    last_ns_ = now_ns();
    const std::uint32_t error = newest_error();
    if (error == 0) return true;
    trouble_ = "its servo loop does not start: " + told(error);
    return false;
  }

  void stop() noexcept {
    if (runs_) {
      hd_.unschedule(scheduled_);
      hd_.stop_scheduler();
    }
    runs_ = false;
    cut();
  }

  /// By whoever calls: zero force in a frame of its own, and no force output any more.
  void cut() noexcept {
    constexpr std::array<double, 3> zero{};
    hd_.make_current(handle_);
    hd_.begin_frame(handle_);
    hd_.set_doubles(hd::current_force, zero.data());
    hd_.end_frame(handle_);
    hd_.disable(hd::force_output);
    is_cut_ = true;
  }

  int servo_stands() {
    const std::int64_t stood_ns = now_ns() - last_ns_;
    if (stood_ns > stands_ns && !is_cut_) cut();
    if (stood_ns <= stood_too_long_ns) return 0;
    trouble_ = "the servo loop of OpenHaptics has stood still for a second";
    return -1;
  }

  bool is_bearable(std::uint32_t error) {
    if (error == 0) {
      errs_since_ns_ = 0;
      return true;
    }
    if (errs_since_ns_ == 0) errs_since_ns_ = last_ns_;
    if (!hd::ends_it(error) && last_ns_ - errs_since_ns_ < errs_too_long_ns) return true;
    trouble_ = told(error);
    return false;
  }

  /// In the thread of the maker's library: as short as it can be, and nothing that throws.
  static std::uint32_t servo(void* self) noexcept {
    static_cast<OpenHaptics*>(self)->turn();
    return hd::callback_goes_on;
  }
  void turn() noexcept {
    const std::uint64_t number = given_.count();
    const bool is_new = number != carried_ && given_.get(number, force_);
    Frame frame{.begun_ns = now_ns()};
    const bool counts = frame.begun_ns - force_.at_ns <= drivers::max_command_age_ns;
    const std::array<double, 3> force_n = counts ? force_.force_n : std::array<double, 3>{};
    hd_.make_current(handle_);
    hd_.begin_frame(handle_);
    hd_.get_doubles(hd::current_position, frame.position_mm.data());
    hd_.get_doubles(hd::current_gimbal_angles, frame.gimbal_rad.data());
    hd_.get_integers(hd::current_buttons, &frame.buttons);
    if (turns_++ % temperature_every == 0) hd_.get_doubles(hd::motor_temperature, temperature_.data());
    hd_.set_doubles(hd::current_force, force_n.data());
    hd_.end_frame(handle_);
    frame.temperature = temperature_;
    if (is_new) {
      carried_ = number;
      write_delay_s_ = 1e-9 * static_cast<double>(now_ns() - force_.at_ns);
    }
    frame.write_delay_s = write_delay_s_;
    frame.error = newest_error();
    frames_.put(frame);
    constexpr std::uint64_t one = 1;
    [[maybe_unused]] const auto written = ::write(wakes_, &one, sizeof one);
  }

  /// The newest error that waits, of those that end a run before others; the rest is forgotten, or it would
  /// be told for ever.
  std::uint32_t newest_error() noexcept {
    std::uint32_t newest = 0;
    for (int round = 0; round < most_errors_of_a_frame; ++round) {
      const std::uint32_t code = hd_.get_error().code;
      if (code == 0) break;
      if (newest == 0 || (hd::ends_it(code) && !hd::ends_it(newest))) newest = code;
    }
    return newest;
  }

  [[nodiscard]] std::string told(std::uint32_t error) const {
    if (error == 0) return "it does not say why";
    if (const char* const words = hd::in_words(error)) return words;
    const char* const theirs = hd_.get_error_string(error);
    return fmt::format("error {:#06x} of OpenHaptics{}{}", error, theirs == nullptr ? "" : ": ",
                       theirs == nullptr ? "" : theirs);
  }

  hd::Functions hd_;
  std::string file_;
  std::string device_;
  int wakes_;
  hd::Handle handle_ = hd::invalid;
  std::string model_;
  std::string serial_;
  std::string version_;
  std::string driver_;
  double peak_n_ = 0.0;
  double continuous_n_ = 0.0;
  double most_n_ = 0.0;
  std::array<double, 6> workspace_mm_{};

  unsigned long scheduled_ = 0;
  std::atomic<bool> runs_{false};
  std::atomic<bool> is_cut_{false};
  std::uint64_t seen_ = 0;
  std::int64_t last_ns_ = 0;
  std::int64_t errs_since_ns_ = 0;
  std::string trouble_;
  pid_t opened_by_ = getpid();

  SharedRing<Frame, 64> frames_;  // of the servo loop
  SharedRing<Given, 8> given_;    // of whoever writes
  // Of the servo loop alone.
  Given force_;
  std::uint64_t carried_ = 0;
  double write_delay_s_ = std::nan("");
  std::uint64_t turns_ = 0;
  std::array<double, 3> temperature_{};
};

}  // namespace

std::string look_for_open_haptics() {
  VendorLibrary library = OpenHaptics::find("libHD.so");
  (void)hd::Functions(library);
  return library.file() + "; which devices there are it does not tell";
}

const kerf_device_v1 open_haptics_device =
    as_plugin<OpenHaptics>("Touch, Omni, Desktop, Premium by OpenHaptics");

}  // namespace kerf::host
