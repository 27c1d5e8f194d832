#include "device_model/kept_models.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/device_models.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

drivers::DeviceModel falcon(const std::string& serial, const std::string& port, const std::string& date) {
  drivers::DeviceModel model = test::model_of("falcon:0", date);
  model.model = "Novint Falcon";
  model.serial = serial;
  model.port = port;
  return model;
}
drivers::DeviceInfo info_of(const drivers::DeviceModel& model) {
  drivers::DeviceInfo info{
      .uri = model.uri, .model = model.model, .simulated = model.uri.starts_with("sim:")};
  info.serial = model.serial;
  info.port = model.port;
  return info;
}

class ModelStore : public testing::Test {
 protected:
  [[nodiscard]] std::optional<ModelFile> found(const drivers::DeviceInfo& device) {
    return kept_.find(device, [this](std::string_view line) { warnings_.emplace_back(line); });
  }
  test::TemporaryFolder folder_;
  KeptModels kept_{folder_ / "devices"};
  std::vector<std::string> warnings_;
};

TEST_F(ModelStore, FindsWhatIsKeptOfADeviceAndOfNoOther) {
  const auto mine = falcon("0000001", "1-2", "2026-01-31T12:00:00Z");
  EXPECT_FALSE(found(info_of(mine))) << "there is no folder yet";
  const auto file = kept_.keep(mine);
  EXPECT_EQ(file.filename(), "Novint_Falcon-0000001-1-2.device.toml");
  ASSERT_TRUE(found(info_of(mine)));
  EXPECT_TRUE(found(info_of(mine))->model == mine);
  EXPECT_FALSE(found(info_of(falcon("0000001", "1-3", ""))));
  EXPECT_FALSE(found(info_of(falcon("0000002", "1-2", ""))));
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(ModelStore, KeepsTheLastModelOfADeviceInPlaceOfTheOneBefore) {
  const auto old = falcon("1", "1-2", "2026-01-31T12:00:00Z");
  const auto other = falcon("2", "1-2", "2026-01-31T12:00:00Z");
  (void)kept_.keep(old);
  (void)kept_.keep(other);
  const auto anew = falcon("1", "1-2", "2026-03-31T12:00:00Z");
  (void)kept_.keep(anew);
  EXPECT_EQ(kept_.all({}).size(), 2U);
  EXPECT_EQ(found(info_of(old))->model.date, "2026-03-31T12:00:00Z");
}

TEST_F(ModelStore, KnowsASimulatedDeviceByItsUri) {
  (void)kept_.keep(test::model_of("sim:axis?tells=off&mass=0.1kg"));
  (void)kept_.keep(test::model_of("sim:axis?tells=off&mass=0.2kg"));
  EXPECT_EQ(kept_.all({}).size(), 2U);
  EXPECT_TRUE(found(info_of(test::model_of("sim:axis?tells=off&mass=0.2kg"))));
  EXPECT_FALSE(found(info_of(test::model_of("sim:axis?tells=off"))));
}

TEST_F(ModelStore, PassesOverAFileThatIsNoneAndSaysSo) {
  const auto mine = falcon("1", "1-2", "2026-01-31T12:00:00Z");
  (void)kept_.keep(mine);
  test::write_text(folder_ / "devices" / "broken.device.toml", "format = 1\n");
  EXPECT_TRUE(found(info_of(mine)));
  EXPECT_THAT(warnings_, ElementsAre(testing::AllOf(HasSubstr("broken.device.toml:1: 'date' is missing"),
                                                    HasSubstr("it is passed over"))));
}

}  // namespace
}  // namespace kerf::bench
