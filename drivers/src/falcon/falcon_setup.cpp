#include "falcon/falcon_setup.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "interruption.h"
#include "kerf/drivers/device.h"
#include "kerf/drivers/protocols/c2000_image.h"
#include "kerf/drivers/protocols/falcon.h"
#include "kerf/drivers/usb/io_thread.h"
#include "small_file.h"

namespace kerf::drivers {
namespace {

using usb::now_ns;

constexpr std::int64_t millisecond = 1'000'000;
constexpr std::int64_t silence_ns = 150 * millisecond;  // a loaded one answers within 2
constexpr std::int64_t ask_again_ns = 20 * millisecond;
constexpr std::int64_t boot_ns = 1000 * millisecond;
constexpr std::int64_t hello_ns = 30 * millisecond;  // 7 on the line, 16 of latency
constexpr std::int64_t echo_ns = 1000 * millisecond;
constexpr int max_hellos = 60;
constexpr int max_loads = 10;  // as libnifalcon: a byte that is lost once is no reason to give up
constexpr int read_timeout_ms = 100;
constexpr std::size_t block_size = 62;  // the data of one packet
constexpr std::size_t max_image = 1U << 20U;

constexpr std::array<std::uint8_t, 3> hello{0x0A, 0x43, 0x0D};
constexpr std::array<std::uint8_t, 4> answer{0x0A, 0x44, 0x2C, 0x0D};
constexpr std::uint8_t autobaud = 0x41;

/// Vendor requests of the bridge and their values.
namespace bridge {
constexpr std::uint8_t reset = 0x00;
constexpr std::uint8_t modem_control = 0x01;
constexpr std::uint8_t flow_control = 0x02;
constexpr std::uint8_t baud_rate = 0x03;
constexpr std::uint8_t data_format = 0x04;
constexpr std::uint8_t latency_timer = 0x09;

constexpr std::uint16_t rts_low = 0x0200;
constexpr std::uint16_t dtr_low = 0x0100;
constexpr std::uint16_t dtr_high = 0x0101;
constexpr std::uint16_t baud_9600 = 0x4138;    // 3 MHz / 312.5
constexpr std::uint16_t baud_142857 = 0x0015;  // 3 MHz / 21
constexpr std::uint16_t baud_1500000 = 0x0002;
constexpr std::uint16_t eight_n_one = 0x0008;
}  // namespace bridge

[[noreturn]] void fail(std::string_view problem) {
  throw DeviceError(fmt::format("{}: {}", falcon_identity.what, problem));
}

void purge(usb::UsbDevice& device) {
  // Which of the two is which direction is disputed; so both.
  device.control_out(bridge::reset, 1);
  device.control_out(bridge::reset, 2);
}

void enter_run_mode(usb::UsbDevice& device) {
  device.control_out(bridge::latency_timer, 1);
  device.control_out(bridge::baud_rate, bridge::baud_1500000);
  device.control_out(bridge::data_format, bridge::eight_n_one);
  purge(device);
}

/// Reads for so long and calls `take(byte)` for each byte of data until it returns true. @returns whether it
/// did.
template <typename F>
bool read_until(usb::UsbDevice& device, std::int64_t max_ns, const FalconSetup& setup, F take) {
  std::array<std::uint8_t, 64> buffer{};
  const std::int64_t until_ns = now_ns() + max_ns;
  while (now_ns() < until_ns) {
    refuse_if_stopped(falcon_identity.what, setup.stop);
    const std::size_t size = device.receive(falcon_in, buffer, read_timeout_ms);
    bool done = false;
    falcon::for_each_data_byte(std::span(buffer).first(size),
                               [&](std::uint8_t byte) { done = done || take(byte); });
    if (done) return true;
  }
  return false;
}

/// Whether it answers a run-time frame within so long.
bool runs(usb::UsbDevice& device, std::int64_t max_ns, const FalconSetup& setup) {
  const auto frame = falcon::encode(falcon::Command{.homing = setup.homing});
  falcon::FrameReader reader;
  const std::int64_t until_ns = now_ns() + max_ns;
  while (now_ns() < until_ns) {
    device.send(falcon_out, frame);
    if (read_until(device, ask_again_ns, setup,
                   [&](std::uint8_t byte) { return reader.take(byte).has_value(); })) {
      return true;
    }
  }
  return false;
}

std::vector<std::uint8_t> read_image(const std::string& path) {
  const SmallFile file = read_small_file(path, max_image);
  if (!file.problem.empty())
    throw std::invalid_argument(
        fmt::format("firmware={} cannot be read ({}); give the path of the image that came with your Falcon",
                    path, file.problem));
  const std::vector<std::uint8_t> image(file.content.begin(), file.content.end());
  const auto problem = c2000::problem_of(image);
  if (!problem.empty()) {
    fail(fmt::format(
        "firmware={} is no firmware image of a Falcon ({}); give the file that came with your Falcon", path,
        problem));
  }
  return image;
}

void greet(usb::UsbDevice& device, const FalconSetup& setup) {
  purge(device);
  device.control_out(bridge::latency_timer, 16);
  device.control_out(bridge::baud_rate, bridge::baud_9600);
  device.control_out(bridge::data_format, bridge::eight_n_one);
  device.control_out(bridge::flow_control, 0);
  device.control_out(bridge::modem_control, bridge::rts_low);
  device.control_out(bridge::modem_control, bridge::dtr_low);
  device.control_out(bridge::modem_control, bridge::dtr_high);
  std::array<std::uint8_t, answer.size()> last{};  // a glitch may come before it
  for (int tries = 0; tries < max_hellos; ++tries) {
    device.send(falcon_out, hello);
    const bool answered = read_until(device, hello_ns, setup, [&](std::uint8_t byte) {
      std::rotate(last.begin(), last.begin() + 1, last.end());
      last.back() = byte;
      return last == answer;
    });
    if (answered) return;
  }
  fail(
      "it does not answer at 9600 baud, so that its firmware cannot be loaded; check its power supply, "
      "unplug it and "
      "plug it in again");
}

/// Sends bytes and reads them back. @returns what went wrong; empty: nothing.
std::string send_echoed(usb::UsbDevice& device, std::span<const std::uint8_t> bytes, std::size_t before,
                        const FalconSetup& setup) {
  device.send(falcon_out, bytes);
  std::size_t back = 0;
  bool equal = true;
  const bool whole = read_until(device, echo_ns, setup, [&](std::uint8_t byte) {
    equal = equal && byte == bytes[back];
    if (equal) ++back;
    return !equal || back == bytes.size();
  });
  if (whole && equal) return "";
  return fmt::format(
      "it sent byte {} of its firmware back {}; unplug it, plug it in again, and use another cable or port",
      before + back, equal ? "not at all" : "wrong");
}

/// @returns what went wrong; empty: nothing.
std::string load(usb::UsbDevice& device, std::span<const std::uint8_t> image, const FalconSetup& setup) {
  device.control_out(bridge::modem_control, bridge::dtr_low);
  device.control_out(bridge::baud_rate, bridge::baud_142857);
  const bool measured = [&] {
    device.send(falcon_out, std::array{autobaud});
    return read_until(device, echo_ns, setup, [](std::uint8_t byte) { return byte == autobaud; });
  }();
  if (!measured)
    return "it does not take up the speed at which its firmware is loaded; unplug it and plug it in again";
  for (std::size_t at = 0; at < image.size(); at += block_size) {
    auto problem = send_echoed(device, image.subspan(at, std::min(block_size, image.size() - at)), at, setup);
    if (!problem.empty()) return problem;
  }
  enter_run_mode(device);
  if (runs(device, boot_ns, setup)) return "";
  return fmt::format("it took firmware={} and answers nothing; is it the firmware of a Falcon?",
                     setup.firmware);
}

}  // namespace

void set_up_falcon(usb::UsbDevice& device, const FalconSetup& setup) {
  // A file that is none is told at once, also where none is needed this time.
  const auto image = setup.firmware.empty() ? std::vector<std::uint8_t>() : read_image(setup.firmware);
  purge(device);
  enter_run_mode(device);
  if (runs(device, silence_ns, setup)) return;
  if (image.empty()) {
    fail(
        fmt::format("this Falcon has no firmware loaded; give the image that came with your Falcon: "
                    "{}?firmware=FILE; Kerf ships none",
                    setup.uri.substr(0, setup.uri.find('?'))));
  }
  for (int tries = 1;; ++tries) {
    greet(device, setup);
    const std::string problem = load(device, image, setup);
    if (problem.empty()) return;
    if (tries == max_loads) fail(fmt::format("{} (tried {} times)", problem, tries));
  }
}

}  // namespace kerf::drivers
