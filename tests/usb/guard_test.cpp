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
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/drivers/device.h>
#include <kerf/mechanisms/woodenhaptics.h>

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

/// How often the motors were turned on, and for how long the last force stood after the last order that gave
/// one.
struct Ends {
  double last_force_s = -1.0;
  double zero_s = -1.0;
  bool stays_zero = false;
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
  ends.stays_zero = ends.zero_s >= 0.0;
  return ends;
}

/// `kerf record` of a wall, while the object lives.
class HeldWall {
 public:
  HeldWall(const Guarded& device, const TemporaryFolder& folder, double seconds) {
    write_text(folder / "wall.law.toml", wall_below(device.wall_m, "1"));
    std::vector<std::string> words{KERF_PROGRAM,      "record",
                                   "--device",        device.uri,
                                   "--law",           folder / "wall.law.toml",
                                   "--seconds",       std::to_string(seconds),
                                   "--force",         "-o",
                                   folder / "wall.h5"};
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

/// Processes named kerf-guard that run; with `parent` only its children.
std::vector<pid_t> guards(pid_t parent = 0) {
  std::vector<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string stat = read_text(entry.path() / "stat");
    const auto at = stat.find("(kerf-guard) ");
    if (at == std::string::npos) continue;
    std::istringstream words(stat.substr(at + 13));
    char state = 0;
    pid_t of = 0;
    words >> state >> of;
    if (state != 'Z' && (parent == 0 || of == parent)) found.push_back(std::stoi(stat));
  }
  return found;
}

void rest_for(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

/// Holds the wall, does something to the program after 2 s, and looks 2 s later at what the motors were told.
template <typename F>
Ends ends_after(const Guarded& device, F act) {
  const TemporaryFolder folder;
  const auto trace = folder / "trace.csv";
  {
    const Emulator emulator(device.emulator + "&trace=" + trace.string());
    EXPECT_TRUE(becomes_attached(device.uri));
    HeldWall recording(device, folder, 60.0);
    rest_for(2.0);
    EXPECT_EQ(guards().size(), 1U) << read_text(folder / "said");
    act(recording);
    rest_for(0.4);  // less than the watchdog of a WoodenHaptics
  }
  EXPECT_TRUE(guards().empty());
  return ends_of(read_told(device, trace));
}

void expect_let_go(const Guarded& device, const char* signal, const Ends& ends) {
  ASSERT_GE(ends.last_force_s, 1.0) << "the wall was held";
  ASSERT_TRUE(ends.stays_zero) << "the motors were not let go";
  std::printf("%s %s: zero %.3f ms after the last force\n", device.name.c_str(), signal,
              1e3 * (ends.zero_s - ends.last_force_s));
  EXPECT_LE(ends.zero_s - ends.last_force_s, 0.05);
}

TEST(Guard, LetsGoWhenTheProgramDies) {
  struct Death {
    int number;
    const char* name;
  };
  for (const Guarded& device : guarded()) {
    for (const Death& death :
         {Death{SIGKILL, "SIGKILL"}, Death{SIGSEGV, "SIGSEGV"}, Death{SIGABRT, "SIGABRT"}}) {
      SCOPED_TRACE(device.name + " " + death.name);
      expect_let_go(device, death.name, ends_after(device, [&](HeldWall& recording) {
                      recording.signal(death.number);
                      EXPECT_EQ(WTERMSIG(recording.end()), death.number);
                    }));
    }
  }
}

TEST(Guard, LetsGoWhenTheProgramIsStopped) {
  for (const Guarded& device : guarded()) {
    SCOPED_TRACE(device.name);
    expect_let_go(device, "SIGSTOP", ends_after(device, [](HeldWall& recording) {
                    recording.signal(SIGSTOP);
                    rest_for(0.4);
                    // From here on the guard is to be gone too.
                    recording.signal(SIGKILL);
                    (void)recording.end();
                  }));
  }
}

TEST(Guard, ComesToAnEndWithTheProgram) {
  for (const Guarded& device : guarded()) {
    SCOPED_TRACE(device.name);
    expect_let_go(device, "SIGTERM", ends_after(device, [](HeldWall& recording) {
                    recording.signal(SIGTERM);
                    const int status = recording.end();
                    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
                  }));
  }
}

}  // namespace
}  // namespace kerf::test
