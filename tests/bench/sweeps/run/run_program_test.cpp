// `kerf sweep run`: shards, workers, what stops it.

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
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

#include "bench/sweeps/swept.h"
#include "run/shard_lock.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using testing::HasSubstr;

class SweepRun : public test::SweepFolder {
 protected:
  /// Starts a run that hangs in a cell, and waits until it has answered those before.
  [[nodiscard]] pid_t start_hanging(const std::string& cell) const {
    std::vector<std::string> words{"/usr/bin/env", "KERF_SWEEP_FAULT=hang@" + cell, KERF_PROGRAM, "sweep",
                                   "run",          file("w.plan.json").string(),    "-j",         "1"};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t silent;
    posix_spawn_file_actions_init(&silent);
    for (const int stream : {1, 2})
      posix_spawn_file_actions_addopen(&silent, stream, "/dev/null", O_WRONLY, 0);
    pid_t process = 0;
    EXPECT_EQ(posix_spawn(&process, arguments[0], &silent, nullptr, arguments.data(), environ), 0);
    posix_spawn_file_actions_destroy(&silent);
    const auto partial = file("w.shards/0-of-1.shard.partial");
    std::error_code missing;
    while (fs::file_size(partial, missing) < 600 || missing)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return process;
  }
  static int ended(pid_t process) {
    int status = 0;
    ::waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
};

TEST_F(SweepRun, ThatIsCompleteIsOnlyLookedAt) {
  (void)plan_of(test::walls());
  const Outcome first = run_it({"-j", "1"});
  EXPECT_EQ(first.exit_status, 0) << first.errors;
  const auto made = fs::last_write_time(file("w.shards/0-of-1.shard"));
  const Outcome again = run_it({"--json"});
  EXPECT_EQ(again.exit_status, 0) << again.errors;
  EXPECT_EQ(nlohmann::json::parse(again.output).at("computed"), 0);
  EXPECT_EQ(fs::last_write_time(file("w.shards/0-of-1.shard")), made);
  EXPECT_EQ(std::distance(fs::directory_iterator(file("w.shards")), fs::directory_iterator()), 1);
}

TEST_F(SweepRun, TakesItsShardFromTheOptionOrFromSlurm) {
  (void)plan_of(test::walls("shards = 3\n"));
  EXPECT_EQ(run_it({"--shard", "1", "-j", "1"}).exit_status, 0);
  EXPECT_TRUE(fs::exists(file("w.shards/1-of-3.shard")));
  const std::string plan = file("w.plan.json").string();
  EXPECT_EQ(test::run({"/usr/bin/env", "SLURM_ARRAY_TASK_ID=2", "SLURM_ARRAY_TASK_COUNT=1", KERF_PROGRAM,
                       "sweep", "run", plan, "-j", "1"})
                .exit_status,
            0);
  EXPECT_TRUE(fs::exists(file("w.shards/2-of-3.shard")));
  EXPECT_THAT(run_it({"--shard", "3/3"}).errors,
              HasSubstr("there is no shard 3 of 3; they are counted from 0 to 2"));
  for (const char* wrong : {"x", "1/", "/3", "1/0", "-1/3", "1/3/5"})
    EXPECT_EQ(run_it({"--shard", wrong}).exit_status, 2) << wrong;
  const Outcome empty = run_it({"--shard", "1/50", "-j", "1"});
  EXPECT_EQ(empty.exit_status, 0) << empty.errors;
  EXPECT_TRUE(fs::exists(file("w.shards/1-of-50.shard"))) << "20 cells in 50 shards";
}

TEST_F(SweepRun, EndsWith75WhenItIsStoppedAndGoesOn) {
  for (const int signal : {SIGTERM, SIGUSR1}) {
    (void)plan_of(test::walls());
    fs::remove_all(file("w.shards"));
    const pid_t process = start_hanging("10");
    EXPECT_THAT(run_it().errors, HasSubstr("process " + std::to_string(process)));
    ::kill(process, signal);
    EXPECT_EQ(ended(process), 75);
    EXPECT_FALSE(fs::exists(file("w.shards/0-of-1.shard.lock")));
    const Outcome again = run_it({"--json", "-j", "1"});
    EXPECT_EQ(again.exit_status, 0) << again.errors;
    EXPECT_EQ(nlohmann::json::parse(again.output).at("computed"), 10);
  }
}

TEST_F(SweepRun, IsOneOfManyThatWereStartedAtOnce) {
  (void)plan_of(test::walls());
  ASSERT_EQ(run_it({"-j", "1", "-o", file("alone").string()}).exit_status, 0);
  const auto alone = merged("alone");
  std::array<Outcome, 6> all;
  {
    std::vector<std::jthread> starters;
    for (Outcome& one : all) starters.emplace_back([&] { one = run_it({"-j", "1", "--json"}); });
  }
  std::uint64_t computed = 0;
  for (const Outcome& one : all) {
    if (one.exit_status == 0) {
      computed += nlohmann::json::parse(one.output).at("computed").get<std::uint64_t>();
    } else {
      EXPECT_EQ(one.exit_status, 2);
      EXPECT_THAT(one.errors, HasSubstr("computes this shard; wait until it ends"));
      EXPECT_EQ(std::count(one.errors.begin(), one.errors.end(), '\n'), 1) << one.errors;
    }
  }
  EXPECT_EQ(computed, 20U) << "each cell by one of them";
  EXPECT_EQ(merged(), alone);
  EXPECT_EQ(std::distance(fs::directory_iterator(file("w.shards")), fs::directory_iterator()), 1)
      << "no lock and no partial file is left";
}

TEST_F(SweepRun, TakesOverFromOneThatWasKilled) {
  (void)plan_of(test::walls());
  const pid_t process = start_hanging("10");
  ::kill(process, SIGKILL);
  EXPECT_EQ(ended(process), 128 + SIGKILL);
  const Outcome again = run_it({"-j", "1"});
  EXPECT_EQ(again.exit_status, 0) << again.errors;
  EXPECT_THAT(again.errors, HasSubstr("left it behind"));
}

TEST_F(SweepRun, RefusesRecordingsThatAreNotWhatTheyWere) {
  (void)fits(2);
  schema::write_recording(file("r.h5"), test::punch({.seconds = 2.0, .seed = 3}));
  const Outcome changed = run_it();
  EXPECT_EQ(changed.exit_status, 2);
  EXPECT_THAT(changed.errors, HasSubstr("r.h5: it is not the file that was planned with"));
  fs::remove(file("r.h5"));
  const Outcome gone = run_it();
  EXPECT_EQ(gone.exit_status, 2);
  EXPECT_THAT(gone.errors, HasSubstr("r.h5: "));
  EXPECT_EQ(std::count(gone.errors.begin(), gone.errors.end(), '\n'), 1) << gone.errors;
  EXPECT_FALSE(fs::exists(file("w.shards/0-of-1.shard.partial"))) << "nothing was begun";
}

TEST_F(SweepRun, RefusesShardsOfAPlanThatWasChangedSince) {
  (void)plan_of(test::walls());
  EXPECT_EQ(run_it({"-j", "1"}).exit_status, 0);
  (void)plan_of(test::walls() + "damping = 1\n");
  const Outcome outcome = run_it();
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("it is of another plan"));
}

TEST_F(SweepRun, PlanTellsWhatItWillTake) {
  test::write_text(file("w.toml"), test::walls());
  const Outcome plan = sweep({"plan", file("w.toml").string(), "--json"});
  ASSERT_EQ(plan.exit_status, 0) << plan.errors;
  const auto told = nlohmann::json::parse(plan.output);
  EXPECT_EQ(told.at("cells"), 20);
  EXPECT_EQ(told.at("shards"), 1);
  EXPECT_GT(told.at("cell_s").get<double>(), 0.0);
  EXPECT_GT(told.at("worker_bytes").get<double>(), 1e6);
  EXPECT_EQ(sweep({"plan", file("w.toml").string()}).exit_status, 2) << "it is there";
  const Outcome list = sweep({"plan", file("w.toml").string(), "--list"});
  EXPECT_EQ(std::count(list.output.begin(), list.output.end(), '\n'), 21);
  EXPECT_THAT(list.output, HasSubstr("cell,name,mass,"));
}

}  // namespace
}  // namespace kerf::bench
