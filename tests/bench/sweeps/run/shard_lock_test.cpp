#include "run/shard_lock.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

class ShardLocked : public testing::Test {
 protected:
  [[nodiscard]] std::string refusal(const ShardLock::Options& options = {
                                        .silence = milliseconds(300)}) const {
    try {
      const ShardLock lock(place_, guarded_, options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }
  /// As a run left it that ended without a word.
  void leave_behind(const LockHolder& holder) const {
    test::write_text(ShardLock::path_of(place_), holder.as_text());
  }

  test::TemporaryFolder folder_;
  fs::path place_ = folder_ / "0-of-1.shard";
  fs::path guarded_ = folder_ / "0-of-1.shard.partial";
};

TEST_F(ShardLocked, IsForOneAndSaysForWhom) {
  {
    const ShardLock lock(place_, guarded_, {});
    const std::string why = refusal();
    EXPECT_NE(why.find("process " + std::to_string(::getpid())), std::string::npos) << why;
    EXPECT_EQ(std::count(why.begin(), why.end(), '\n'), 0);
    EXPECT_EQ(ShardLock::holder_of(place_).process, ::getpid());
  }
  EXPECT_EQ(ShardLock::holder_of(place_).host, "") << "it is given back";
  EXPECT_EQ(refusal(), "");
}

TEST_F(ShardLocked, IsTakenFromAProcessThatIsGone) {
  LockHolder gone;
  {
    const ShardLock lock(place_, guarded_, {});
    gone = ShardLock::holder_of(place_);
  }
  gone.started = "1";  // the number was given anew since
  leave_behind(gone);
  std::string told;
  const ShardLock lock(place_, guarded_, {.tell = [&](const std::string& line) { told += line; }});
  EXPECT_NE(told.find("left it behind"), std::string::npos);
}

TEST_F(ShardLocked, StaysWithAProcessThatLivesAlsoWhereFilesHaveNoLocks) {
  LockHolder living;
  {
    const ShardLock lock(place_, guarded_, {});
    living = ShardLock::holder_of(place_);
  }
  leave_behind(living);
  fs::remove(guarded_);
  EXPECT_NE(refusal().find("process " + std::to_string(::getpid())), std::string::npos);
  EXPECT_FALSE(fs::exists(guarded_)) << "who is refused makes none";
}

const LockHolder elsewhere{.host = "node7", .boot = "another", .process = 4711, .started = "5"};

TEST_F(ShardLocked, IsTakenFromAnotherMachineThatGivesNoSignOfLife) {
  leave_behind(elsewhere);
  std::string told;
  const ShardLock lock(place_, guarded_, {.silence = milliseconds(150), .tell = [&](const std::string& line) {
                                            told += line;
                                          }});
  EXPECT_NE(told.find("process 4711 on node7"), std::string::npos) << told;
}

TEST_F(ShardLocked, StaysWithAnotherMachineThatCountsOn) {
  leave_behind(elsewhere);
  std::atomic<bool> end{false};
  std::jthread holder([&] {
    LockHolder now = elsewhere;
    for (; !end; std::this_thread::sleep_for(milliseconds(20))) {
      ++now.beat;
      const fs::path next = folder_ / "next";
      test::write_text(next, now.as_text());
      fs::rename(next, ShardLock::path_of(place_));
    }
  });
  const std::string why = refusal({.silence = milliseconds(20'000)});
  end = true;
  EXPECT_NE(why.find("process 4711 on node7"), std::string::npos) << why;
}

TEST_F(ShardLocked, AsksNoClockOfAnotherMachine) {
  for (const auto skew : {std::chrono::hours(-24 * 365), std::chrono::hours(24 * 365)}) {
    const auto set = [&](const fs::path& file) {
      fs::last_write_time(file, fs::file_time_type::clock::now() + skew);
    };
    leave_behind(elsewhere);
    set(ShardLock::path_of(place_));
    std::string told;
    const auto take = [&] {
      const ShardLock lock(
          place_, guarded_,
          {.silence = milliseconds(150), .tell = [&](const std::string& line) { told += line; }});
    };
    EXPECT_NO_THROW(take()) << "silent, whatever time its file is of";
    EXPECT_NE(told.find("left it behind"), std::string::npos) << told;
    leave_behind(elsewhere);
    std::atomic<bool> end{false};
    std::jthread holder([&] {
      LockHolder now = elsewhere;
      for (; !end; std::this_thread::sleep_for(milliseconds(20))) {
        ++now.beat;
        test::write_text(folder_ / "next", now.as_text());
        set(folder_ / "next");
        fs::rename(folder_ / "next", ShardLock::path_of(place_));
      }
    });
    EXPECT_NE(refusal({.silence = milliseconds(20'000)}), "") << "alive, whatever time its file is of";
    end = true;
    holder.join();
    fs::remove(ShardLock::path_of(place_));
  }
}

TEST_F(ShardLocked, IsNotedAsLostWhereSomebodyElseTookIt) {
  ShardLock lock(place_, guarded_, {.beat = milliseconds(0)});
  EXPECT_NO_THROW(lock.keep());
  fs::remove(ShardLock::path_of(place_));
  leave_behind(elsewhere);
  EXPECT_THROW(lock.keep(), std::system_error);
}

TEST_F(ShardLocked, LeavesNothingBehind) {
  { const ShardLock lock(place_, guarded_, {}); }
  fs::remove(guarded_);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

}  // namespace
}  // namespace kerf::bench
