#include "kerf/drivers/woodenhaptics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "age_limits.h"
#include "interruption.h"
#include "kerf/drivers/woodenhaptics_signs.h"

namespace kerf::drivers {
namespace {

using woodenhaptics::Generation;
using woodenhaptics::Report;
using Configuration = mechanisms::WoodenHaptics::Configuration;
using Vector = mechanisms::WoodenHaptics::Vector;

constexpr std::int64_t ms_ns = 1'000'000;
constexpr std::int64_t keep_alive_ns = 50 * ms_ns;  // a tenth of the device's own watchdog
constexpr std::int64_t answer_wait_ns = 10 * ms_ns;
constexpr std::int64_t idle_ns = 2 * ms_ns;  // V2 and V3 without a tick: so often a position nevertheless
constexpr std::int64_t max_final_zero_ns = 20 * ms_ns;
constexpr unsigned final_zero_reports = 3;    // the order that waits, this one, and the turn that applies it
constexpr std::uint16_t usage_page = 0xFFAB;  // a Teensy has another interface, for its own debugging
constexpr int max_preset_error = 200;         // counts: a hand holds the tip
constexpr unsigned many_refusals = 3;
// Of a stylus with a switch, which its firmware adds to the counter of the first gimbal encoder.
constexpr int switch_threshold = 5000;
constexpr int switch_offset = 10000;
constexpr double workspace_m = 0.1;
constexpr double speed_limit_m_s = 5.0;
constexpr double slew_limit_n_s = 2000.0;
constexpr double acceleration_limit_m_s2 = 200.0;
constexpr double report_jitter_s = 1e-3;  // a frame

constexpr std::array<WoodenHaptics::Product, 2> known{
    {{0x1234, 0x0006, "hid:1234:0006", "WoodenHaptics", "WoodenHaptics, 3 axes with force; 1 kHz",
      "woody-2019"},
     {0x16c0, 0x0486, "hid:16c0:0486", "Polhem",
      "a Teensy with raw HID: if it is a Polhem (WoodenHaptics V3), 3 axes with force; 1 kHz", "polhem-v3"}}};

std::string_view name_of(Generation generation) {
  return generation == Generation::v1 ? "V1" : generation == Generation::v2 ? "V2" : "V3";
}

/// How far the tip moves along each axis for one count of each encoder, in the middle [m].
mechanisms::WoodenHaptics::Matrix steps_in_the_middle(const mechanisms::WoodenHaptics& mechanism) {
  const Vector middle = *mechanism.angles_of(mechanism.configuration().centre_m);
  const Vector count = (mechanism.angles({1, 1, 1}) - mechanism.angles({0, 0, 0})).cwiseAbs();
  return mechanism.jacobian(middle).cwiseAbs() * count.asDiagonal();
}

AxisInfo axis(std::string name, double middle, double resolution, double force_limit) {
  return {.name = std::move(name),
          .position_unit = "m",
          .force_unit = "N",
          .resolution = resolution,
          .lower = middle - workspace_m,
          .upper = middle + workspace_m,
          .force_limit = force_limit,
          .slew_limit = slew_limit_n_s,
          .speed_limit = speed_limit_m_s,
          .acceleration_limit = acceleration_limit_m_s2};
}

Configuration with_most_current(const WoodenHaptics::Options& options) {
  Configuration made = *options.model;
  made.max_current_a = options.max_current_a;
  return made;
}

mechanisms::WoodenHaptics::Signs signs_for(Generation generation, const Configuration& model) {
  if (const auto signs = woodenhaptics::signs_of(generation, model)) return *signs;
  throw DeviceError(
      fmt::format("there is no {} with the reports of {}; name the model that it is with '?model='",
                  model.name, name_of(generation)));
}

}  // namespace

const std::array<WoodenHaptics::Product, 2>& WoodenHaptics::products() noexcept { return known; }

const WoodenHaptics::Product& WoodenHaptics::product(std::string_view name) {
  std::string all;
  for (const Product& one : known) {
    if (one.scheme == name) return one;
    all += fmt::format("{}{} ({})", all.empty() ? "" : " and ", one.scheme, one.what);
  }
  throw DeviceError(fmt::format(
      "no HID device '{}' is known; expected hid:VENDOR:PRODUCT in hexadecimal, there are {}", name, all));
}

std::vector<usb::Attached> WoodenHaptics::find(const Product& product) {
  return usb::find_hid(product.vendor, product.product, usage_page);
}

WoodenHaptics::Options WoodenHaptics::parse_options(Uri uri, const Product& product) {
  UriOptions given(std::move(uri));
  Options options;
  options.index = static_cast<std::size_t>(given.count("index", 0));
  const std::string name = given.text("model").value_or(std::string(product.model));
  options.model = mechanisms::WoodenHaptics::find(name);
  if (options.model == nullptr) {
    std::string all;
    for (const auto& one : mechanisms::WoodenHaptics::configurations()) {
      all += fmt::format("{}{}", all.empty() ? "" : ", ", one.name);
    }
    throw DeviceError(
        fmt::format("device '{}': option 'model' is '{}', expected one of {}", product.scheme, name, all));
  }
  const double most = options.model->max_current_a;
  options.max_current_a = given.number("most_current", {"A", most, 0.0, most});
  options.calibrate = given.flag("calibrate", false);
  if (const auto preset = given.text("preset")) {
    if (*preset != "home") {
      throw DeviceError(
          fmt::format("device '{}': option 'preset' is '{}', expected home", product.scheme, *preset));
    }
    options.preset = true;
  }
  given.refuse_others();
  return options;
}

WoodenHaptics::WoodenHaptics(std::string_view uri, const Product& product, const Options& options,
                             const std::atomic<bool>* stop)
    : options_(options),
      device_({product.vendor, product.product, product.what}, options.index, usage_page),
      generation_(recognise(product)),
      mechanism_(with_most_current(options), signs_for(generation_, *options.model)) {
  const double least_step_m = steps_in_the_middle(mechanism_).colwise().norm().minCoeff();
  max_count_rate_ = 2.0 * speed_limit_m_s / least_step_m;  // nearer to the column a count is half as long
  max_count_step_ = static_cast<int>(2.5 * workspace_m / least_step_m);
  meet(product, stop);
  describe(uri, product);
  opened_ns_ = usb::now_ns();
  thread_.start([this](const std::stop_token& token) { serve(token); });
}

Generation WoodenHaptics::recognise(const Product& product) const {
  const usb::HidReportSizes sizes = device_.report_sizes();
  const auto generation = woodenhaptics::generation_of(sizes.input);
  const bool teensy = product.vendor == known[1].vendor;
  if (generation && sizes.output == sizes.input && (*generation == Generation::v3) == teensy)
    return *generation;
  throw DeviceError(fmt::format(
      "{}: {} has reports of {} bytes in and {} out, expected {}; it is another device with the same "
      "numbers: unplug "
      "it, or choose with '?index='",
      product.what, device_.node(), sizes.input, sizes.output, teensy ? "64 (V3)" : "8 (V1) or 14 (V2)"));
}

/// The first report that is not older than the question.
Report WoodenHaptics::first_report(const Product& product, const std::atomic<bool>* stop) {
  std::array<std::uint8_t, woodenhaptics::max_report_size> bytes{};
  const std::int64_t until_ns = usb::now_ns() + max_silence_ns;
  // What a device in lock-step had ready when it was last closed is as old as that; the next one may be it as
  // well.
  int wanted = streams() ? 1 : 3;
  std::optional<Report> newest;
  while (usb::now_ns() < until_ns) {
    refuse_if_stopped(product.what, stop);
    if (!streams()) send({});
    int size = device_.read(bytes, 10);
    bool came = false;
    for (; size > 0; size = device_.read(bytes, 0)) {
      const auto report =
          woodenhaptics::parse_report(std::span(bytes).first(static_cast<std::size_t>(size)), generation_);
      if (!report) continue;
      newest = report;
      came = true;
    }
    if (size < 0)
      throw DeviceError(fmt::format("{}: {} was unplugged; plug it in again", product.what, device_.node()));
    if (came && --wanted == 0) return *newest;
  }
  throw DeviceError(fmt::format(
      "{}: {} sends no reports of {} bytes; expected one within 10 ms: unplug it and plug it in again",
      product.what, device_.node(), woodenhaptics::report_size(generation_)));
}

void WoodenHaptics::meet(const Product& product, const std::atomic<bool>* stop) {
  if (options_.preset) {
    const auto order = woodenhaptics::preset_counters({}, generation_);
    if (!order) {
      throw DeviceError(fmt::format("{}: {} is a V1, whose counters cannot be preset; use calibrate=on",
                                    product.what, device_.node()));
    }
    (void)first_report(product, stop);
    device_.write(std::span(order->bytes).first(order->size));
  }
  const Report report = first_report(product, stop);
  counters_.start(report.encoder);
  if (options_.calibrate || options_.preset) home_count_ = counters_.count();
  if (options_.preset) {
    const bool far =
        std::ranges::any_of(home_count_, [](int count) { return std::abs(count) > max_preset_error; });
    if (far) {
      throw DeviceError(
          fmt::format("{}: {} did not preset its counters (they are {}, {}, {}); leave out preset=home",
                      product.what, device_.node(), home_count_[0], home_count_[1], home_count_[2]));
    }
    home_count_ = {};
  }
  hear(report);
  heard_.take(last_);
  const Vector& middle = mechanism_.configuration().centre_m;
  const double distance_m = (mechanism_.tip(mechanism_.angles(last_.count)) - middle).norm();
  // It may stand at home, where that is outside of the workspace.
  if (!(distance_m <= 2.0 * workspace_m + (mechanism_.home() - middle).norm())) {
    throw DeviceError(fmt::format(
        "{}: by its counters the tip of {} is {:.2f} m from the middle of its workspace, expected "
        "0.1 m at most; it was not at home when it was switched on: hold it there and open it "
        "with calibrate=on",
        product.what, device_.node(), distance_m));
  }
}

void WoodenHaptics::describe(std::string_view uri, const Product& product) {
  const Configuration& made = mechanism_.configuration();
  const Vector& middle = made.centre_m;
  const Vector resolution = steps_in_the_middle(mechanism_).rowwise().maxCoeff();
  const double force = made.max_force_n;
  info_ = {.uri = std::string(uri),
           .model = fmt::format("{} {} ({})", product.what, made.name, name_of(generation_)),
           .about = std::string(product.about),
           .axes = {axis("x", middle[0], resolution[0], force), axis("y", middle[1], resolution[1], force),
                    axis("z", middle[2], resolution[2], force)},
           .channels = {{"current_a", "A"}, {"current_b", "A"}, {"current_c", "A"}, {"report_age", "s"}},
           .report_jitter_s = report_jitter_s,
           .configuration = configuration()};
  if (!streams()) {
    info_.channels.insert(info_.channels.end(),
                          {{"button", "1"}, {"gimbal_d", "1"}, {"gimbal_e", "1"}, {"gimbal_f", "1"}});
  }
}

std::string WoodenHaptics::configuration() const {
  const Configuration& made = mechanism_.configuration();
  const auto three = [](const auto& values, double factor = 1.0) {
    return fmt::format("[{}, {}, {}]", factor * values[0], factor * values[1], factor * values[2]);
  };
  return fmt::format(
      "model = \"{}\"\ngeneration = \"{}\"\nhome = \"{}\"\nhome_counts = [{}, {}, {}]\n"
      "most_current = {{ value = {}, unit = \"A\" }}\nmost_force = {{ value = {}, unit = \"N\" }}\n\n"
      "[mechanism]\nprovenance = \"configuration files of the makers, not measured on this device\"\n"
      "capstan_diameter = {{ value = {}, unit = \"m\" }}\nbody_diameter = {{ value = {}, unit = \"m\" }}\n"
      "length = {{ value = {}, unit = \"m\" }}\norigin = {{ value = {}, unit = \"m\" }}\n"
      "torque_constant = {{ value = {}, unit = \"N·m/A\" }}\ncounts_per_turn = {}\n",
      made.name, name_of(generation_),
      options_.preset      ? "preset where it was opened"
      : options_.calibrate ? "where it was opened"
                           : "where it was switched on",
      home_count_[0], home_count_[1], home_count_[2], made.max_current_a, made.max_force_n,
      three(made.capstan_m), three(made.body_m), three(made.length_m), three(made.origin_m),
      three(made.torque_constant), made.counts_per_turn);
}

Status WoodenHaptics::read(double now_s, Sample& sample) noexcept {
  (void)heard_.take(last_);
  (void)sent_.take(last_sent_);
  const std::int64_t age_ns = usb::now_ns() - last_.at_ns;
  const Vector tip = mechanism_.tip(mechanism_.angles(last_.count));
  for (std::size_t at = 0; at < 3; ++at) {
    sample.position[at] = tip[static_cast<Eigen::Index>(at)];
    sample.velocity[at] = velocity_.update(at, sample.position[at], now_s);
    sample.channels[at] = 1e-3 * last_sent_[at];
    if (!streams()) sample.channels[5 + at] = last_.gimbal[at];
  }
  velocity_.advance(now_s);
  sample.channels[3] = 1e-9 * static_cast<double>(age_ns);
  if (!streams()) sample.channels[4] = last_.button ? 1.0 : 0.0;
  if (lost_.load(std::memory_order_relaxed) || age_ns > max_silence_ns) return Status::lost;
  return age_ns > max_reading_age_ns ? Status::fault : Status::ok;
}

Status WoodenHaptics::write(const Axes& force) noexcept {
  const bool finite = std::ranges::all_of(force, [](double one) { return std::isfinite(one); });
  Command command{.releases = releases_.load(std::memory_order_acquire), .at_ns = usb::now_ns()};
  if (finite) {
    Vector cut;
    for (std::size_t at = 0; at < 3; ++at) {
      const double limit = mechanism_.configuration().max_force_n;
      cut[static_cast<Eigen::Index>(at)] = std::clamp(force[at], -limit, limit);
    }
    const auto currents = mechanism_.currents(cut, mechanism_.angles(last_.count));
    for (std::size_t at = 0; at < 3; ++at) {
      command.current_ma[at] = static_cast<int>(std::lround(1e3 * currents.ampere[at]));
    }
    if (currents.limited) limited_.fetch_add(1, std::memory_order_relaxed);
  }
  commanded_.put(command);
  if (lost_.load(std::memory_order_relaxed)) return Status::lost;
  thread_.wake();
  return finite && !refuses_.load(std::memory_order_relaxed) ? Status::ok : Status::fault;
}

void WoodenHaptics::release(double) noexcept {
  releases_.fetch_add(1, std::memory_order_release);
  thread_.wake();
}

void WoodenHaptics::serve(const std::stop_token& stop) noexcept {
  std::int64_t now_ns = usb::now_ns();
  while (!stop.stop_requested()) {
    const auto ready = device_.wait(next_turn_ns(now_ns), thread_.wake_descriptor());
    if (ready.woken) thread_.take_wakes();
    if (ready.report && !hear()) {
      lost_.store(true);
      return;  // not again and again: the kernel needs the processor to take the device away
    }
    now_ns = usb::now_ns();
    speak(now_ns);
  }
  send_final_zero();
}

/// Zero, and some reports more: a device that nobody reads from any more does not come to its next order
/// either.
void WoodenHaptics::send_final_zero() noexcept {
  send({});
  const std::uint64_t enough =
      reports_.load(std::memory_order_relaxed) + (streams() ? final_zero_reports : 1);
  const std::int64_t until_ns = usb::now_ns() + max_final_zero_ns;
  while (reports_.load(std::memory_order_relaxed) < enough && usb::now_ns() < until_ns) {
    if (device_.wait(until_ns - usb::now_ns(), -1).report && !hear()) return;
  }
}

std::int64_t WoodenHaptics::next_turn_ns(std::int64_t now_ns) const noexcept {
  if (streams()) return answer_wait_ns;
  return (answered_ ? heard_ns_ + idle_ns : sent_ns_ + answer_wait_ns) - now_ns;
}

/// Takes a report. False if the device is gone.
bool WoodenHaptics::hear() noexcept {
  std::array<std::uint8_t, woodenhaptics::max_report_size> bytes{};
  const int size = device_.read(bytes, 0);
  if (size <= 0) return size == 0;
  const auto report =
      woodenhaptics::parse_report(std::span(bytes).first(static_cast<std::size_t>(size)), generation_);
  if (report) {
    hear(*report);
  } else {
    malformed_.fetch_add(1, std::memory_order_relaxed);
    answered_ = true;
  }
  return true;
}

void WoodenHaptics::hear(const Report& report) noexcept {
  const std::int64_t now = usb::now_ns();
  // Of several that waited in a row each may be a millisecond from the one before.
  const std::int64_t elapsed_ns = std::max(now - heard_ns_, ms_ns);
  const double most = std::min(1e-9 * static_cast<double>(elapsed_ns) * max_count_rate_,
                               static_cast<double>(max_count_step_));
  answered_ = true;
  if (!counters_.take(report.encoder, static_cast<int>(most) + 2)) {
    implausible_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  heard_ns_ = now;
  const auto heard_before = reports_.fetch_add(1, std::memory_order_relaxed);
  if (streams()) {
    const int lost = static_cast<std::uint16_t>(report.counter - last_counter_ - 1);
    if (heard_before > 0) gaps_.fetch_add(static_cast<unsigned>(lost), std::memory_order_relaxed);
    last_counter_ = report.counter;
  }
  Heard heard{.button = report.button, .at_ns = now};
  for (std::size_t at = 0; at < 3; ++at) {
    heard.count[at] = counters_.count()[at] - home_count_[at];
    heard.gimbal[at] = report.encoder[3 + at];
  }
  if (heard.gimbal[0] > switch_threshold) {
    heard.gimbal[0] -= switch_offset;
    heard.button = true;
  }
  heard_.put(heard);
}

WoodenHaptics::Currents WoodenHaptics::wanted(std::int64_t now_ns) const noexcept {
  const bool released = command_.releases != releases_.load(std::memory_order_acquire);
  return released || now_ns - command_.at_ns > max_command_age_ns ? Currents{} : command_.current_ma;
}

/// Sends what the tick wants, when it is time to.
void WoodenHaptics::speak(std::int64_t now_ns) noexcept {
  if (commanded_.take(command_)) fresh_ = true;
  const Currents current_ma = wanted(now_ns);
  const bool stops = current_ma == Currents{} && sent_ma_ != Currents{};  // is not put off
  if (streams()) {
    if (fresh_ || stops || now_ns - sent_ns_ >= keep_alive_ns) send(current_ma);
  } else if (stops || (answered_ && (fresh_ || now_ns - heard_ns_ >= idle_ns))) {
    send(current_ma);
  } else if (!answered_ && now_ns - sent_ns_ >= answer_wait_ns) {
    resent_.fetch_add(1, std::memory_order_relaxed);
    send(current_ma);
  }
}

void WoodenHaptics::send(const Currents& current_ma) noexcept {
  const auto order = woodenhaptics::set_currents(current_ma, generation_);
  const bool sent = device_.write(std::span(order.bytes).first(order.size));
  sent_ns_ = usb::now_ns();
  answered_ = false;
  refused_in_a_row_ = sent ? 0 : refused_in_a_row_ + 1;
  refuses_.store(refused_in_a_row_ >= many_refusals, std::memory_order_relaxed);
  if (!sent) {
    refused_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  fresh_ = false;
  sent_ma_ = current_ma;
  sent_.put(current_ma);
}

std::vector<Figure> WoodenHaptics::figures() const {
  const double seconds = 1e-9 * static_cast<double>(usb::now_ns() - opened_ns_);
  const auto count = [](const std::atomic<std::uint64_t>& one) { return static_cast<double>(one.load()); };
  std::vector<Figure> all{{"report_rate", seconds > 0.0 ? count(reports_) / seconds : 0.0, "Hz"},
                          {"reports", count(reports_), "1"},
                          {"malformed", count(malformed_), "1"},
                          {"implausible", count(implausible_), "1"},
                          {"orders_refused", count(refused_), "1"},
                          {"current_limited", count(limited_), "1"}};
  if (streams()) {
    all.push_back({"counter_gaps", count(gaps_), "1"});
  } else {
    all.push_back({"resent", count(resent_), "1"});
  }
  return all;
}

}  // namespace kerf::drivers
