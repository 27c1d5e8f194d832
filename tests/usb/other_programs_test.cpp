#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/device.h>

#include "emulator.h"

namespace kerf::test {
namespace {

/// What a program says, on both of its outputs.
std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return text;
  char buffer[4096];
  while (fgets(buffer, sizeof buffer, pipe) != nullptr) text += buffer;
  pclose(pipe);
  return text;
}

TEST(OtherPrograms, UsbipListsAttachesAndDetachesWhatIsEmulated) {
  if (std::system("command -v usbip >/dev/null") != 0) GTEST_SKIP() << "usbip is not installed";
  const Emulator emulator("spacemouse", {"--port", "3240"}, Emulator::Plugged::by_hand);
  std::string list;
  for (int tries = 0; tries < 100 && list.find("046d:c626") == std::string::npos; ++tries) {
    list = output_of("usbip list --remote 127.0.0.1");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_THAT(list, testing::HasSubstr("(046d:c626)"));
  EXPECT_EQ(output_of("usbip attach --remote 127.0.0.1 --busid 1-1"), "");
  ASSERT_TRUE(becomes_attached("spacemouse:0"));
  const auto attached = drivers::list_attached();
  ASSERT_EQ(attached.size(), 1U);
  EXPECT_TRUE(attached[0].emulated);
  EXPECT_EQ(attached[0].problem, "");
  loop(*drivers::open_device("spacemouse:0"), 100,
       [](int, drivers::Status status, const drivers::Sample&) { EXPECT_EQ(status, drivers::Status::ok); });
  EXPECT_THAT(output_of("usbip port"), testing::HasSubstr("Port 00"));
  (void)output_of("usbip detach --port 0");
  EXPECT_TRUE(becomes_attached("spacemouse:", false));
}

// scripts/set-up unpacks it and does not install it: it would take a SpaceMouse from whoever uses one.
TEST(OtherPrograms, SpacenavdUsesTheSpaceNavigator) {
  if (std::system("command -v spacenavd >/dev/null") != 0)
    GTEST_SKIP() << "spacenavd is not installed, nor unpacked";
  const Emulator emulator("spacemouse");
  ASSERT_TRUE(becomes_attached("spacemouse:0"));
  const std::string said = output_of("stdbuf -oL timeout -s INT 3 spacenavd -d -v");
  EXPECT_THAT(said, testing::HasSubstr("using device: 3Dconnexion SpaceNavigator"));
  EXPECT_THAT(said, testing::HasSubstr("Number of axes: 6 (0a 6r)"));
}

}  // namespace
}  // namespace kerf::test
