#include "kerf/drivers/hosted_device.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "../force/watched_sensor.h"
#include "kerf/drivers/device_notes.h"
#include "plugin_of.h"
#include "support/program.h"

namespace kerf::drivers {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Hosted : public testing::Test {
 protected:
  std::string uri(const std::string& mood) const {
    return "plugin:" + device_plugin("moody") + "?mood=" + mood + "&log=" + log_;
  }
  std::unique_ptr<Device> open(const std::string& mood = "well") const { return open_device(uri(mood)); }
  [[nodiscard]] bool is_logged(const std::string& what) const {
    const auto log = log_in(log_);
    return std::ranges::any_of(log, [&](const Logged& one) { return one.what == what; });
  }
  /// By a process that did not write the first line.
  [[nodiscard]] bool is_let_go_instead() const {
    const auto log = log_in(log_);
    return std::ranges::any_of(
        log, [&](const Logged& one) { return one.what == "release" && one.process != log.front().process; });
  }
  /// Reads and writes a force until the device is lost, for ten seconds at most.
  static Status until_lost(Device& device, double force = 1.0) {
    Sample sample;
    Status status = Status::ok;
    becomes([&] {
      (void)device.write({force});
      status = device.read(0.0, sample);
      return status == Status::lost;
    });
    return status;
  }

  test::TemporaryFolder folder_;
  std::string log_ = (folder_ / "log").string();
};

TEST_F(Hosted, TellsWhatThePluginReads) {
  const auto device = open();
  const DeviceInfo& info = device->info();
  EXPECT_EQ(info.model, "moody");
  EXPECT_EQ(info.serial, "M1");
  EXPECT_TRUE(info.measures_force);
  EXPECT_FALSE(info.simulated);
  ASSERT_EQ(info.axes.size(), 1U);
  EXPECT_EQ(info.axes[0].name, "x");
  EXPECT_EQ(info.axes[0].lever, 1.0);
  EXPECT_EQ(info.axes[0].force_limit, 5.0);
  ASSERT_EQ(info.channels.size(), 2U);
  EXPECT_EQ(info.channels[0].name, "count");
  EXPECT_EQ(info.channels[1].name, "report_age");
  EXPECT_THAT(info.configuration,
              AllOf(HasSubstr("plugin = "), HasSubstr("sha256 = \""), HasSubstr("gain = 2")));
  const auto seen = watch(*device, ticks(300));
  ASSERT_EQ(seen.size(), 300U);
  double last = 0.0;
  for (const Seen& one : seen) {
    if (one.status != Status::ok) continue;
    ASSERT_NEAR(one.sample.position[0], 1e-6 * one.sample.channels[0], 1e-12);
    ASSERT_GE(one.sample.channels[0], last);
    ASSERT_EQ(one.sample.age_s, one.sample.channels[1]);
    last = one.sample.channels[0];
  }
  EXPECT_GT(last, 100.0);
  EXPECT_EQ(figure(*device, "reports_missing"), 0.0);
  EXPECT_EQ(device->trouble(), "");
}

TEST_F(Hosted, PassesAForceOnWithinItsLimits) {
  struct Passed {
    double given;
    double written;
  };
  for (const char* const mood : {"well", "any_time", "at_once"}) {
    const auto device = open(mood);
    Sample sample;
    for (const Passed& one : {Passed{1.5, 1.5}, {9.0, 5.0}, {-9.0, -5.0}, {std::nan(""), 0.0}}) {
      EXPECT_TRUE(becomes([&] {
        EXPECT_EQ(device->write({one.given}), std::isfinite(one.given) ? Status::ok : Status::fault);
        (void)device->read(0.0, sample);
        return sample.force_measured[0] == -one.written;
      })) << mood
          << one.given;
    }
  }
}

TEST_F(Hosted, AllocatesNothingInATick) {
  const auto device = open("any_time");
  Sample sample;
  const test::NoAllocation none;
  for (int i = 0; i < 100; ++i) {
    (void)device->read(0.0, sample);
    (void)device->write({1.0});
    device->release(0.0);
  }
}

TEST_F(Hosted, LetsGoOfAForceThatIsNotRenewed) {
  for (const char* const mood : {"well", "any_time"}) {
    const auto device = open(mood);
    EXPECT_TRUE(becomes([&] {
      (void)device->write({1.0});
      return is_logged("write");
    }));
    EXPECT_TRUE(becomes([&] { return is_logged("release"); })) << mood;
  }
}

TEST_F(Hosted, IsReleasedAtOnceAndTakesAForceAgainAfterIt) {
  const auto device = open();
  Sample sample;
  const auto feels = [&](double force) {
    return becomes([&] {
      (void)device->write({force});
      (void)device->read(0.0, sample);
      return sample.force_measured[0] == -force;
    });
  };
  EXPECT_TRUE(feels(1.0));
  device->release(0.0);
  EXPECT_TRUE(becomes([&] { return is_logged("release"); }));
  EXPECT_TRUE(feels(2.0));
}

TEST_F(Hosted, ClosesItsDeviceAndLetsItGoBefore) {
  {
    const auto device = open();
    (void)device->write({1.0});
  }
  const auto log = log_in(log_);
  ASSERT_GE(log.size(), 3U);
  EXPECT_EQ(log.back().what, "close");
  EXPECT_EQ(log[log.size() - 2].what, "release");
}

TEST_F(Hosted, LetsGoWhenItsProgramIsKilled) {
  kill_who_holds(uri("well"), {1.0});
  EXPECT_TRUE(becomes([&] { return is_logged("close"); }));
  EXPECT_TRUE(is_logged("release"));
}

struct Misbehaviour {
  const char* mood;
  const char* said;
};

class Misbehaving : public Hosted, public testing::WithParamInterface<Misbehaviour> {};

TEST_P(Misbehaving, IsNamedAndItsDeviceLetGo) {
  const auto device = open(GetParam().mood);
  EXPECT_EQ(until_lost(*device), Status::lost);
  EXPECT_TRUE(becomes([&] { return !device->trouble().empty(); }));
  EXPECT_THAT(device->trouble(), HasSubstr(GetParam().said));
  EXPECT_TRUE(becomes([&] { return is_logged("release"); }));
  EXPECT_EQ(device->write({1.0}), Status::lost);
}

INSTANTIATE_TEST_SUITE_P(Of, Misbehaving,
                         testing::Values(Misbehaviour{"crash_read", "it crashed: SIGSEGV in read()"},
                                         Misbehaviour{"abort_read", "it crashed: SIGABRT in read()"},
                                         Misbehaviour{"exit_read", "it called exit(7) in read()"},
                                         Misbehaviour{"hang_read", "it does not come back in read()"},
                                         Misbehaviour{"crash_write", "it crashed: SIGSEGV in write()"},
                                         Misbehaviour{"exit_write", "it called exit(7) in write()"},
                                         Misbehaviour{"hang_write", "it does not come back in write()"},
                                         Misbehaviour{"lost", "it says that the device is lost"}));

TEST_F(Hosted, IsLetGoByAnotherProcessWhereItHangs) {
  for (const char* const mood : {"hang_read", "hang_write", "crash_read"}) {
    const test::TemporaryFolder folder;
    log_ = (folder / "log").string();
    const auto device = open(mood);
    EXPECT_EQ(until_lost(*device), Status::lost);
    EXPECT_TRUE(becomes([&] { return is_let_go_instead(); })) << mood;
    EXPECT_GE(figure(*device, "let_go_instead"), 1.0) << mood;
  }
}

// Readings go on meanwhile: it is no lost device, but its force is let go.
TEST_F(Hosted, ThatHangsInAWriteBesideItsReadsIsLetGoAndNamed) {
  const auto device = open("hang_write_any_time");
  EXPECT_TRUE(becomes([&] {
    (void)device->write({1.0});
    return is_let_go_instead();
  }));
  EXPECT_TRUE(becomes([&] { return !device->trouble().empty(); }));
  EXPECT_EQ(device->trouble(), "it does not come back in write()");
}

TEST_F(Hosted, ThatIsSilentIsLost) {
  const auto device = open("silent");
  EXPECT_EQ(until_lost(*device), Status::lost);
  EXPECT_EQ(device->trouble(), "");
}

TEST_F(Hosted, TakesADoubtedReadingAndNoNumberForFaults) {
  for (const char* const mood : {"doubts", "no_number"}) {
    const auto device = open(mood);
    Sample sample;
    EXPECT_TRUE(becomes([&] { return device->read(0.0, sample) == Status::fault; })) << mood;
    EXPECT_TRUE(std::isfinite(sample.position[0])) << mood;
  }
}

TEST_F(Hosted, CountsWhatIsMissingByItsOwnCount) {
  const auto device = open("gap");
  EXPECT_TRUE(becomes([&] { return figure(*device, "reports_missing") > 0.0; }));
  EXPECT_EQ(figure(*device, "reports_missing"), 10.0);
}

TEST_F(Hosted, CountsForcesThatAreNotTaken) {
  const auto device = open("takes_none");
  EXPECT_TRUE(becomes([&] {
    (void)device->write({1.0});
    return figure(*device, "forces_not_taken") > 0.0;
  }));
}

TEST_F(Hosted, BelievesNoStampOfTheFuture) {
  const auto device = open("from_the_future");
  Sample sample;
  (void)device->read(0.0, sample);
  EXPECT_GE(sample.age_s, 0.0);
}

TEST_F(Hosted, IsRefusedWithWhatIsWrong) {
  const auto refusal = [&](const std::string& mood) { return refusal_to_open(uri(mood)); };
  EXPECT_THAT(refusal("refuse"), HasSubstr(": there is no board; plug it in"));
  EXPECT_THAT(refusal("refuse_silently"), HasSubstr("does not say why"));
  EXPECT_THAT(refusal("crash_open"), HasSubstr("it crashed: SIGSEGV in open()"));
  EXPECT_THAT(refusal("exit_open"), HasSubstr("it called exit(7) in open()"));
  EXPECT_THAT(refusal("abort_describe"), HasSubstr("it crashed: SIGABRT in describe()"));
  EXPECT_THAT(refusal("hang_open"), HasSubstr("no sign of life in open()"));
  EXPECT_THAT(refusal("nothing"), HasSubstr("no reading has come"));
  EXPECT_THAT(refusal("seven_axes"), HasSubstr("'axis_count' is 7, expected 1 to 6"));
  EXPECT_THAT(refusal("degrees"), HasSubstr("\"deg\", expected \"m\" or \"rad\""));
  EXPECT_THAT(refusal("about_an_angle"), HasSubstr("'axes[0].lever'"));
  EXPECT_THAT(refusal("no_range"), HasSubstr("expected a range"));
  EXPECT_THAT(refusal("no_limit"), HasSubstr("expected both above 0"));
  EXPECT_THAT(refusal("no_zero"), HasSubstr("'model' has no zero behind it"));
  EXPECT_THAT(refusal("no_toml"), HasSubstr("'settings' are no TOML"));
  EXPECT_THAT(refusal("our_channel"), HasSubstr("'report_age'"));
  EXPECT_THAT(refusal("unpaced"), HasSubstr("'rate_hz' is 0"));
  EXPECT_THAT(refusal("well&gain=2"), HasSubstr("no option 'gain'; it takes mood, log"));
  EXPECT_THAT(refusal("well&resample=latest"), HasSubstr("of a force sensor alone"));
  EXPECT_THAT(refusal_to_open("plugin:"), HasSubstr("which shared object"));
  EXPECT_THAT(refusal_to_open("plugin:./nowhere.so"), HasSubstr("there is no file ./nowhere.so"));
  EXPECT_THAT(refusal_to_open("plugin:/dev/null"), HasSubstr("there is no file"));
  EXPECT_THAT(refusal_to_open("plugin:" KERF_SOURCE_DIR "/README.md"), HasSubstr("no shared object"));
  EXPECT_THAT(refusal_to_open("plugin:" + device_plugin("wrong_version")), HasSubstr("version 2"));
  EXPECT_THAT(refusal_to_open("plugin:" + device_plugin("wrong_release")), HasSubstr("no release()"));
  EXPECT_THAT(refusal_to_open("plugin:" + device_plugin("wrong_name")), HasSubstr("no 'name'"));
  EXPECT_THAT(refusal_to_open("plugin:" + device_plugin("wrong_nothing")), HasSubstr("returns nothing"));
}

TEST_F(Hosted, SaysWhatItWaitsFor) {
  std::string told;
  tell_waits_to([&](const std::string& line) { told = line; });
  const auto device = open("slow_open");
  tell_waits_to({});
  EXPECT_THAT(told, HasSubstr("it may take 3 s to be opened"));
}

TEST_F(Hosted, GivesUpOpeningWhereNobodyWaits) {
  std::atomic<bool> stop{true};
  Surroundings surroundings;
  surroundings.stop = &stop;
  EXPECT_THROW((void)open_device(uri("hang_open"), surroundings), DeviceError);
}

TEST_F(Hosted, IsLookedAtWithoutBeingOpened) {
  const PluginDevice plugin = look_at_plugin(device_plugin("moody"));
  EXPECT_EQ(plugin.name, "moody");
  EXPECT_EQ(plugin.about, "for tests");
  EXPECT_THAT(plugin.options, testing::ElementsAre("mood", "log"));
}

TEST_F(Hosted, GivesNoForceWhereNobodyStandsBy) {
  const auto device = open();
  Sample sample;
  EXPECT_TRUE(becomes([&] {
    (void)device->write({1.0});
    (void)device->read(0.0, sample);
    return sample.force_measured[0] == -1.0;
  }));
  const int host = log_in(log_).front().process;
  std::ifstream children(fmt::format("/proc/{}/task/{}/children", host, host));
  pid_t copy = 0;
  ASSERT_TRUE(children >> copy) << "the kernel does not tell children";
  ASSERT_EQ(kill(copy, SIGKILL), 0);
  EXPECT_TRUE(becomes([&] { return device->write({1.0}) == Status::fault && is_logged("release"); }));
  EXPECT_THAT(device->trouble(), HasSubstr("no force any more"));
}

TEST_F(Hosted, LeavesNoProcessBehind) {
  { const auto device = open(); }
  const auto log = log_in(log_);
  EXPECT_TRUE(becomes([&] { return kill(log.front().process, 0) != 0; }));
}

}  // namespace
}  // namespace kerf::drivers
