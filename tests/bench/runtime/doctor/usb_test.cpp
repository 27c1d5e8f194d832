#include "doctor/facts/usb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/runtime/doctor/fake_tree.h"

namespace kerf::bench::doctor {
namespace {

using testing::HasSubstr;

const std::string root_hub = "/sys/devices/pci0000:00/0000:00:14.0/usb1";
const std::string hub = root_hub + "/1-2";
const std::string falcon = hub + "/1-2.3";

/// A Falcon behind a hub, with a disk beside it.
void plug_in(test::FakeTree& fake) {
  fake.file(root_hub + "/busnum", "1").file(root_hub + "/devnum", "1").file(root_hub + "/bDeviceClass", "09");
  fake.file(hub + "/busnum", "1").file(hub + "/devnum", "2").file(hub + "/bDeviceClass", "09");
  fake.file(hub + "/product", "USB2.0 Hub");
  fake.file(falcon + "/busnum", "1").file(falcon + "/devnum", "14").file(falcon + "/bDeviceClass", "00");
  fake.file(falcon + "/speed", "12");
  fake.file(hub + "/1-2.4/busnum", "1")
      .file(hub + "/1-2.4/bDeviceClass", "00")
      .file(hub + "/1-2.4/product", "Disk");
  for (const std::string& device : {root_hub, hub, falcon})
    fake.link("/sys/bus/usb/devices/" + device.substr(device.rfind('/') + 1), device);
}

TEST(DoctorUsb, TheWayToADeviceIsEveryHubAboveIt) {
  test::FakeTree fake;
  plug_in(fake);
  fake.file(falcon + "/1-2.3:1.0/0003:1234:0006.0001/uevent", "");
  fake.link("/sys/class/hidraw/hidraw0/device", falcon + "/1-2.3:1.0/0003:1234:0006.0001");
  EXPECT_THAT(usb_path(fake.tree(), "/dev/bus/usb/001/014"), testing::ElementsAre(falcon, hub, root_hub));
  EXPECT_THAT(usb_path(fake.tree(), "/dev/hidraw0"), testing::ElementsAre(falcon, hub, root_hub));
  EXPECT_THAT(usb_path(fake.tree(), "/dev/bus/usb/001/015"), testing::IsEmpty());
}

TEST(DoctorUsb, ADeviceThatMayBePutToSleepCosts) {
  test::FakeTree fake;
  plug_in(fake);
  const auto path = usb_path(fake.tree(), "/dev/bus/usb/001/014");
  EXPECT_EQ(usb_autosuspend(fake.tree(), path, "falcon:0").state, State::unknown) << "nothing tells";
  fake.file(falcon + "/power/control", "auto").file(falcon + "/power/autosuspend_delay_ms", "2000");
  fake.file(hub + "/power/control", "auto");
  const Finding finding = usb_autosuspend(fake.tree(), path, "falcon:0");
  EXPECT_EQ(finding.state, State::costs);
  EXPECT_THAT(finding.seen, testing::AllOf(HasSubstr("falcon:0"), HasSubstr("2000 ms"), HasSubstr("1-2")));
  EXPECT_EQ(finding.mend, "echo on | sudo tee " + falcon + "/power/control");
  EXPECT_FALSE(finding.cost.us);
}

TEST(DoctorUsb, ADeviceThatIsKeptAwakeIsGood) {
  test::FakeTree fake;
  plug_in(fake);
  const auto path = usb_path(fake.tree(), "/dev/bus/usb/001/014");
  fake.file(falcon + "/power/control", "on").file(falcon + "/power/autosuspend_delay_ms", "2000");
  EXPECT_EQ(usb_autosuspend(fake.tree(), path, "falcon:0").state, State::good);
  fake.file(falcon + "/power/control", "auto").file(falcon + "/power/autosuspend_delay_ms", "-1000");
  EXPECT_EQ(usb_autosuspend(fake.tree(), path, "falcon:0").state, State::good) << "a negative delay is never";
  EXPECT_EQ(usb_autosuspend(fake.tree(), {}, "falcon:0").state, State::unknown);
}

TEST(DoctorUsb, AHubBetweenAndItsOtherDevicesAreNamed) {
  test::FakeTree fake;
  plug_in(fake);
  const auto path = usb_path(fake.tree(), "/dev/bus/usb/001/014");
  const Finding finding = usb_shared_hub(fake.tree(), path, "falcon:0");
  EXPECT_EQ(finding.state, State::costs);
  EXPECT_THAT(finding.seen, testing::AllOf(HasSubstr("USB2.0 Hub"), HasSubstr("1-2.4 (Disk)")));
  EXPECT_EQ(usb_shared_hub(fake.tree(), {hub, root_hub}, "x:0").state, State::good)
      << "alone at the machine's bus";
  EXPECT_EQ(usb_shared_hub(fake.tree(), {}, "x:0").state, State::unknown);
}

TEST(DoctorUsb, ABusOfFramesCostsUpToOne) {
  test::FakeTree fake;
  plug_in(fake);
  const auto path = usb_path(fake.tree(), "/dev/bus/usb/001/014");
  EXPECT_EQ(usb_speed(fake.tree(), path, "falcon:0").state, State::costs);
  EXPECT_THAT(usb_speed(fake.tree(), path, "falcon:0").cost.why, HasSubstr("1000 us"));
  fake.file(falcon + "/speed", "480");
  EXPECT_EQ(usb_speed(fake.tree(), path, "falcon:0").state, State::good);
}

constexpr const char* modem_manager_runs = "/proc/411/comm";

void plug_in_serial(test::FakeTree& fake) {
  plug_in(fake);
  fake.file("/proc/1/comm", "systemd");
  fake.file(falcon + "/idVendor", "0403").file(falcon + "/dev", "189:13");
  fake.file(falcon + "/1-2.3:1.0/tty/ttyACM0/dev", "166:0");
  fake.link("/sys/class/tty/ttyACM0", falcon + "/1-2.3:1.0/tty/ttyACM0");
}

TEST(DoctorUsb, ModemManagerWithoutTheIgnorePropertyIsNamed) {
  test::FakeTree fake;
  plug_in_serial(fake);
  EXPECT_EQ(modem_manager(fake.tree()).state, State::good) << "it does not run";
  fake.file(modem_manager_runs, "ModemManager");
  EXPECT_EQ(modem_manager(fake.tree()).state, State::unknown) << "udev tells nothing";
  fake.file("/run/udev/data/c166:0", "S:serial/by-id/x\nE:ID_BUS=usb");
  const Finding finding = modem_manager(fake.tree());
  EXPECT_EQ(finding.state, State::costs);
  EXPECT_THAT(finding.seen, testing::AllOf(HasSubstr("ttyACM0"), HasSubstr("ID_MM_DEVICE_IGNORE")));
  EXPECT_THAT(finding.mend, testing::AllOf(HasSubstr("ATTRS{idVendor}==\"0403\""),
                                           HasSubstr("ENV{ID_MM_DEVICE_IGNORE}=\"1\"")));
}

TEST(DoctorUsb, ModemManagerThatIsToldToIgnoreItIsGood) {
  test::FakeTree fake;
  plug_in_serial(fake);
  fake.file(modem_manager_runs, "ModemManager");
  fake.file("/run/udev/data/c166:0", "E:ID_BUS=usb");
  fake.file("/run/udev/data/c189:13", "E:ID_MM_DEVICE_IGNORE=1");  // of the device that the port belongs to
  EXPECT_EQ(modem_manager(fake.tree()).state, State::good);
  EXPECT_EQ(modem_manager(test::FakeTree().tree()).state, State::unknown);
}

}  // namespace
}  // namespace kerf::bench::doctor
