#include "kerf/drivers/attached_ports.h"

#include <chrono>
#include <cstdint>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/as_nobody.h"
#include "support/program.h"
#include "support/running_box.h"

namespace kerf::drivers {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// A machine's /dev, /sys and /proc with serial ports on its USB.
class FakeMachine : public testing::Test {
 protected:
  [[nodiscard]] fs::path root() const { return folder_.path(); }
  [[nodiscard]] fs::path at(const std::string& path) const { return root() / path; }
  void file(const std::string& path, const std::string& text) const {
    fs::create_directories(at(path).parent_path());
    test::write_text(at(path), text);
  }
  void link(const std::string& path, const std::string& to) const {
    fs::create_directories(at(path).parent_path());
    fs::create_symlink(to, at(path));
  }
  void plug_in(const std::string& name, const std::string& tty, const std::string& vendor,
               const std::string& product) const {
    const std::string device = "sys/devices/pci0000:00/usb1/" + tty + "-1";
    file(device + "/idVendor", vendor + "\n");
    file(device + "/idProduct", product + "\n");
    fs::create_directories(at(device + "/1-1:1.0/tty/" + tty));
    link("sys/class/tty/" + tty, "../../../" + device + "/1-1:1.0/tty/" + tty);
    file("dev/" + tty, "");
    link("dev/serial/by-id/" + name, "../../" + tty);
  }
  /// To everybody, whatever mask this process has.
  void open_folders() const {
    const auto all =
        fs::perms::group_read | fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec;
    fs::permissions(root(), all, fs::perm_options::add);
    for (const auto& entry : fs::recursive_directory_iterator(root()))
      if (entry.is_directory() && !entry.is_symlink()) fs::permissions(entry, all, fs::perm_options::add);
  }
  void hold(const std::string& tty, const std::string& process, const std::string& program) const {
    file("proc/" + process + "/comm", program + "\n");
    link("proc/" + process + "/fd/5", "/dev/" + tty);
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(FakeMachine, TellsWhatMayHangOnEachPort) {
  plug_in("usb-Teensyduino_1234-if00", "ttyACM0", "16c0", "0483");
  plug_in("usb-FTDI_FT1-if00-port0", "ttyUSB0", "0403", "6001");
  plug_in("usb-Arduino_Due-if00", "ttyACM1", "2341", "003d");
  plug_in("usb-Somebody-if00", "ttyACM2", "1234", "5678");
  const auto ports = list_serial_ports(root());
  ASSERT_EQ(ports.size(), 4U);
  EXPECT_THAT(ports[0].uris, ElementsAre("2diy:/dev/serial/by-id/usb-Arduino_Due-if00"));
  EXPECT_THAT(ports[1].uris, ElementsAre("bota:/dev/serial/by-id/usb-FTDI_FT1-if00-port0",
                                         "ft300:/dev/serial/by-id/usb-FTDI_FT1-if00-port0"));
  EXPECT_THAT(ports[2].uris, ElementsAre());
  EXPECT_THAT(ports[2].about, HasSubstr("does not know"));
  EXPECT_THAT(ports[3].uris, ElementsAre("woody-v4:/dev/serial/by-id/usb-Teensyduino_1234-if00"));
  EXPECT_THAT(ports[3].about, HasSubstr("Inverse3"));
  EXPECT_EQ(ports[3].node, "/dev/ttyACM0");
  EXPECT_EQ(ports[3].vendor + ports[3].product, "16c00483");
  for (const AttachedPort& port : ports) EXPECT_EQ(port.problem, "") << port.path;
}

TEST_F(FakeMachine, HasNoPortsWhereThereAreNone) { EXPECT_TRUE(list_serial_ports(root()).empty()); }

TEST_F(FakeMachine, SaysWhichRightIsMissing) {
  plug_in("usb-Teensy", "ttyACM0", "16c0", "0483");
  open_folders();
  fs::permissions(at("dev/ttyACM0"), fs::perms::none);
  const test::AsNobody nobody;
  EXPECT_THAT(list_serial_ports(root()).at(0).problem,
              AllOf(HasSubstr("no permission for /dev/ttyACM0"),
                    HasSubstr("'sudo usermod -aG dialout $USER'"), HasSubstr("log in again")));
}

TEST_F(FakeMachine, SaysWhoHasAPortOpen) {
  plug_in("usb-Teensy", "ttyACM0", "16c0", "0483");
  hold("ttyACM0", "77", "screen");
  EXPECT_THAT(list_serial_ports(root()).at(0).problem,
              HasSubstr("screen has /dev/ttyACM0 open (process 77); close that program"));
  file("proc/77/comm", "ModemManager\n");
  EXPECT_THAT(list_serial_ports(root()).at(0).problem, HasSubstr("sudo systemctl stop ModemManager"));
}

TEST_F(FakeMachine, SaysThatAPortIsGone) {
  link("dev/serial/by-id/usb-Gone", "../../ttyACM9");
  EXPECT_THAT(list_serial_ports(root()).at(0).problem, HasSubstr("there is no port"));
}

std::string state_of(const std::string& uri, const fs::path& root = "/nowhere") {
  const AttachedDevice falcon{.uri = "falcon:0", .about = {}, .node = {}, .problem = {}};
  const AttachedDevice forbidden{
      .uri = "hid:1234:0006?index=1", .about = {}, .node = {}, .problem = "no permission"};
  const EntryState seen =
      look_at({.name = "a", .uri = uri, .sensor = {}}, {falcon, forbidden}, root, std::chrono::seconds(10));
  return seen.state + (seen.problem.empty() ? "" : ": " + seen.problem);
}

TEST_F(FakeMachine, SeesWhatOfABenchIsThere) {
  plug_in("usb-Teensy", "ttyACM0", "16c0", "0483");
  EXPECT_EQ(state_of("sim:axis"), "simulated");
  EXPECT_THAT(state_of("sim:axis?nonsense=1"),
              HasSubstr("cannot be opened: device 'sim:axis' has no option"));
  EXPECT_EQ(state_of("falcon:0?firmware=x"), "there");
  EXPECT_THAT(state_of("falcon:1"), HasSubstr("not there: it is not on the USB"));
  EXPECT_EQ(state_of("hid:1234:0006?index=1"), "cannot be opened: no permission");
  EXPECT_EQ(state_of("woody-v4:/dev/serial/by-id/usb-Teensy", root()), "there");
  EXPECT_THAT(state_of("woody-v4:/dev/ttyACM7", root()),
              HasSubstr("not there: there is no port /dev/ttyACM7"));
  hold("ttyACM0", "77", "screen");
  EXPECT_THAT(state_of("woody-v4:/dev/ttyACM0", root()), HasSubstr("cannot be opened: screen has"));
  EXPECT_THAT(state_of("plugin:/nowhere/mine.so"), HasSubstr("not there: there is no file"));
  // Asking would take the stream from whoever has it.
  EXPECT_EQ(state_of("onrobot:127.0.0.1"), "not asked");
}

std::uint16_t port_in(const std::string& uri) {
  return static_cast<std::uint16_t>(std::stoi(uri.substr(uri.find("port=") + 5)));
}

TEST(AttachedPorts, AsksABoxForItsPageAndAServiceForItsVersion) {
  std::string closed;
  {
    const test::RunningBox box("net-ft");
    const test::RunningT7 t7;
    const test::RunningInverse3 service("inverse3?version=3.5");
    EXPECT_EQ(state_of(box.uri()), "there");
    EXPECT_EQ(state_of(t7.uri()), "there");
    EXPECT_EQ(state_of(service.uri()), "there");
    closed = box.uri();
  }
  EXPECT_THAT(state_of(closed), HasSubstr("no answer: "));
  EXPECT_THAT(state_of("inverse3:127.0.0.1?port=1"), HasSubstr("no answer: nothing listens at port 1"));
  EXPECT_FALSE(find_inverse3("127.0.0.1", 1).has_value());
  const test::RunningInverse3 old_service("inverse3?version=3.2");
  EXPECT_THAT(find_inverse3("127.0.0.1", port_in(old_service.uri()), std::chrono::seconds(10)).value().about,
              HasSubstr("3.1 to 3.4 do not tell"));
}

}  // namespace
}  // namespace kerf::drivers
