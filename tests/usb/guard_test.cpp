#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/drivers/device.h>
#include <kerf/mechanisms/woodenhaptics.h>
#include <kerf/schema/recording.h>

#include "emulator.h"
#include "falcon_bench.h"
#include "support/program.h"
#include "wall.h"
#include "woodenhaptics_bench.h"

namespace kerf::test {
namespace {

using drivers::Sample;
using drivers::Status;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr std::array<int, 3> no_motor{0, 0, 0};

/// A device with motors, as it is emulated and opened, with a wall that its hand leans on all the time.
struct Guarded {
  std::string name;
  std::string emulator;
  std::string uri;
  double wall_m;
  bool is_falcon;
};
std::vector<Guarded> guarded() {
  std::vector<Guarded> all{{"Falcon", "falcon?firmware=loaded&homed=on&sway=0m", "falcon:0", 0.125, true}};
  for (const Generation& one : generations) {
    const double middle_m = mechanisms::WoodenHaptics::find(one.model)->centre_m[2];
    all.push_back({one.name, one.emulator + "&sway=0m", one.uri, middle_m + 0.005, false});
  }
  return all;
}
/// One of each driver, for what does not depend on how a generation takes its orders: a second in the guest
/// takes four.
std::vector<Guarded> guarded_of_each_driver() {
  const std::vector<Guarded> all = guarded();
  return {all.front(), all.back()};
}

/// What the motors were told, and when.
struct Told {
  double time_s;
  std::array<int, 3> motor;
};
std::vector<Told> read_told(const Guarded& device, const fs::path& trace) {
  std::vector<Told> told;
  if (device.is_falcon) {
    for (const TraceRow& row : read_trace(trace)) told.push_back({row.time_s, row.motor});
  } else {
    for (const AppliedOrder& row : read_orders(trace)) told.push_back({row.time_s, row.current_ma});
  }
  return told;
}

/// When the last order that gave a force was taken, and the first zero after it; -1: none.
struct Ends {
  double last_force_s = -1.0;
  double zero_s = -1.0;
};
Ends ends_of(const std::vector<Told>& told) {
  Ends ends;
  for (const Told& one : told) {
    if (one.motor != no_motor) {
      ends = {.last_force_s = one.time_s};
    } else if (ends.last_force_s >= 0.0 && ends.zero_s < 0.0) {
      ends.zero_s = one.time_s;
    }
  }
  return ends;
}

/// What is rendered, and what has to be said of it.
struct Wall {
  std::string law;
  std::vector<std::string> words{};
};
Wall wall_of(const Guarded& device) { return {wall_below(device.wall_m, "1")}; }

/// `kerf record` of a wall, while the object lives.
class HeldWall {
 public:
  HeldWall(const Guarded& device, const Wall& wall, const TemporaryFolder& folder, double seconds) {
    write_text(folder / "wall.law.toml", wall.law);
    std::vector<std::string> words{KERF_PROGRAM,      "record",
                                   "--device",        device.uri,
                                   "--law",           folder / "wall.law.toml",
                                   "--seconds",       std::to_string(seconds),
                                   "--force",         "-o",
                                   folder / "wall.h5"};
    words.insert(words.end(), wall.words.begin(), wall.words.end());
    std::vector<char*> arguments;
    for (std::string& one : words) arguments.push_back(one.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const std::string said = folder / "said";
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (posix_spawn(&process_, arguments[0], &actions, nullptr, arguments.data(), environ) != 0) {
      throw std::runtime_error("kerf cannot be run");
    }
    posix_spawn_file_actions_destroy(&actions);
  }
  HeldWall(const HeldWall&) = delete;
  HeldWall& operator=(const HeldWall&) = delete;
  ~HeldWall() {
    signal(SIGKILL);
    (void)end();
  }
  void signal(int number) const {
    if (process_ > 0) kill(process_, number);
  }
  /// As waitpid() tells it.
  int end() {
    int status = 0;
    if (process_ > 0) waitpid(process_, &status, 0);
    process_ = 0;
    return status;
  }

 private:
  pid_t process_ = 0;
};

/// Processes named kerf-guard, also those that have ended and nobody has asked how.
std::vector<pid_t> guards() {
  std::vector<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string stat = read_text(entry.path() / "stat");
    if (stat.find(" (kerf-guard) ") != std::string::npos) found.push_back(std::stoi(stat));
  }
  return found;
}

void rest_for(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

/// What the motors were told while the wall was held, something was done to the program, and 0.2 s more: less
/// than the half second after which a WoodenHaptics lets go by itself.
template <typename F>
std::vector<Told> told_when(const Guarded& device, const Wall& wall, F act) {
  const TemporaryFolder folder;
  const auto trace = folder / "trace.csv";
  {
    const Emulator emulator(device.emulator + "&trace=" + trace.string());
    EXPECT_TRUE(becomes_attached(device.uri));
    HeldWall recording(device, wall, folder, 60.0);
    rest_for(1.0);
    EXPECT_EQ(guards().size(), 1U) << read_text(folder / "said");
    act(recording);
    rest_for(0.2);
    EXPECT_TRUE(guards().empty());
  }
  return read_told(device, trace);
}
template <typename F>
std::vector<Told> told_when(const Guarded& device, F act) {
  return told_when(device, wall_of(device), act);
}

/// The last order was given at most a millisecond before the program was hit.
void expect_let_go(const Guarded& device, const char* by, const std::vector<Told>& told) {
  const Ends ends = ends_of(told);
  ASSERT_GE(ends.last_force_s, 0.5) << "the wall was held";
  ASSERT_GE(ends.zero_s, 0.0) << "the motors were not let go";
  std::printf("%s, %s: zero %.3f ms after the last force\n", device.name.c_str(), by,
              1e3 * (ends.zero_s - ends.last_force_s));
  EXPECT_LE(ends.zero_s - ends.last_force_s, 0.05);
}

TEST(Guard, LetsGoWhenTheProgramDies) {
  struct Death {
    Guarded device;
    int number;
    const char* name;
  };
  std::vector<Death> deaths;
  for (const Guarded& device : guarded()) deaths.push_back({device, SIGKILL, "SIGKILL"});
  for (const Guarded& device : guarded_of_each_driver()) {
    deaths.push_back({device, SIGSEGV, "SIGSEGV"});
    deaths.push_back({device, SIGABRT, "SIGABRT"});
  }
  for (const Death& death : deaths) {
    SCOPED_TRACE(death.device.name + " " + death.name);
    expect_let_go(death.device, death.name, told_when(death.device, [&](HeldWall& recording) {
                    recording.signal(death.number);
                    EXPECT_EQ(WTERMSIG(recording.end()), death.number);
                  }));
  }
}

TEST(Guard, LetsGoWhenTheLawOfAPluginCrashes) {
  for (const Guarded& device : guarded_of_each_driver()) {
    SCOPED_TRACE(device.name);
    const Wall wall{.law = fmt::format(R"(model = "late_crash"
axis = "z"
contact = {{ position = {{ value = {}, unit = "m" }}, direction = "decreasing" }}
[parameters]
stiffness = {{ value = 400, unit = "N/m" }}
life = {{ value = 1.2, unit = "s" }}
)",
                                       device.wall_m),
                    .words = {"--plugin", KERF_TEST_PLUGINS "/late_crash.so"}};
    expect_let_go(device, "a plug-in's abort()", told_when(device, wall, [](HeldWall& recording) {
                    const int status = recording.end();
                    EXPECT_TRUE(WIFEXITED(status));
                    EXPECT_EQ(WEXITSTATUS(status), 4);
                  }));
  }
}

TEST(Guard, LetsGoWhenTheProgramIsStoppedAndGoesWhenItIsKilled) {
  for (const Guarded& device : guarded_of_each_driver()) {
    SCOPED_TRACE(device.name);
    expect_let_go(device, "SIGSTOP", told_when(device, [](HeldWall& recording) {
                    recording.signal(SIGSTOP);
                    rest_for(0.2);
                    EXPECT_EQ(guards().size(), 1U);
                    recording.signal(SIGKILL);
                    (void)recording.end();
                  }));
  }
}

TEST(GuardLife, GoesOnWatchingAProgramThatComesBack) {
  for (const Guarded& device : guarded_of_each_driver()) {
    SCOPED_TRACE(device.name);
    const auto told = told_when(device, [](HeldWall& recording) {
      for (int times = 0; times < 2; ++times) {
        recording.signal(SIGSTOP);
        rest_for(0.3);
        recording.signal(SIGCONT);
        rest_for(0.5);
      }
      recording.signal(SIGTERM);
      const int status = recording.end();
      EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    });
    int gaps = 0;
    bool force_since = false;
    for (std::size_t i = 1; i < told.size(); ++i) {
      force_since = force_since || told[i].motor != no_motor;
      if (told[i].time_s - told[i - 1].time_s < 0.2) continue;
      ++gaps;
      EXPECT_TRUE(force_since) << "the force came back in between";
      force_since = false;
      EXPECT_EQ(told[i - 1].motor, no_motor) << "let go while it was stopped";
      EXPECT_EQ(told[i].motor, no_motor) << "and it began with zero";
    }
    EXPECT_EQ(gaps, 2);
    EXPECT_TRUE(force_since);
    expect_let_go(device, "SIGSTOP, SIGCONT, SIGTERM", told);
  }
}

TEST(GuardLife, EndsWithTheProgram) {
  for (const Guarded& device : guarded_of_each_driver()) {
    SCOPED_TRACE(device.name);
    expect_let_go(device, "SIGTERM", told_when(device, [](HeldWall& recording) {
                    recording.signal(SIGTERM);
                    const int status = recording.end();
                    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
                    EXPECT_TRUE(guards().empty());
                  }));
  }
}

TEST(GuardLife, IsDeafToWhatEndsTheProgram) {
  const Guarded device = guarded().front();
  expect_let_go(device, "SIGKILL", told_when(device, [](HeldWall& recording) {
                  const auto all = guards();
                  ASSERT_EQ(all.size(), 1U);
                  EXPECT_EQ(getsid(all.front()), all.front()) << "no terminal reaches it";
                  for (const int number : {SIGINT, SIGQUIT, SIGTERM, SIGHUP, SIGTSTP}) {
                    kill(all.front(), number);
                  }
                  rest_for(0.1);
                  EXPECT_EQ(guards(), all);
                  recording.signal(SIGKILL);
                  (void)recording.end();
                }));
}

TEST(GuardLife, TheNextProgramHasTheDeviceAtOnce) {
  for (const Guarded& device : guarded_of_each_driver()) {
    SCOPED_TRACE(device.name);
    const auto told = told_when(device, [&](HeldWall& recording) {
      recording.signal(SIGKILL);
      (void)recording.end();
      const TemporaryFolder another;
      HeldWall next(device, wall_of(device), another, 0.5);
      const int status = next.end();
      EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << read_text(another / "said");
    });
    expect_let_go(device, "the next run", told);
  }
}

TEST(GuardLife, WithoutOneADeviceIsRefused) {
  const TemporaryFolder folder;
  fs::copy_file(KERF_PROGRAM, folder / "kerf");
  for (const Guarded& device : guarded()) {
    const Emulator emulator(device.emulator);
    ASSERT_TRUE(becomes_attached(device.uri));
    const auto outcome =
        run({folder / "kerf", "record", "--device", device.uri, "--seconds", "1", "-o", folder / "none.h5"});
    EXPECT_EQ(outcome.exit_status, 3);
    EXPECT_THAT(outcome.errors, HasSubstr((folder / "kerf-guard").string() + ", which lets the motors go"));
    EXPECT_FALSE(fs::exists(folder / "none.h5"));
  }
}

TEST(GuardLife, WhereItHasDiedTheForceEnds) {
  for (const Guarded& one : guarded()) {
    SCOPED_TRACE(one.name);
    const TemporaryFolder folder;
    const auto trace = folder / "trace.csv";
    {
      const Emulator emulator(one.emulator + "&trace=" + trace.string());
      ASSERT_TRUE(becomes_attached(one.uri));
      const auto device = drivers::open_device(one.uri);
      int faults_before = 0;
      Status last = Status::ok;
      loop(*device, 400, [&](int tick, Status, const Sample&) {
        if (tick == 200) {
          for (const pid_t guard : guards()) kill(guard, SIGKILL);
        }
        last = device->write({0.0, 0.0, 1.0});
        faults_before += tick < 200 && last != Status::ok;
      });
      EXPECT_EQ(faults_before, 0);
      EXPECT_EQ(last, Status::fault);
    }
    EXPECT_TRUE(guards().empty()) << "nor is it left unburied";
    const auto told = read_told(one, trace);
    const Ends ends = ends_of(told);
    ASSERT_GE(ends.zero_s, 0.0);
    EXPECT_GT(told.back().time_s - ends.last_force_s, 0.15) << "zero long before the end";
  }
}

TEST(GuardLife, ARecordingShowsThatItHasDied) {
  const Guarded device = guarded().front();
  const TemporaryFolder folder;
  const Emulator emulator(device.emulator);
  ASSERT_TRUE(becomes_attached(device.uri));
  HeldWall recording(device, wall_of(device), folder, 2.0);
  rest_for(1.0);
  for (const pid_t guard : guards()) kill(guard, SIGKILL);
  const int status = recording.end();
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << read_text(folder / "said");
  const auto rows = schema::read_recording(folder / "wall.h5");
  std::size_t faults = 0;
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const bool fault = (rows.flags[row] & schema::flag_device_fault) != 0;
    faults += fault;
    EXPECT_TRUE(!fault || rows.force_commanded[3 * row + 2] == 0.0) << row;
    EXPECT_TRUE(fault || faults == 0) << "it stays so, " << row;
  }
  EXPECT_GT(faults, 500U);
  EXPECT_LT(faults, rows.rows());
}

}  // namespace
}  // namespace kerf::test
