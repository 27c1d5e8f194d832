#include "kerf/drivers/woodenhaptics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "age_limits.h"
#include "interruption.h"
#include "kerf/drivers/usb/hid_device.h"
#include "kerf/drivers/woodenhaptics_signs.h"
#include "woodenhaptics/woodenhaptics_axes.h"
#include "woodenhaptics/woodenhaptics_link.h"

namespace kerf::drivers {
namespace {

using namespace woodenhaptics;
using Configuration = mechanisms::WoodenHaptics::Configuration;
using Vector = mechanisms::WoodenHaptics::Vector;

constexpr int report_wait_ms = 10;
// Usage page FFAB: what a Teensy of another project, or its interface for debugging, does not have.
constexpr std::array<std::uint8_t, 3> usage_page{0x06, 0xAB, 0xFF};
constexpr int max_preset_error = 200;  // counts: a hand holds the tip

constexpr std::array<WoodenHaptics::Product, 2> known{
    {{0x1234, 0x0006, "hid:1234:0006", "WoodenHaptics", "WoodenHaptics, 3 axes with force; 1 kHz",
      "woody-2019"},
     {0x16c0, 0x0486, "hid:16c0:0486", "Polhem",
      "a Teensy with raw HID: if it is a Polhem (WoodenHaptics V3), 3 axes with force; 1 kHz", "polhem-v3"}}};

std::string_view name_of(Generation generation) {
  return generation == Generation::v1 ? "V1" : generation == Generation::v2 ? "V2" : "V3";
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
  return usb::find_usb(product.vendor, product.product);
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
      device_({product.vendor, product.product, product.what}, options.index),
      generation_(recognise(product)),
      mechanism_(with_most_current(options), signs_for(generation_, *options.model)) {
  const auto [in, out] = device_.endpoints();
  guard_.emplace(product.what, device_.descriptor(), woodenhaptics::letting_go(out, in, generation_));
  meet(product, stop);
  describe(uri, product);
  opened_ns_ = usb::now_ns();
  thread_.start([this](const std::stop_token& token) { link_->run(token); });
}

WoodenHaptics::~WoodenHaptics() = default;

Generation WoodenHaptics::recognise(const Product& product) {
  const auto descriptor = device_.report_descriptor();
  const usb::HidReportSizes sizes = usb::hid_report_sizes(descriptor);
  const auto generation = woodenhaptics::generation_of(sizes.input);
  const bool teensy = product.vendor == known[1].vendor;
  const bool ours = descriptor.size() > usage_page.size() &&
                    std::equal(usage_page.begin(), usage_page.end(), descriptor.begin());
  if (ours && generation && sizes.output == sizes.input && (*generation == Generation::v3) == teensy)
    return *generation;
  throw DeviceError(fmt::format(
      "{}: {} has reports of {} bytes in and {} out, expected {}; it is another device with the same "
      "numbers: unplug "
      "it, or choose with '?index='",
      product.what, device_.node(), sizes.input, sizes.output, teensy ? "64 (V3)" : "8 (V1) or 14 (V2)"));
}

/// Before the link runs.
void WoodenHaptics::send(std::span<const std::uint8_t> order) {
  device_.send(device_.endpoints().out, order.subspan(1));  // without the number that it does not have
}

/// The first report that is not older than the question.
Report WoodenHaptics::first_report(const Product& product, const std::atomic<bool>* stop) {
  std::array<std::uint8_t, woodenhaptics::max_report_size> bytes{};
  const std::int64_t until_ns = usb::now_ns() + max_silence_ns;
  const bool streams = generation_ == Generation::v1;
  // What a device in lock-step had ready when it was last closed is as old as that; the next one may be it as
  // well.
  int wanted = streams ? 1 : 3;
  const auto nothing = woodenhaptics::set_currents({}, generation_);
  while (usb::now_ns() < until_ns) {
    refuse_if_stopped(product.what, stop);
    if (!streams) send(std::span(nothing.bytes).first(nothing.size));
    const std::size_t size = device_.receive(device_.endpoints().in, bytes, report_wait_ms);
    const auto report = woodenhaptics::parse_report(std::span(bytes).first(size), generation_);
    if (report && --wanted == 0) return *report;
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
    send(std::span(order->bytes).first(order->size));
  }
  const Report report = first_report(product, stop);
  if (options_.calibrate || options_.preset) std::copy_n(report.encoder.begin(), 3, home_count_.begin());
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
  const double least_step_m = steps_in_the_middle(mechanism_).colwise().norm().minCoeff();
  // Nearer to the column a count is half as long.
  link_ = std::make_unique<WoodenHapticsLink>(
      device_, thread_, *guard_, generation_,
      WoodenHapticsLink::Plausible{.count_rate = 2.0 * speed_limit_m_s / least_step_m,
                                   .count_step = static_cast<int>(2.5 * workspace_m / least_step_m)});
  link_->begin(report);
  take();
  const Vector& middle = mechanism_.configuration().centre_m;
  const double distance_m = (tip_ - middle).norm();
  // It may stand at home, where that is outside of the workspace.
  if (!reachable_ || distance_m > 2.0 * workspace_m + (mechanism_.home() - middle).norm()) {
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
           .report_jitter_s = max_report_jitter_s,
           .configuration = configuration(),
           .serial = device_.serial(),
           .port = device_.port()};
  if (generation_ != Generation::v1) {
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

/// Takes the newest reading, if there is one.
void WoodenHaptics::take() noexcept {
  if (!link_->take(last_)) return;
  count_ = last_.count;
  for (std::size_t at = 0; at < count_.size(); ++at) count_[at] -= home_count_[at];
  const Vector tip = mechanism_.tip(mechanism_.angles(count_));
  reachable_ = tip.allFinite();
  if (reachable_) tip_ = tip;
}

Status WoodenHaptics::read(double, Sample& sample) noexcept {
  take();
  (void)link_->take_sent(last_sent_);
  const bool gimbal = generation_ != Generation::v1;
  const std::int64_t age_ns = usb::now_ns() - last_.at_ns;
  for (std::size_t at = 0; at < 3; ++at) {
    sample.position[at] = tip_[static_cast<Eigen::Index>(at)];
    sample.channels[at] = 1e-3 * last_sent_[at];
    if (gimbal) sample.channels[5 + at] = last_.gimbal[at];
  }
  velocity_.update(sample.position, last_.at_ns, info_);
  for (std::size_t at = 0; at < 3; ++at) sample.velocity[at] = velocity_.velocity(at);
  sample.age_s = 1e-9 * static_cast<double>(age_ns);
  sample.channels[3] = sample.age_s;
  if (gimbal) sample.channels[4] = last_.button ? 1.0 : 0.0;
  if (link_->lost() || age_ns > max_silence_ns) return Status::lost;
  return reachable_ && age_ns <= max_reading_age_ns ? Status::ok : Status::fault;
}

Status WoodenHaptics::write(const Axes& force) noexcept {
  const bool finite = std::ranges::all_of(force, [](double one) { return std::isfinite(one); });
  WoodenHapticsLink::Currents current_ma{};
  if (finite) {
    Vector cut;
    for (std::size_t at = 0; at < 3; ++at) {
      const double limit = mechanism_.configuration().max_force_n;
      cut[static_cast<Eigen::Index>(at)] = std::clamp(force[at], -limit, limit);
    }
    const auto currents = mechanism_.currents(cut, mechanism_.angles(count_));
    for (std::size_t at = 0; at < 3; ++at) {
      current_ma[at] = static_cast<int>(std::lround(1e3 * currents.ampere[at]));
    }
    if (currents.limited) limited_.fetch_add(1, std::memory_order_relaxed);
  }
  link_->command(current_ma);
  if (link_->lost()) return Status::lost;
  return finite && !link_->refuses() && guard_->lives() ? Status::ok : Status::fault;
}

void WoodenHaptics::release(double) noexcept { link_->release(); }

std::vector<Figure> WoodenHaptics::figures() const {
  const double seconds = 1e-9 * static_cast<double>(usb::now_ns() - opened_ns_);
  const auto& counts = link_->counts();
  const auto count = [](const std::atomic<std::uint64_t>& one) { return static_cast<double>(one.load()); };
  std::vector<Figure> all{{"report_rate", seconds > 0.0 ? count(counts.reports) / seconds : 0.0, "Hz"},
                          {"reports", count(counts.reports), "1"},
                          {"malformed", count(counts.malformed), "1"},
                          {"implausible", count(counts.implausible), "1"},
                          {"orders_refused", count(counts.refused), "1"},
                          {"current_limited", count(limited_), "1"}};
  if (generation_ == Generation::v1) {
    all.push_back({"counter_gaps", count(counts.gaps), "1"});
    all.push_back({"stale_reports", count(counts.stale), "1"});
  } else {
    all.push_back({"resent", count(counts.resent), "1"});
  }
  return all;
}

}  // namespace kerf::drivers
