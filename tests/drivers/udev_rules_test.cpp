#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/protocols/labjack_u6_commands.h>
#include <kerf/drivers/usb/usb_device.h>

#include "support/program.h"

namespace kerf::drivers {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Vendor and product, in hexadecimal.
using Models = std::set<std::pair<std::string, std::string>>;

/// Those that the drivers look for: {0x1234, 0x0006 at the head of an initializer, and the LabJack.
Models models_in_sources() {
  const std::regex pair(R"(\{0x([0-9a-f]{4}), 0x([0-9a-f]{4})\b)");
  Models models{{fmt::format("{:04x}", labjack_u6::vendor), fmt::format("{:04x}", labjack_u6::product)}};
  for (const auto& entry : fs::recursive_directory_iterator(KERF_SOURCE_DIR "/drivers/src")) {
    if (!entry.is_regular_file()) continue;
    const std::string text = test::read_text(entry.path());
    for (std::sregex_iterator found(text.begin(), text.end(), pair), end; found != end; ++found)
      models.emplace(found->str(1), found->str(2));
  }
  return models;
}

Models models_in_rules() {
  const std::regex rule(R"re(ATTRS?\{idVendor\}=="(\w+)", ATTRS?\{idProduct\}=="([\w|]+)")re");
  const std::regex product(R"(\w+)");
  const std::string text = test::read_text(KERF_SOURCE_DIR "/drivers/udev/70-kerf.rules");
  Models models;
  for (std::sregex_iterator found(text.begin(), text.end(), rule), end; found != end; ++found) {
    const std::string products = found->str(2);
    for (std::sregex_iterator one(products.begin(), products.end(), product); one != end; ++one)
      models.emplace(found->str(1), one->str());
  }
  return models;
}

TEST(UdevRules, AreOfTheDevicesThatADriverKnowsAndNoOther) {
  EXPECT_EQ(models_in_rules(), models_in_sources());
  EXPECT_GE(models_in_sources().size(), 24U);
}

TEST(UdevRules, AreTheMendOfAMissingPermissionUntilTheyAreInstalled) {
  const test::TemporaryFolder folder;
  const std::vector<fs::path> folders{folder / "etc", folder / "usr"};
  EXPECT_THAT(usb::permission_mend(folders),
              HasSubstr("copy drivers/udev/70-kerf.rules to /etc/udev/rules.d"));
  fs::create_directory(folder / "usr");
  test::write_text(folder / "usr/70-kerf.rules", "");
  EXPECT_THAT(usb::permission_mend(folders),
              AllOf(HasSubstr("70-kerf.rules is installed"), HasSubstr("join the group plugdev"),
                    Not(HasSubstr("copy"))));
}

}  // namespace
}  // namespace kerf::drivers
