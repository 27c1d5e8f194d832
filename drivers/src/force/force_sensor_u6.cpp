#include "kerf/drivers/force_sensor_u6.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <libusb.h>

#include "age_limits.h"
#include "kerf/drivers/device_notes.h"

namespace kerf::drivers {
namespace {

using labjack_u6::Error;
using usb::Transfer;

constexpr double scan_rate_hz = 1000.0;
constexpr double scan_period_s = 1.0 / scan_rate_hz;
constexpr std::size_t channel_count = 6;
constexpr std::size_t transfer_count =
    8;  // as many milliseconds that the thread may be late without a pause on the bus
constexpr std::size_t fifo_packets = 984 / channel_count;  // what an earlier program may have left in it
constexpr std::int64_t wait_ns = 20'000'000;
constexpr std::int64_t silent_ns = 230'000'000;  // below the 256 packets after which their counter wraps
constexpr int drain_timeout_ms = 5;
constexpr std::size_t opening_readings = 100;  // by which the bias is looked at
constexpr std::chrono::milliseconds opening_wait{10};
constexpr int most_opening_waits = 50;
constexpr usb::Identity labjack{labjack_u6::vendor, labjack_u6::product, "LabJack U6"};

std::string advice(std::uint8_t error) {
  switch (error) {
    case static_cast<std::uint8_t>(Error::overlap):
      return "the scans are faster than its converter";
    default:
      return "unplug it and plug it in again";
  }
}

}  // namespace

std::vector<usb::Attached> find_labjack_u6() {
  return usb::find_usb(labjack_u6::vendor, labjack_u6::product);
}

ForceSensorU6::Options ForceSensorU6::parse_options(std::string_view text, Uri uri) {
  UriOptions given(std::move(uri));
  const auto file = given.file("calibration");
  const bool raw = given.flag("raw", false);
  given.refuse_others();
  if (raw && !file) return {.calibration_file = {}, .raw = true};
  if (!file || file->empty()) {
    throw DeviceError(
        fmt::format("device '{}': which force a voltage is it cannot know; name the transducer's "
                    "calibration, for example "
                    "u6:0?calibration=examples/u6.calibration.toml",
                    text));
  }
  return {.calibration_file = *file, .raw = raw};
}

ForceSensorU6::ForceSensorU6(std::string_view uri, std::size_t number, const Options& options)
    : uri_(uri),
      calibration_(options.calibration_file.empty() ? ForceCalibration{}
                                                    : read_force_calibration(options.calibration_file)),
      raw_(options.raw),
      usb_(labjack, number),
      assembler_(channel_count, channel_count),
      clock_(scan_period_s),
      force_(options.raw ? channel_count : 0) {
  drain();
  stop_stream();
  identify();
  if (calibration_.serial && *calibration_.serial != identification_.serial) {
    refuse(fmt::format(
        "{} is for the LabJack with serial number {}, and this one has {}; plug in that one, or name "
        "the calibration of this one's transducer",
        options.calibration_file, *calibration_.serial, identification_.serial));
  }
  read_constants();
  configure();
  info_ = {
      .uri = uri_,
      .model = fmt::format("LabJack U6{}", identification_.pro ? "-Pro" : ""),
      .about = std::string(about),
      .axes = sensor_axes(),
      .channels = {{.name = "force_age", .unit = "s"}, {.name = "force_scan", .unit = "1"}},
      .measures_force = true,
      .configuration = fmt::format(
          "labjack = {{ serial = {}, firmware = \"{}.{:02}\", hardware = \"{}.{:02}\" }}\n"
          "scan_rate = 1000.0 # Hz, by the device's clock\n"
          "# V = slope (code - centre) above, negative_slope (centre - code) below; from the device's "
          "memory\n"
          "input = {{ range = \"+-10 V, differential, AIN0/1 to AIN10/11\", slope = {}, negative_slope = {}, "
          "centre = {} }}\n{}",
          identification_.serial, identification_.firmware_major, identification_.firmware_minor,
          identification_.hardware_major, identification_.hardware_minor, volts_.slope, volts_.negative_slope,
          volts_.centre, options.calibration_file.empty() ? std::string() : to_toml(calibration_)),
      .mounts = calibration_.mounts};
  if (options.calibration_file.empty()) calibration_.tells.fill(false);
  for (std::size_t i = 0; raw_ && i < channel_count; ++i)
    info_.channels.push_back({.name = fmt::format("signal_{}", i + 1), .unit = "V"});
  for (std::size_t i = 0; i < transfer_count; ++i) {
    transfers_.push_back(
        std::make_unique<Transfer>(usb_, labjack_u6::stream_endpoint, labjack_u6::max_packet,
                                   [this, i](Transfer::End end, std::span<const std::uint8_t> bytes) {
                                     if (end == Transfer::End::gone) force_.lose();
                                     if (end == Transfer::End::stalled || end == Transfer::End::failed)
                                       broken_ = true;
                                     if (end != Transfer::End::completed || broken_) return;
                                     take_packet(bytes);
                                     if (!force_.lost() && !transfers_[i]->submit()) force_.lose();
                                   }));
  }
  start_stream();
  thread_.start([this](const std::stop_token& stop) { stream(stop); });
  if (!options.calibration_file.empty()) note_doubts(options.calibration_file);
}

void ForceSensorU6::note_doubts(const std::string& file) {
  const auto today = std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
  for (std::string& line : doubts_of(calibration_, file, today)) note_device(std::move(line));
  if (!calibration_.noise_v) return;
  for (int waited = 0; waited < most_opening_waits; ++waited) {
    if (opening_count_.load(std::memory_order_acquire) >= opening_readings) break;
    std::this_thread::sleep_for(opening_wait);
  }
  if (opening_count_.load(std::memory_order_acquire) < opening_readings) return;
  Axes mean = opening_sum_;
  for (double& one : mean) one /= static_cast<double>(opening_readings);
  if (auto line = moved_bias(calibration_, file, mean, static_cast<double>(opening_readings)))
    note_device(std::move(*line));
}

ForceSensorU6::~ForceSensorU6() {
  thread_.stop();
  broken_ = true;  // transfers that end now are not submitted again
  transfers_.clear();
  if (force_.lost()) return;
  try {
    stop_stream();
  } catch (const DeviceError&) {
    // It was unplugged this moment; the next program stops the stream before it begins its own.
  }
}

void ForceSensorU6::refuse(const std::string& why) const {
  throw DeviceError(fmt::format("{}: {}", uri_, why));
}

std::size_t ForceSensorU6::ask(const labjack_u6::Message& question, std::span<std::uint8_t> answer) {
  usb_.send(labjack_u6::command_endpoint, question.view());
  return usb_.receive(labjack_u6::answer_endpoint, answer);
}

void ForceSensorU6::drain() noexcept {
  try {
    std::array<std::uint8_t, labjack_u6::max_packet> left{};
    while (usb_.receive(labjack_u6::answer_endpoint, left, drain_timeout_ms) > 0) {
    }
  } catch (const DeviceError&) {
    // What comes next says it better.
  }
}

void ForceSensorU6::stop_stream() {
  std::array<std::uint8_t, labjack_u6::max_packet> answer{};
  const std::size_t size = ask(labjack_u6::stream_stop(), answer);
  const auto error = labjack_u6::parse_stream_stop(std::span(answer).first(size));
  if (!error) refuse("it does not answer; unplug it and plug it in again");
  if (*error != 0 && *error != labjack_u6::not_streaming) {
    refuse(fmt::format("its stream does not stop (error {}); {}", *error, advice(*error)));
  }
  // Packets that left before the stop would be taken for the next stream's.
  for (std::size_t packet = 0; packet < fifo_packets + transfer_count; ++packet) {
    if (usb_.receive(labjack_u6::stream_endpoint, answer, drain_timeout_ms) == 0) break;
  }
}

void ForceSensorU6::identify() {
  std::array<std::uint8_t, labjack_u6::max_packet> answer{};
  const std::size_t size = ask(labjack_u6::identify(), answer);
  const auto found = labjack_u6::parse_identification(std::span(answer).first(size));
  if (!found) refuse("it does not say that it is a U6; unplug it and plug it in again");
  identification_ = *found;
}

void ForceSensorU6::read_constants() {
  const auto block = [&](std::uint8_t number) {
    std::array<std::uint8_t, labjack_u6::max_packet> answer{};
    const std::size_t size = ask(labjack_u6::read_constants(number), answer);
    const auto constants = labjack_u6::parse_constants(std::span(answer).first(size));
    if (!constants)
      refuse(fmt::format("block {} of its calibration cannot be read; plug it in again", number));
    return *constants;
  };
  const auto volts = labjack_u6::ten_volt_calibration(block(0), block(2));
  if (!volts) {
    refuse("its calibration memory holds no constants of a U6; its maker's LJControlPanel can restore them");
  }
  volts_ = *volts;
}

void ForceSensorU6::configure() {
  std::array<std::uint8_t, labjack_u6::max_packet> answer{};
  std::size_t size = ask(labjack_u6::no_timers(), answer);
  if (!labjack_u6::is_no_timers(std::span(answer).first(size))) {
    refuse("its timers and counters do not turn off; unplug it and plug it in again");
  }
  std::array<labjack_u6::Channel, channel_count> channels;
  for (std::size_t i = 0; i < channel_count; ++i) {
    channels[i] = {.number = static_cast<std::uint8_t>(2 * i), .differential = true};
  }
  const auto config = labjack_u6::stream_config(channels, scan_rate_hz);
  size = ask(*config, answer);
  const auto error = labjack_u6::parse_stream_config(std::span(answer).first(size));
  if (!error) refuse("it does not take the stream's configuration; unplug it and plug it in again");
  if (*error != 0) refuse(fmt::format("it refuses the stream (error {}); {}", *error, advice(*error)));
}

void ForceSensorU6::start_stream() {
  std::array<std::uint8_t, labjack_u6::max_packet> answer{};
  const std::size_t size = ask(labjack_u6::stream_start(), answer);
  const auto error = labjack_u6::parse_stream_start(std::span(answer).first(size));
  if (!error) refuse("its stream does not start; unplug it and plug it in again");
  if (*error != 0) refuse(fmt::format("its stream does not start (error {}); {}", *error, advice(*error)));
}

void ForceSensorU6::stream(const std::stop_token& stop) noexcept {
  last_packet_ns_ = usb::now_ns();
  std::int64_t last_scan_ns = last_packet_ns_;
  std::uint64_t last_scans = 0;
  for (const auto& transfer : transfers_) {
    if (!transfer->submit()) force_.lose();
  }
  while (!stop.stop_requested() && !force_.lost()) {
    usb_.handle_events(wait_ns, thread_.wake_descriptor());
    const std::int64_t now = usb::now_ns();
    if (scans_.load(std::memory_order_relaxed) != last_scans) {
      last_scans = scans_.load(std::memory_order_relaxed);
      last_scan_ns = now;
    }
    if (now - last_scan_ns > max_silence_ns) force_.lose();
    const bool silent = now - last_packet_ns_ > silent_ns;
    if (!force_.lost() && (broken_ || silent) && !restart()) force_.lose();
  }
  // Not again and again: the kernel needs the processor to take the device away.
}

void ForceSensorU6::take_packet(std::span<const std::uint8_t> bytes) noexcept {
  const std::int64_t arrived_ns = usb::now_ns();
  last_packet_ns_ = arrived_ns;
  const auto packet = labjack_u6::parse_stream(bytes);
  if (!packet || packet->samples != channel_count) {
    checksum_errors_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  const bool recovering = packet->error == static_cast<std::uint8_t>(Error::recovering) ||
                          packet->error == static_cast<std::uint8_t>(Error::recovered);
  if (recovering && !was_recovering_) overflows_.fetch_add(1, std::memory_order_relaxed);
  was_recovering_ = packet->error == static_cast<std::uint8_t>(Error::recovering);
  assembler_.take(*packet, [&](std::uint64_t scan, std::span<const std::uint16_t> codes) {
    take_scan(first_number_ + scan, codes, arrived_ns);
  });
  scans_lost_.store(lost_before_ + assembler_.lost(), std::memory_order_relaxed);
  broken_ = broken_ || assembler_.broken();
}

void ForceSensorU6::take_scan(std::uint64_t number, std::span<const std::uint16_t> codes,
                              std::int64_t arrived_ns) noexcept {
  clock_.add(number, arrived_ns);
  Axes volts{};
  for (std::size_t i = 0; i < channel_count; ++i) volts[i] = volts_.volts(codes[i]);
  StreamedForce::Reading reading{
      .wrench = calibration_.wrench(volts), .number = number, .taken_ns = clock_.time_ns(number)};
  std::ranges::copy(volts, reading.extras.begin());
  force_.put(reading);
  if (const std::size_t count = opening_count_.load(std::memory_order_relaxed); count < opening_readings) {
    for (std::size_t i = 0; i < channel_count; ++i) opening_sum_[i] += volts[i];
    opening_count_.store(count + 1, std::memory_order_release);
  }
  next_number_ = number + 1;
  if (first_ns_.load(std::memory_order_relaxed) == 0) first_ns_.store(arrived_ns, std::memory_order_relaxed);
  last_ns_.store(arrived_ns, std::memory_order_relaxed);
  scans_.fetch_add(1, std::memory_order_relaxed);
  drift_ppm_.store(clock_.drift_ppm(), std::memory_order_relaxed);
  drift_error_ppm_.store(clock_.drift_error_ppm(), std::memory_order_relaxed);
}

bool ForceSensorU6::restart() noexcept {
  restarts_.fetch_add(1, std::memory_order_relaxed);
  broken_ = true;  // transfers that end now are not submitted again
  for (const auto& transfer : transfers_) transfer->cancel();
  const auto pending = [&] {
    return std::ranges::any_of(transfers_, [](const auto& transfer) { return transfer->pending(); });
  };
  for (int waited = 0; pending() && waited < 50; ++waited) usb_.handle_events(wait_ns);
  if (pending() || force_.lost()) return false;
  try {
    // A stall lasts until the host clears it.
    for (const std::uint8_t endpoint :
         {labjack_u6::command_endpoint, labjack_u6::answer_endpoint, labjack_u6::stream_endpoint}) {
      if (libusb_clear_halt(usb_.handle(), endpoint) == LIBUSB_ERROR_NO_DEVICE) return false;
    }
    drain();
    stop_stream();
    start_stream();
  } catch (const std::exception&) {
    return false;
  }
  // The scans go on counting as if the stream had never stopped; its first one comes a period after its
  // start.
  const std::int64_t now = usb::now_ns();
  if (next_number_ > 0) {
    const double missed = 1e-9 * static_cast<double>(now - clock_.time_ns(next_number_ - 1)) * scan_rate_hz;
    first_number_ = next_number_ + static_cast<std::uint64_t>(std::max(0.0, std::round(missed)));
    lost_before_ = first_number_ - scans_.load(std::memory_order_relaxed);
    scans_lost_.store(lost_before_, std::memory_order_relaxed);
  }
  assembler_ = labjack_u6::ScanAssembler(channel_count, channel_count);
  clock_.restart();
  broken_ = was_recovering_ = false;
  last_packet_ns_ = now;
  return std::ranges::all_of(transfers_, [](const auto& transfer) { return transfer->submit(); });
}

std::vector<Figure> ForceSensorU6::figures() const {
  const auto scans = static_cast<double>(scans_.load());
  const double seconds = 1e-9 * static_cast<double>(last_ns_.load() - first_ns_.load());
  std::vector<Figure> all{{"scan_rate", seconds > 0.0 ? (scans - 1.0) / seconds : 0.0, "Hz"},
                          {"scans", scans, "1"},
                          {"scans_lost", static_cast<double>(scans_lost_.load()), "1"},
                          {"checksum_errors", static_cast<double>(checksum_errors_.load()), "1"},
                          {"overflows", static_cast<double>(overflows_.load()), "1"},
                          {"restarts", static_cast<double>(restarts_.load()), "1"}};
  if (std::isfinite(drift_error_ppm_.load())) {
    all.push_back({"clock_drift", drift_ppm_.load(), "ppm"});
    all.push_back({"clock_drift_error", drift_error_ppm_.load(), "ppm"});
  }
  return all;
}

}  // namespace kerf::drivers
