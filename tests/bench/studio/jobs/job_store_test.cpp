#include "jobs/job_store.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "bench/studio/jobs/finished_jobs.h"
#include "jobs/jobs.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using test::ended_job;
using test::TemporaryFolder;
using testing::HasSubstr;

/// Jobs that end when they are told to, of a studio that keeps them in a folder.
class KeptJobs : public testing::Test {
 protected:
  [[nodiscard]] JobOrder says(const std::string& text) {
    return {.kind = "fit",
            .title = "Fit of cut.h5",
            .work =
                [text](JobProgress& progress) {
                  progress.log(text);
                  return JobEnd("result", "did not pass");
                },
            .outputs = {"cut.fit"},
            .again = {.path = "/api/fit", .body = {{"recording", "1f"}}}};
  }
  [[nodiscard]] JobOrder waits() {
    return {.kind = "chart", .title = "Chart", .work = [this](JobProgress& progress) {
              is_running_ = true;
              while (!progress.stop || is_deaf_) std::this_thread::yield();
              throw std::runtime_error("left half-way");
              return JobEnd("");
            }};
  }
  [[nodiscard]] fs::path jobs() const { return folder_ / "jobs"; }

  TemporaryFolder folder_;
  std::atomic<bool> is_running_{false};
  std::atomic<bool> is_deaf_{false};  ///< the work has not yet heard that it is to stop
};

TEST_F(KeptJobs, OutliveTheStudio) {
  std::size_t job = 0;
  nlohmann::ordered_json before;
  {
    Jobs first(jobs());
    EXPECT_FALSE(fs::exists(jobs())) << "a studio without jobs leaves nothing in the lab's folder";
    job = first.add(says("a line\n"));
    before = ended_job(first, job);
  }
  Jobs second(jobs());
  EXPECT_EQ(ended_job(second, job), before);
  EXPECT_EQ(before["state"], "done");
  EXPECT_EQ(before["outcome"], "did not pass");
  EXPECT_EQ(before["outputs"], nlohmann::ordered_json::array({"cut.fit"}));
  EXPECT_EQ(before["again"]["body"]["recording"], "1f");
  EXPECT_EQ(before["not_kept"], "");
  EXPECT_EQ(second.log_of(job), "a line\n");
  EXPECT_EQ(second.add(says("")), job + 1) << "numbers go on";
}

TEST_F(KeptJobs, WhatRanWhenTheStudioEndedIsInterrupted) {
  {
    Jobs first(jobs());
    (void)first.add(waits());
    (void)first.add(says("never"));
    while (!is_running_) std::this_thread::yield();
    // As kill -9 leaves it: what was written when it began.
    fs::copy(jobs(), folder_ / "killed", fs::copy_options::recursive);
  }
  for (const fs::path& left : {jobs(), folder_ / "killed"}) {
    Jobs second(left);
    EXPECT_EQ(ended_job(second, 1)["state"], "interrupted") << left;
    EXPECT_EQ(ended_job(second, 2)["state"], "interrupted") << left << ": it had not begun";
  }
}

TEST_F(KeptJobs, WhatSomebodyStoppedIsStoppedWhateverEndedTheStudioMeanwhile) {
  {
    Jobs first(jobs());
    const std::size_t job = first.add(waits());
    while (!is_running_) std::this_thread::yield();
    is_deaf_ = true;
    first.stop(job);
    fs::copy(jobs(), folder_ / "killed", fs::copy_options::recursive);
    first.close();
    is_deaf_ = false;
  }
  for (const fs::path& left : {jobs(), folder_ / "killed"}) {
    Jobs second(left);
    EXPECT_EQ(ended_job(second, 1)["state"], "stopped") << left;
  }
}

TEST_F(KeptJobs, AreForgottenOnDiskToo) {
  Jobs jobs_of_studio(jobs());
  for (int i = 0; i < 60; ++i) (void)ended_job(jobs_of_studio, jobs_of_studio.add(says("a line\n")));
  // The last is written after the list tells its end: another one has to have been through.
  const auto records = [&] {
    return std::count_if(fs::directory_iterator(jobs()), {}, [](const fs::directory_entry& entry) {
      return entry.path().extension() == ".json";
    });
  };
  while (records() > 50) std::this_thread::yield();
  EXPECT_EQ(records(), 50);
  jobs_of_studio.forget(60);
  EXPECT_FALSE(fs::exists(jobs() / "60.json"));
  EXPECT_FALSE(fs::exists(jobs() / "60.log"));
  EXPECT_THROW((void)jobs_of_studio.log_of(60), RequestError);
  const std::size_t running = jobs_of_studio.add(waits());
  EXPECT_THROW(jobs_of_studio.forget(running), RequestError);
}

TEST_F(KeptJobs, ARecordThatCannotBeReadIsShownWithTheReason) {
  fs::create_directories(jobs());
  test::write_text(jobs() / "7.json", R"({"format":1,"job":)");
  test::write_text(jobs() / "8.json", R"({"format":2})");
  test::write_text(jobs() / "notes.json", "not a job's");
  Jobs studio(jobs());
  const auto list = studio.list();
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[1]["state"], "failed");
  EXPECT_THAT(list[1]["error"], HasSubstr("its record cannot be read"));
  EXPECT_THAT(list[0]["error"], HasSubstr("a later version"));
  EXPECT_EQ(studio.add(says("")), 9U);
}

TEST_F(KeptJobs, ASecondStudioOfTheFolderKeepsNoneAndSaysSo) {
  Jobs first(jobs());
  (void)ended_job(first, first.add(says("")));
  Jobs second(jobs());
  EXPECT_TRUE(second.list().empty()) << "what is another's is not shown as interrupted";
  const auto job = ended_job(second, second.add(says("")));
  EXPECT_EQ(job["state"], "done");
  EXPECT_THAT(job["not_kept"], HasSubstr("another studio works in this folder"));
}

/// No file of this process grows beyond so much: as on a full disk, but that it is another error.
class FullDisk {
 public:
  FullDisk() {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit none{.rlim_cur = 0, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &none);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST_F(KeptJobs, OnAFullDiskTheWorkGoesOnAndItIsSaid) {
  Jobs studio(jobs());
  (void)ended_job(studio, studio.add(says("")));
  std::size_t job = 0;
  {
    const FullDisk full;
    job = studio.add(says("a line\n"));
    const auto told = ended_job(studio, job);
    EXPECT_EQ(told["state"], "done");
    EXPECT_NE(told["not_kept"], "");
    EXPECT_EQ(studio.log_of(job), "a line\n") << "of memory";
  }
  EXPECT_FALSE(fs::exists(jobs() / "2.json")) << "no half record";
  const auto next = ended_job(studio, studio.add(says("")));
  EXPECT_EQ(next["state"], "done");
}

TEST_F(KeptJobs, AClockThatIsSetChangesNoDuration) {
  std::chrono::system_clock::time_point wall{std::chrono::seconds(1'800'000'000)};
  std::chrono::steady_clock::time_point steady{};
  Jobs studio({}, {.wall = [&] { return wall; }, .steady = [&] { return steady; }});
  const std::size_t job = studio.add({.kind = "fit", .title = "Fit", .work = [&](JobProgress&) {
                                        wall -= std::chrono::hours(1);
                                        steady += std::chrono::seconds(30);
                                        return JobEnd("");
                                      }});
  const auto told = ended_job(studio, job);
  EXPECT_EQ(told["created"], "2027-01-15T08:00:00Z");
  EXPECT_EQ(told["seconds"], 30.0);
  EXPECT_EQ(told["clock_set_s"], -3630.0);
}

TEST_F(KeptJobs, ALongLogIsCutOffAndSaysSo) {
  std::size_t job = 0;
  {
    Jobs studio(jobs());
    job = studio.add({.kind = "fit", .title = "Fit", .work = [](JobProgress& progress) {
                        const std::string line(100'000, 'x');
                        for (int i = 0; i < 4; ++i) progress.log(line);
                        return JobEnd("");
                      }});
    (void)ended_job(studio, job);
  }
  Jobs next(jobs());
  const std::string log = next.log_of(job);
  EXPECT_LE(log.size(), JobStore::longest_log + 100);
  EXPECT_TRUE(log.ends_with("the rest is left out.\n"));
}

}  // namespace
}  // namespace kerf::bench
