#include "support/device_models.h"

#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/drivers/velocity_filter.h>

#include "bench/analysis/choose/known_cuts.h"
#include "bench/analysis/choose/known_laws.h"
#include "choose/choose_on_device.h"
#include "device_model/kept_models.h"
#include "stability/study.h"
#include "support/program.h"

namespace kerf::test {
namespace {

using bench::KeptModels;
using nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;

const std::string unknown = "sim:axis?tells=off";

/// Where a test keeps its models.
class DeviceModels : public testing::Test {
 protected:
  DeviceModels() { setenv("XDG_DATA_HOME", folder_.path().c_str(), 1); }
  ~DeviceModels() override { unsetenv("XDG_DATA_HOME"); }

  [[nodiscard]] std::string file() const { return (folder_ / "x.device.toml").string(); }
  [[nodiscard]] static ordered_json boundaries(bench::AxisRequest on) {
    on.device_uri = unknown;
    bench::StudyOptions options{.on = std::move(on), .cells = 5};
    options.map.with_cells = false;
    return bench::study_walls(options).json;
  }

  TemporaryFolder folder_;
};

TEST_F(DeviceModels, GiveTheBoundaryOfTheSameNumbersByHand) {
  bench::write_model_file(file(), model_of(unknown));
  bench::AxisRequest by_file;
  by_file.device_model = file();
  bench::AxisRequest numbers;
  numbers.mass_kg = 0.08;
  numbers.viscous_n_s_per_m = 2.0;
  numbers.coulomb_n = 0.0;
  numbers.encoder_step_m = 20e-6;
  numbers.delay_s = 1.3e-3;
  numbers.velocity_corner_rad_s = drivers::VelocityFilter::corner_rad_s;
  const ordered_json by_model = boundaries(by_file);
  const ordered_json by_hand = boundaries(numbers);
  EXPECT_EQ(by_model.at("device"), by_hand.at("device"));
  EXPECT_EQ(by_model.at("boundaries"), by_hand.at("boundaries"));
  EXPECT_EQ(by_model.at("device").at("delay_s"), 1.3e-3);
  EXPECT_EQ(by_model.at("device_model").at("file"), file());
  EXPECT_TRUE(by_hand.at("device_model").is_null());
  numbers.device_model = file();
  numbers.mass_kg = 0.2;
  EXPECT_EQ(boundaries(numbers).at("device").at("mass_kg"), 0.2) << "what is given by hand wins";
}

TEST_F(DeviceModels, AreTakenWithoutBeingAskedAndSaidToBeOld) {
  const std::string kept =
      KeptModels(folder_ / "kerf" / "devices").keep(model_of(unknown, "2020-01-31T12:00:00Z")).string();
  bench::AxisRequest faster;
  faster.rate_hz = 2000.0;
  const ordered_json found = boundaries(faster);
  EXPECT_EQ(found.at("device_model").at("file"), kept);
  EXPECT_THAT(found.at("device_model").at("doubts").dump(),
              AllOf(HasSubstr("days old"), HasSubstr("2000 Hz is judged")));
  const Outcome listed = run_kerf({"devices"});
  EXPECT_THAT(listed.output,
              AllOf(HasSubstr("Measured:"), HasSubstr(kept), HasSubstr("days ago, free, at 1000 Hz")));
}

TEST_F(DeviceModels, LeaveWhatNobodyHasMeasuredUnknown) {
  EXPECT_THROW((void)boundaries({}), std::invalid_argument);
  bench::AxisRequest nowhere;
  nowhere.device_model = "nowhere.device.toml";
  EXPECT_THROW((void)boundaries(nowhere), std::invalid_argument);
}

TEST_F(DeviceModels, AreNamedByAChoiceWhoseStabilityRestsOnThem) {
  drivers::DeviceModel model = model_of("sim:scissors");
  model.model = "sim:scissors";
  model.axes[0].name = "theta";
  model.axes[0].position_unit = "rad";
  model.axes[0].lever = 0.28 / 7.58;
  model.axes[0].validation.fits = false;
  bench::write_model_file(file(), model);
  const schema::Recording recording = cut_of(known_kelvin());
  bench::DeviceChoiceOptions options{.loop = {.device_uri = "sim:scissors", .device_model = file()},
                                     .tried_by = bench::TriedBy::virtual_time,
                                     .begins = {}};
  options.choose.candidates.max_segments = 1;
  const std::atomic<bool> go_on{false};
  const auto made = bench::choose_on_device(recording, "cut.h5", options, go_on);
  EXPECT_EQ(made.json.at("device_model").at("file"), file());
  EXPECT_EQ(made.json.at("device_model").at("fits"), false);
  EXPECT_THAT(made.choice.warnings, testing::Contains(HasSubstr("does not fit the device")));
}

}  // namespace
}  // namespace kerf::test
