#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <random>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/live_recording.h>
#include <kerf/schema/recording.h>
#include <kerf/schema/validate.h>

#include "support/kelvin_law.h"
#include "support/program.h"

// What the bench promises of its loop and of its recordings, proved on the program itself.

namespace kerf {
namespace {

using test::Outcome;
using test::TemporaryFolder;
using testing::HasSubstr;

TEST(VirtualTime, GivesTheSameSamplesToTheLastBit) {
  const TemporaryFolder folder;
  for (const auto* name : {"a.h5", "b.h5"}) {
    ASSERT_EQ(test::run_kerf({"record", "--virtual", "--seconds", "60", "-o", folder / name}).exit_status, 0);
  }
  const schema::Recording a = schema::read_recording(folder / "a.h5");
  const schema::Recording b = schema::read_recording(folder / "b.h5");
  ASSERT_EQ(a.rows(), 60'000U);
  const auto same = [](const auto& left, const auto& right) {
    return left.size() == right.size() &&
           std::memcmp(left.data(), right.data(), left.size() * sizeof left[0]) == 0;
  };
  EXPECT_TRUE(same(a.time, b.time));
  EXPECT_TRUE(same(a.tick, b.tick));
  EXPECT_TRUE(same(a.position, b.position));
  EXPECT_TRUE(same(a.velocity, b.velocity));
  EXPECT_TRUE(same(a.force_commanded, b.force_commanded));
  EXPECT_TRUE(same(a.force_measured, b.force_measured));
  EXPECT_TRUE(same(a.wake_latency, b.wake_latency));
  EXPECT_TRUE(same(a.compute_time, b.compute_time));
  EXPECT_TRUE(same(a.flags, b.flags));
}

/// System calls of the thread that sleeps most often, between the sleep of that number and its last, out of
/// what `strace -f` wrote.
struct Calls {
  std::map<std::string, int> by_name;
  int all = 0;
};
Calls calls_of_the_busiest_sleeper(const std::string& trace, int from) {
  struct Thread {
    std::vector<std::string> calls;
    std::size_t first_sleep = 0;
    std::size_t last_sleep = 0;
    int sleeps = 0;
  };
  std::map<std::string, Thread> threads;
  std::istringstream lines(trace);
  std::string line;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string id;
    std::string call;
    words >> id >> call;
    const auto bracket = call.find('(');
    if (bracket == std::string::npos) continue;  // the end of a call that another one came between
    Thread& thread = threads[id];
    thread.calls.push_back(call.substr(0, bracket));
    if (thread.calls.back() != "clock_nanosleep") continue;
    if (++thread.sleeps == from) thread.first_sleep = thread.calls.size();
    thread.last_sleep = thread.calls.size();
  }
  Calls found;
  const auto busiest =
      std::ranges::max_element(threads, {}, [](const auto& entry) { return entry.second.sleeps; });
  if (busiest == threads.end()) return found;
  const Thread& thread = busiest->second;
  for (std::size_t i = thread.first_sleep; i < thread.last_sleep; ++i) {
    ++found.by_name[thread.calls[i]];
    ++found.all;
  }
  return found;
}

TEST(Tick, MakesAtMostFourSystemCallsWithTheSleep) {
  const TemporaryFolder folder;
  const std::string trace = folder / "trace";
  if (test::run({"sh", "-c", "command -v strace && strace -o /dev/null true"}).exit_status != 0) {
    GTEST_SKIP() << "strace is missing, or may not trace here";
  }
  // A leak sanitizer, where there is one, cannot work in a traced program.
  const Outcome outcome =
      test::run({"env", "ASAN_OPTIONS=detect_leaks=0", "strace", "-f", "-o", trace, KERF_PROGRAM, "record",
                 "--seconds", "2", "--rate", "500", "-o", folder / "r.h5"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  // After the sleeps that the loop learns from, and the first tick, where sanitizers look at memory by system
  // calls.
  constexpr int second_tick = 200 + 3;
  const Calls calls = calls_of_the_busiest_sleeper(test::read_text(trace), second_tick);
  const auto ticks = static_cast<double>(schema::read_recording(folder / "r.h5").rows());
  const double late = 1000.0 - ticks;  // deadlines, at most as many late ticks, in which more is asked
  const int sleeps = calls.by_name.at("clock_nanosleep");
  EXPECT_GE(sleeps, 0.9 * ticks - late) << "a late tick may find its deadline passed";
  EXPECT_LE(calls.all, 4.0 * ticks + 5.0 * late)
      << "between two ticks the sleep, and a look at what the thread has used "
         "and at its processor time; within every second tick two at the latter";
  for (const auto& [name, count] : calls.by_name) {
    if (name == "clock_nanosleep" || name == "clock_gettime" || name == "getrusage") continue;
    EXPECT_LE(count, 10) << name;
  }
}

/// Starts the program and gives its process to a test, which has to end it.
pid_t start_kerf(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), KERF_PROGRAM);
  std::vector<char*> words;
  for (auto& word : arguments) words.push_back(word.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {1, 2})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  posix_spawn(&child, words[0], &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return child;
}

void kill_and_wait(pid_t child) {
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
}

/// Checks what a killed program left, and closes it; returns the rows.
std::size_t expect_sound_and_repair(const std::filesystem::path& file) {
  std::filesystem::path partial = file;
  partial += ".partial";
  EXPECT_THAT(schema::validate(partial), testing::IsEmpty());
  const std::size_t rows = schema::read_recording(partial).rows();
  EXPECT_EQ(test::run_kerf({"repair", file}).exit_status, 0);
  EXPECT_THAT(schema::validate(file), testing::IsEmpty());
  const schema::Recording closed = schema::read_recording(file);
  EXPECT_EQ(closed.rows(), rows);
  for (std::size_t row = 1; row < closed.rows(); ++row) {
    EXPECT_GT(closed.tick[row], closed.tick[row - 1]);
    if (closed.tick[row] <= closed.tick[row - 1]) break;
  }
  return rows;
}

// In virtual time the writer is never at rest, so that the kill meets it in the middle of something.
TEST(KilledRecording, IsSoundWheneverItWasKilled) {
  std::mt19937 random(1);
  std::size_t with_rows = 0;
  for (int attempt = 0; attempt < 30; ++attempt) {
    const TemporaryFolder folder;
    const pid_t child = start_kerf({"record", "--virtual", "--seconds", "1000", "-o", folder / "r.h5"});
    // From the moment at which the file is there to some thousands of rows later.
    const std::uintmax_t size = random() % 6'000'000;
    std::error_code none_yet;
    while (!(std::filesystem::file_size(folder / "r.h5.partial", none_yet) >= size) || none_yet) {
    }
    kill_and_wait(child);
    with_rows += expect_sound_and_repair(folder / "r.h5") > 0 ? 1 : 0;
  }
  EXPECT_GE(with_rows, 10U);
}

TEST(KilledRecording, HoldsEveryRowThatAFollowerHadSeen) {
  const TemporaryFolder folder;
  const pid_t child = start_kerf({"record", "--seconds", "60", "-o", folder / "r.h5"});
  std::uint64_t seen = 0;
  while (seen < 500) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (std::filesystem::exists(folder / "r.h5.partial"))
      seen = schema::read_tail(folder / "r.h5.partial").rows;
  }
  kill_and_wait(child);
  EXPECT_GE(expect_sound_and_repair(folder / "r.h5"), seen);
}

/// A record of a law that pushes all the time, to which a signal comes at 600 rows and SIGCONT a while later.
schema::Recording stopped_by(int signal) {
  const TemporaryFolder folder;
  test::write_text(folder / "k.law.toml", test::kelvin_law);
  const pid_t child =
      start_kerf({"record", "--seconds", "3", "--law", folder / "k.law.toml", "-o", folder / "r.h5"});
  std::uint64_t seen = 0;
  while (seen < 600) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (std::filesystem::exists(folder / "r.h5.partial"))
      seen = schema::read_tail(folder / "r.h5.partial").rows;
  }
  kill(child, signal);
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, WUNTRACED), child);
  EXPECT_TRUE(WIFSTOPPED(status));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  kill(child, SIGCONT);
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  return schema::read_recording(folder / "r.h5");
}

/// The row after the longest gap in time.
std::size_t row_after_the_gap(const schema::Recording& recording) {
  std::size_t longest = 1;
  for (std::size_t row = 1; row < recording.rows(); ++row) {
    if (recording.tick[row] - recording.tick[row - 1] > recording.tick[longest] - recording.tick[longest - 1])
      longest = row;
  }
  return longest;
}

std::string stall_told_at(const schema::Recording& recording, std::size_t row) {
  for (const schema::Event& event : recording.events) {
    if (event.kind == "stall" && std::abs(event.time_s - recording.time[row]) < 0.1) return event.text;
  }
  return "";
}

TEST(StoppedProcess, HasGivenZeroForceWhereItCould) {
  const schema::Recording recording = stopped_by(SIGTSTP);
  const std::size_t row = row_after_the_gap(recording);
  ASSERT_GT(recording.tick[row] - recording.tick[row - 1], 400U);
  EXPECT_EQ(recording.force_commanded[2 * (row - 1)], 0.0) << "before it stopped";
  EXPECT_EQ(recording.force_commanded[2 * row], 0.0) << "and when it went on";
  EXPECT_THAT(stall_told_at(recording, row), HasSubstr("after zero force"));
}

TEST(StoppedProcess, SaysThatNobodyReleasedTheDeviceInTime) {
  const schema::Recording recording = stopped_by(SIGSTOP);
  const std::size_t row = row_after_the_gap(recording);
  ASSERT_GT(recording.tick[row] - recording.tick[row - 1], 400U);
  EXPECT_EQ(recording.force_commanded[2 * row], 0.0);
  const std::string told = stall_told_at(recording, row);
  EXPECT_THAT(told, HasSubstr("the loop was silent for"));
  EXPECT_THAT(
      told, testing::AnyOf(HasSubstr("nobody released the device"), testing::ContainsRegex("after 0\\.[4-9]"),
                           testing::ContainsRegex("after [1-9]")))
      << "and not that the watchdog did after 10 ms";
}

TEST(Recording, IsNeverMadeTwiceAtOnce) {
  const TemporaryFolder folder;
  const pid_t child = start_kerf({"record", "--seconds", "60", "-o", folder / "r.h5"});
  while (!std::filesystem::exists(folder / "r.h5.partial") ||
         !schema::find_recording(folder / "r.h5").being_written) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const Outcome second =
      test::run_kerf({"record", "--virtual", "--seconds", "1", "-o", folder / "r.h5", "--force"});
  EXPECT_EQ(second.exit_status, 2);
  EXPECT_THAT(second.errors, HasSubstr("is being recorded by another process"));
  const Outcome repair = test::run_kerf({"repair", folder / "r.h5"});
  EXPECT_EQ(repair.exit_status, 2);
  EXPECT_THAT(repair.errors, HasSubstr("is still being recorded"));
  kill_and_wait(child);
}

TEST(FollowedRecording, IsShownUntilItIsClosed) {
  const TemporaryFolder folder;
  const Outcome outcome = test::run({"sh", "-c",
                                     R"("$1" record --seconds 1.5 -o "$2" 2>/dev/null & child=$!
          while ! [ -e "$2.partial" ]; do sleep 0.02; done
          "$1" info --follow "$2"; status=$?; wait $child; exit $status)",
                                     "sh", KERF_PROGRAM, folder / "r.h5"});
  EXPECT_EQ(outcome.exit_status, 0);
  EXPECT_THAT(outcome.errors, HasSubstr("samples  theta"));
  EXPECT_THAT(outcome.output, HasSubstr("status      complete")) << "and then summed up";
}

TEST(FullDisk, LetsTheLoopGoOnAndKeepsWhatFitted) {
  if (test::run({"unshare", "-rm", "true"}).exit_status != 0) {
    GTEST_SKIP() << "no name spaces for users here, so no small disk of its own";
  }
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "disk");
  test::write_text(folder / "k.law.toml", test::kelvin_law);
  // The disk lives as long as the shell's name space: what is left on it is looked at there.
  const Outcome outcome = test::run({"unshare", "-rm", "sh", "-c",
                                     R"sh(mount -t tmpfs -o size=80M none "$2/disk" || exit 77
          "$1" check "$2/k.law.toml" --virtual --seconds 600 --record "$2/disk/r.h5" --json & check=$!
          # Stopped, lest it be quicker than who fills the disk, once rows are on it and not only in its buffers.
          until kill -STOP $check && sleep 0.01 && "$1" info "$2/disk/r.h5.partial" --json |
                grep -Eq '"samples": *[0-9]{5}'; do
            kill -CONT $check || break
            sleep 0.03
          done 2>/dev/null
          head -c 100M /dev/zero 2>/dev/null > "$2/disk/of-somebody-else"
          kill -CONT $check
          wait $check; status=$?
          ls "$2/disk" >&2
          "$1" validate "$2/disk/r.h5.partial" >&2 && "$1" repair "$2/disk/r.h5" -o "$2/r.h5" || exit 99
          exit $status)sh",
                                     "sh", KERF_PROGRAM, folder.path().string()});
  if (outcome.exit_status == 77) GTEST_SKIP() << "no small disk may be mounted here";
  EXPECT_EQ(outcome.exit_status, 4) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("\"executed\": 600000")) << "the loop went on";
  EXPECT_THAT(outcome.errors, HasSubstr("No space left on device; the loop goes on"));
  EXPECT_THAT(outcome.errors, HasSubstr("'kerf repair' closes it"));
  const schema::Recording recording = schema::read_recording(folder / "r.h5");
  EXPECT_GT(recording.rows(), 1000U);
  EXPECT_LT(recording.rows(), 600'000U);
}

}  // namespace
}  // namespace kerf
