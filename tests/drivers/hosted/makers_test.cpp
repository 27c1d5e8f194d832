#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <string>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "../force/watched_sensor.h"
#include "kerf/drivers/attached_ports.h"
#include "makers/fake_device.h"
#include "plugin_of.h"
#include "support/program.h"

namespace kerf::drivers {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// The libraries of makers, played, with a state that is seen from here.
class Makers : public testing::Test {
 protected:
  Makers() {
    state_ = map();
    set("FAKE_STATE", file_);
    set("FAKE_MOOD", "");
  }
  ~Makers() override {
    (void)munmap(state_, sizeof(FakeState));
    (void)unsetenv("FAKE_STATE");  // NOLINT(concurrency-mt-unsafe)
    (void)unsetenv("FAKE_MOOD");   // NOLINT(concurrency-mt-unsafe)
  }

  static void in_mood(const std::string& mood) { set("FAKE_MOOD", mood); }
  void begin_anew() { *state_ = {}; }
  static std::string library(const std::string& name) { return "library=" KERF_TEST_DEVICES "/" + name; }
  static std::string touch(const std::string& options = "") {
    return "openhaptics:?" + library("libHD.so") + options;
  }
  static std::string omega(const std::string& options = "") {
    return "dhd:0?" + library("libdrd.so") + options;
  }

  /// Until the sample is so, for ten seconds at most, with a force.
  template <typename Condition>
  static bool feels(Device& device, const Axes& force, const Condition& condition) {
    Sample sample;
    return becomes([&] {
      (void)device.write(force);
      return device.read(0.0, sample) == Status::ok && condition(sample);
    });
  }
  static bool is_lost(Device& device, const Axes& force = {}) {
    Sample sample;
    return becomes([&] {
      (void)device.write(force);
      return device.read(0.0, sample) == Status::lost;
    });
  }
  [[nodiscard]] bool is_at_rest() const {
    return state_->force_n[0] == 0.0 && state_->force_n[1] == 0.0 && state_->force_n[2] == 0.0;
  }
  static void set(const char* name, const std::string& value) {
    (void)setenv(name, value.c_str(), 1);  // NOLINT(concurrency-mt-unsafe): before a host is started
  }
  FakeState* map() const {
    const int number = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    EXPECT_EQ(ftruncate(number, sizeof(FakeState)), 0);
    void* const mapped = mmap(nullptr, sizeof(FakeState), PROT_READ | PROT_WRITE, MAP_SHARED, number, 0);
    EXPECT_NE(mapped, MAP_FAILED);
    ::close(number);
    return static_cast<FakeState*>(mapped);
  }

  test::TemporaryFolder folder_;
  std::string file_ = (folder_ / "state").string();
  FakeState* state_ = nullptr;
};
using OpenHaptics = Makers;
using ForceDimension = Makers;

TEST_F(Makers, MoveAHandleTheWayOfTheForceInTheirOwnFrame) {
  for (const std::string& uri : {touch(), omega()}) {
    const auto device = open_device(uri);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Axes force{};
      force[axis] = axis == 1 ? -0.6 : 0.6;
      // The hand has 300 N/m.
      EXPECT_TRUE(feels(*device, force,
                        [&](const Sample& now) {
                          return std::abs(now.position[axis] - force[axis] / 300.0) < 1e-5 &&
                                 std::abs(state_->force_n[axis] - force[axis]) < 1e-12;
                        }))
          << uri << axis;
    }
    EXPECT_EQ(state_->misused, 0U) << uri;
    EXPECT_EQ(device->trouble(), "");
  }
}

TEST_F(Makers, AreLetGoWhenTheirProgramIsKilled) {
  for (const std::string& uri : {touch(), omega()}) {
    begin_anew();
    kill_who_holds(uri, {0.5, 0.0, 0.0});
    EXPECT_TRUE(becomes([&] { return is_at_rest() && state_->opened == 0; })) << uri;
    EXPECT_EQ(state_->largest_n[0], 0.5) << uri;
    EXPECT_EQ(state_->is_on, 0) << uri;
  }
}

TEST_F(Makers, AreLetGoWhereAForceIsNotRenewedAndTakeOneAgain) {
  for (const std::string& uri : {touch(), omega()}) {
    begin_anew();
    const auto device = open_device(uri);
    const auto pushes = [&](double force) {
      return feels(*device, {force}, [&](const Sample&) { return state_->force_n[0] == force; });
    };
    EXPECT_TRUE(pushes(0.5)) << uri;
    EXPECT_TRUE(becomes([&] { return is_at_rest(); })) << uri;
    EXPECT_TRUE(pushes(-0.5)) << uri;
  }
}

TEST_F(Makers, ThatAreNotInstalledSayWhatToInstall) {
  EXPECT_THAT(
      refusal_to_open("openhaptics:?library=libNone.so"),
      AllOf(HasSubstr("is not installed"), HasSubstr("libNone.so"), HasSubstr("Touch Device Driver")));
  EXPECT_THAT(refusal_to_open("dhd:0?library=libNone.so"),
              AllOf(HasSubstr("is not installed"), HasSubstr("FDSDK")));
  const std::string no_library = (folder_ / "libtext.so").string();
  std::ofstream(no_library) << "text";
  EXPECT_THAT(refusal_to_open("dhd:0?library=" + no_library), HasSubstr("cannot be loaded"));
  EXPECT_THAT(refusal_to_open("openhaptics:?" + library("libHD_lacking.so")),
              AllOf(HasSubstr("lacks hdStartScheduler, hdStopScheduler"), HasSubstr("version")));
  EXPECT_THAT(refusal_to_open("dhd:0?" + library("libdrd_lacking.so")), HasSubstr("lacks dhdGetPosition:"));
  EXPECT_THAT(refusal_to_open("openhaptics:?" + library("libdrd.so")), HasSubstr("lacks hdInitDevice"));
  EXPECT_THAT(refusal_to_open("dhd:x"), HasSubstr("no device 'dhd:x'"));
}

TEST_F(ForceDimension, IsFoundWhereItsFolderIsNamed) {
  std::filesystem::create_directories(folder_ / "lib/release/lin-x86_64-gcc");
  const auto place = folder_ / "lib/release/lin-x86_64-gcc/libdrd.so.3.17.5";
  std::filesystem::copy_file(KERF_TEST_DEVICES "/libdrd.so", place);
  std::ofstream(folder_ / "lib/release/lin-x86_64-gcc/libdrd.so.3.9.1") << "older";
  set("FDSDK", folder_.path().string());
  const auto device = open_device("dhd:0");
  (void)unsetenv("FDSDK");  // NOLINT(concurrency-mt-unsafe)
  EXPECT_THAT(device->info().configuration, HasSubstr(place.string()));
  EXPECT_EQ(device->info().serial, "1234");
}

TEST_F(Makers, AreListedByTheirLibrariesWhichAreThereOrNot) {
  std::filesystem::create_directories(folder_ / ".local/lib");
  std::filesystem::copy_file(KERF_TEST_DEVICES "/libdrd.so", folder_ / ".local/lib/libdrd.so.3");
  const char* const before = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe): one thread
  const std::string home = before == nullptr ? "/" : before;
  set("HOME", folder_.path().string());
  const auto libraries = find_maker_libraries();
  set("HOME", home);
  ASSERT_EQ(libraries.size(), 2U);
  EXPECT_EQ(libraries[0].found, "");
  EXPECT_THAT(libraries[0].problem, testing::StartsWith("3D Systems' OpenHaptics is not installed"));
  EXPECT_THAT(libraries[1].found, testing::EndsWith("/.local/lib/libdrd.so.3; devices: 1"));
  EXPECT_EQ(libraries[1].problem, "");
  EXPECT_EQ(state_->opened, 0);
}

TEST_F(OpenHaptics, TellsWhatTheDeviceSays) {
  in_mood("pressed");
  const auto device = open_device("openhaptics:left?" + library("libHD.so"));
  const DeviceInfo& info = device->info();
  EXPECT_EQ(info.model, "Touch");
  EXPECT_EQ(info.serial, "T-17");
  ASSERT_EQ(info.axes.size(), 3U);
  EXPECT_EQ(info.axes[0].lower, -0.16);
  EXPECT_EQ(info.axes[2].upper, 0.07);
  EXPECT_EQ(info.axes[0].force_limit, 0.88);  // what it bears for long
  EXPECT_THAT(info.configuration,
              AllOf(HasSubstr("library_version = '3.4.0'"), HasSubstr("nominal_max_force = { value = 3.3")));
  EXPECT_TRUE(feels(*device, {}, [](const Sample& now) {
    return now.channels[0] == 2.0 && now.channels[1] == 0.1 && now.channels[3] == 0.3 &&
           now.channels[4] == 0.5;
  }));
  // Some frame was the first to carry a force, and says how long that took.
  EXPECT_TRUE(feels(*device, {0.1}, [](const Sample& now) { return now.channels[5] > 0.0; }));
  EXPECT_EQ(open_device(touch("&most_force=3N"))->info().axes[0].force_limit, 3.0);
  EXPECT_THAT(refusal_to_open(touch("&most_force=4N")), HasSubstr("at most 3.3 N"));
}

TEST_F(OpenHaptics, IsRefusedWithWhatIsWrong) {
  const auto why = [&](const std::string& mood) {
    in_mood(mood);
    return refusal_to_open(touch());
  };
  EXPECT_THAT(why("no_device"),
              HasSubstr("'default' of OpenHaptics does not start: it is faulty, without power"));
  EXPECT_THAT(why("busy"), HasSubstr("another program has it"));
  EXPECT_THAT(why("uncalibrated"), HasSubstr("put the stylus into the inkwell"));
  EXPECT_THAT(why("no_limit"), HasSubstr("most_force=1N"));
  EXPECT_THAT(why("no_timer"), HasSubstr("its servo loop does not start: the maker's library gets no timer"));
  EXPECT_THAT(why("full"), HasSubstr("HD_SCHEDULER_FULL"));
  EXPECT_THAT(refusal_to_open("openhaptics:right?" + library("libHD.so")), HasSubstr("'right'"));
  in_mood("inkwell");
  EXPECT_NO_THROW((void)open_device(touch()));
  EXPECT_EQ(state_->opened, 0);
}

TEST_F(OpenHaptics, LosesADeviceThatSaysSoWithItsReason) {
  struct Case {
    const char* mood;
    const char* reason;
  };
  for (const Case& one : {Case{"warm", "its motors are warm"},
                          {"unplugged", "nothing comes over its cable"},
                          {"errs", "it could not give the force"},
                          {"stall", "stood still for a second"},
                          {"crash", "it crashed: SIGSEGV"}}) {
    begin_anew();
    in_mood(one.mood);
    const auto device = open_device(touch());
    EXPECT_TRUE(is_lost(*device, {0.5})) << one.mood;
    EXPECT_TRUE(becomes([&] { return device->trouble().find(one.reason) != std::string::npos; }))
        << one.mood << device->trouble();
    EXPECT_TRUE(becomes([&] { return is_at_rest() && state_->is_on == 0; })) << one.mood;
    EXPECT_EQ(state_->largest_n[0], 0.5) << one.mood;
  }
}

TEST_F(OpenHaptics, GoesOnAfterOneErrorAndAfterAServoLoopThatPaused) {
  for (const char* const mood : {"max_force", "pause"}) {
    begin_anew();
    in_mood(mood);
    const auto device = open_device(touch());
    const auto seen = watch(*device, ticks(1200));
    ASSERT_EQ(seen.size(), 1200U) << mood;
    EXPECT_TRUE(std::ranges::any_of(seen, [](const Seen& one) { return one.status == Status::fault; }))
        << mood;
    EXPECT_TRUE(feels(*device, {0.5}, [&](const Sample& now) {
      return std::abs(now.position[0] - 0.5 / 300.0) < 1e-5;
    })) << mood;
  }
}

TEST_F(OpenHaptics, IsAFaultWhereItsPositionIsNoNumber) {
  in_mood("nan");
  const auto device = open_device(touch());
  Sample sample;
  EXPECT_TRUE(becomes([&] { return device->read(0.0, sample) == Status::fault; }));
}

TEST_F(ForceDimension, TellsWhatTheDeviceSays) {
  in_mood("pressed");
  const auto device = open_device(omega());
  const DeviceInfo& info = device->info();
  EXPECT_EQ(info.model, "omega.3");
  EXPECT_EQ(info.axes[1].force_limit, 12.0);
  EXPECT_EQ(info.axes[2].upper, 0.075);
  EXPECT_THAT(info.configuration,
              AllOf(HasSubstr("library_version = \"3.17.5.1\""), HasSubstr("gravity_compensation = true")));
  EXPECT_EQ(state_->has_brakes, 1);
  EXPECT_EQ(state_->has_gravity_compensation, 1);
  EXPECT_EQ(state_->is_on, 0);  // before the first force
  EXPECT_TRUE(
      feels(*device, {}, [](const Sample& now) { return now.channels[0] == 1.0 && now.channels[2] >= 0.0; }));
  EXPECT_EQ(state_->is_on, 0);
}

TEST_F(ForceDimension, TakesItsOptionsAndTheLowerOfTwoLimits) {
  {
    const auto device = open_device(omega("&brakes=off&gravity=off&most_force=2N&rate=500Hz"));
    EXPECT_EQ(device->info().axes[0].force_limit, 2.0);
    EXPECT_EQ(state_->has_brakes, 0);
    EXPECT_EQ(state_->has_gravity_compensation, 0);
  }
  in_mood("lower_limit");
  EXPECT_EQ(open_device(omega())->info().axes[0].force_limit, 5.0);
  EXPECT_THAT(refusal_to_open(omega("&most_force=6N")), HasSubstr("at most 5 N"));
  in_mood("uncalibrated");
  EXPECT_THAT(refusal_to_open(omega()), HasSubstr("with calibrate=on it moves by itself"));
  EXPECT_NO_THROW((void)open_device(omega("&calibrate=on")));
  in_mood("");
  EXPECT_EQ(open_device("dhd:0?" + library("libdhd_alone.so"))->info().model, "omega.3");
}

TEST_F(ForceDimension, IsRefusedWithWhatIsWrong) {
  const auto why = [&](const std::string& mood) {
    in_mood(mood);
    return refusal_to_open(omega());
  };
  EXPECT_THAT(why("old"), HasSubstr("version 2.17.5.1 of the SDK, expected 3.0"));
  EXPECT_THAT(why("no_device"), AllOf(HasSubstr("0 devices are there"), HasSubstr("1451")));
  EXPECT_THAT(why("busy"), HasSubstr("device in use (error 20 of DHD)"));
  EXPECT_THAT(why("no_power"), HasSubstr("it has no power"));
  EXPECT_THAT(why("unknown_type"), HasSubstr("most_force=1N"));
  in_mood("");
  EXPECT_THAT(refusal_to_open("dhd:1?" + library("libdrd.so")),
              HasSubstr("1 devices are there, numbers 0 to 0"));
  EXPECT_EQ(state_->opened, 0);
}

TEST_F(ForceDimension, LosesADeviceThatPutsItsForcesOffOrIsGone) {
  struct Case {
    const char* mood;
    const char* reason;
  };
  for (const Case& one : {Case{"button", "its forces went off: somebody pressed its force button"},
                          {"too_fast", "it moved too fast"},
                          {"unplugged", "communication error (error 2 of DHD)"},
                          {"hang", "it does not come back in read()"}}) {
    begin_anew();
    in_mood(one.mood);
    const auto device = open_device(omega());
    EXPECT_TRUE(is_lost(*device, {0.5})) << one.mood;
    EXPECT_THAT(device->trouble(), HasSubstr(one.reason)) << one.mood;
    EXPECT_TRUE(becomes([&] { return is_at_rest() && state_->is_on == 0; })) << one.mood;
    EXPECT_EQ(state_->largest_n[0], 0.5) << one.mood;
  }
}

TEST_F(ForceDimension, TakesNoSampleTwiceAndTellsWhatItCannotGive) {
  in_mood("timeguard");
  {
    const auto device = open_device(omega());
    ASSERT_TRUE(becomes([&] { return state_->turns > 400; }));
    const double reports = figure(*device, "reports");
    EXPECT_NEAR(reports, 0.5 * static_cast<double>(state_->turns), 10.0);
  }
  in_mood("saturated");
  const auto device = open_device(omega());
  EXPECT_TRUE(feels(*device, {0.5}, [](const Sample& now) { return now.channels[1] == 1.0; }));
}

}  // namespace
}  // namespace kerf::drivers
