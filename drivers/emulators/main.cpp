#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <sched.h>
#include <sys/prctl.h>

#include <kerf/drivers/device.h>
#include <kerf/drivers/urgent_thread.h>
#include <kerf/drivers/uri.h>
#include <kerf/version.h>

#include "attach.h"
#include "faults.h"
#include "make_device.h"
#include "network/inverse3.h"
#include "network/labjack_t7.h"
#include "network/net_ft.h"
#include "network/own_port.h"
#include "serial/serial_device.h"
#include "serial/serial_sensor.h"
#include "session.h"

namespace {

using namespace kerf::emulators;

constexpr int bad_input = 2;
constexpr int device_error = 3;
std::atomic<bool> stop{false};

struct Arguments {
  std::string device;
  std::string faults;
  bool attach = false;
  std::uint16_t port = usbip::default_port;
  double seconds = 0.0;
  unsigned times = 1;
  double pause_s = 0.5;
};

/// As prompt as the permissions allow: an emulated device that answers late is a late device. Off the
/// processor of a loop that it may be tried with.
void be_prompt() {
  kerf::drivers::stay_off_loop_processor();
  constexpr sched_param parameters{.sched_priority = 82};  // above the threads that wait for it
  sched_setscheduler(0, SCHED_FIFO, &parameters);
  prctl(PR_SET_TIMERSLACK, 1UL);
}

Descriptor plug_in(const Arguments& arguments, const Descriptor& listening, const Description& description) {
  if (arguments.attach) return attach_here(description);
  while (!stop.load()) {
    Descriptor client = accept_import(listening, description, 200);
    if (client.number() >= 0) return client;
  }
  return Descriptor();
}

const char* in_words(Session::End end) {
  switch (end) {
    case Session::End::host_left:
      return "detached by the host";
    case Session::End::unplugged:
      return "unplugged, as asked for";
    case Session::End::time_over:
      return "its time is over";
    default:
      return "stopped";
  }
}

/// What is in the network has an address instead of a plug.
int run_in_network(const Arguments& arguments, kerf::drivers::Uri uri) {
  std::vector<Fault> faults = parse_faults(arguments.faults);
  check_faults_of_network(faults);
  if (uri.name == "t7") {
    EmulatedT7 t7(EmulatedT7::parse_options(std::move(uri)), std::move(faults));
    std::fprintf(stderr, "kerf-emulate: %s has its registers at port %u, its stream at port %u\n",
                 arguments.device.c_str(), t7.port(), t7.stream_port());
    t7.run(stop, arguments.seconds);
    std::fprintf(stderr, "kerf-emulate: %s: %s\n", arguments.device.c_str(), t7.tell().c_str());
    return 0;
  }
  if (uri.name == "inverse3") {
    EmulatedInverse3 service(EmulatedInverse3::parse_options(std::move(uri)), std::move(faults));
    std::fprintf(stderr, "kerf-emulate: %s serves at port %u\n", arguments.device.c_str(), service.port());
    service.run(stop, arguments.seconds);
    std::fprintf(stderr, "kerf-emulate: %s: %s\n", arguments.device.c_str(), service.tell().c_str());
    return 0;
  }
  EmulatedNetFt box(EmulatedNetFt::parse_options(std::move(uri)), std::move(faults));
  std::fprintf(
      stderr, "kerf-emulate: %s listens at UDP port %u%s\n", arguments.device.c_str(), box.port(),
      box.http_port() == 0 ? "" : fmt::format(" and serves its page at port {}", box.http_port()).c_str());
  box.run(stop, arguments.seconds);
  std::fprintf(stderr, "kerf-emulate: %s: %s\n", arguments.device.c_str(), box.tell().c_str());
  return 0;
}

/// What is on a serial line has a port; nothing for what is on none.
std::unique_ptr<EmulatedOnLine> make_on_line(const kerf::drivers::Uri& uri,
                                             const std::vector<Fault>& faults) {
  if (auto sensor = make_serial_sensor(uri, faults)) return sensor;
  return make_serial_device(uri, faults);
}

int run_on_a_line(const Arguments& arguments, EmulatedOnLine& device) {
  check_faults_of_line(parse_faults(arguments.faults));
  std::fprintf(stderr, "kerf-emulate: %s is at the port %s\n", arguments.device.c_str(),
               device.path().c_str());
  device.run(stop, arguments.seconds);
  std::fprintf(stderr, "kerf-emulate: %s: %s\n", arguments.device.c_str(), device.tell().c_str());
  return 0;
}

int run(const Arguments& arguments) {
  kerf::drivers::Uri uri = kerf::drivers::parse_uri(arguments.device);
  if (uri.name == "net-ft" || uri.name == "onrobot" || uri.name == "t7" || uri.name == "inverse3")
    return run_in_network(arguments, std::move(uri));
  std::vector<Fault> faults = parse_faults(arguments.faults);
  if (const auto device = make_on_line(uri, faults)) return run_on_a_line(arguments, *device);
  check_faults_of_usb(faults);
  const FaultPlan plan(std::move(faults));
  Descriptor listening;
  if (!arguments.attach) {
    listening =
        open_port(Transport::connections, "127.0.0.1", arguments.port, "; another --port may be free").socket;
    std::fprintf(stderr,
                 "kerf-emulate: %s waits on 127.0.0.1:%u; attach it with 'usbip attach -r 127.0.0.1 -b %s'\n",
                 arguments.device.c_str(), arguments.port, usbip::bus_id);
  }
  for (unsigned plugged = 0; !stop.load() && (arguments.times == 0 || plugged < arguments.times); ++plugged) {
    if (plugged > 0) {
      const auto pause = static_cast<std::int64_t>(1e9 * arguments.pause_s);
      const timespec wait{.tv_sec = pause / 1'000'000'000, .tv_nsec = pause % 1'000'000'000};
      nanosleep(&wait, nullptr);
    }
    const auto device = make_device(arguments.device);
    const Descriptor host = plug_in(arguments, listening, device->description());
    if (host.number() < 0) break;
    std::fprintf(stderr, "kerf-emulate: %s is plugged in\n", arguments.device.c_str());
    const auto end = Session(host.number(), *device, plan).run(stop, arguments.seconds);
    std::fprintf(stderr, "kerf-emulate: %s: %s; %s\n", arguments.device.c_str(), in_words(end),
                 device->tell().c_str());
  }
  return 0;
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): what escapes is out of memory
int main(int count, char** texts) {
  Arguments arguments;
  CLI::App app(
      "kerf-emulate plays a device on the USB of this machine or of another, over USB/IP: its descriptors, "
      "its wire\n"
      "protocol, and behind them a mechanism in a hand that the motor commands really move; or a force "
      "sensor "
      "in the\n"
      "network, on loopback, or a sensor or device on a serial line, on a pseudo-terminal.\n\n"
      "Devices: falcon, woody, u6, spacemouse; net-ft, onrobot, t7, inverse3; bota, optoforce, ft300,\n"
      "woody-v4, 2diy, hapkit, and the toys gauge, slider; options stand behind a question mark, as in\n"
      "docs/devices.md.\n"
      "Example, as root: modprobe vhci-hcd && kerf-emulate falcon --attach");
  app.add_option("device", arguments.device, "Device, with its options: 'woody?generation=v1'")->required();
  app.add_flag("--attach", arguments.attach, "Plug it into this machine's own kernel (root, vhci-hcd)");
  app.add_option("--port", arguments.port, "Else wait for 'usbip attach' on this port of loopback")
      ->capture_default_str();
  app.add_option(
      "--fault", arguments.faults,
      "What goes wrong, from so many seconds after it was plugged in: KIND@SECONDS[:COUNT],... with KIND "
      "drop, "
      "split, corrupt, stall or duplicate; flip@SECONDS[:COUNT[:SEED]], delay@SECONDS:TIME[:DURATION], "
      "refuse-out@SECONDS:DURATION, stick@SECONDS:DURATION, unplug@SECONDS; in the network and on a line "
      "also silence, overload, restart with a DURATION, and swap; docs/devices.md has each");
  app.add_option("--seconds", arguments.seconds, "Unplug it after so long; 0: never")
      ->check(CLI::Range(0.0, 1e9));
  app.add_option("--times", arguments.times, "Plug it in so many times; 0: for ever")->capture_default_str();
  app.add_option("--pause", arguments.pause_s, "Between unplugging and plugging in again [s]")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  app.set_version_flag("--version", fmt::format("kerf-emulate {} ({})", kerf::version(), kerf::commit()));
  try {
    app.parse(count, texts);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : bad_input;
  }
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stop = true; });
  try {
    be_prompt();
    return run(arguments);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "kerf-emulate: %s\n", error.what());
    return bad_input;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kerf-emulate: %s\n", error.what());
    return device_error;
  }
}
