#include "jobs/jobs.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "bench/studio/jobs/finished_jobs.h"

namespace kerf::bench {
namespace {

using test::ended_job;
using testing::ElementsAre;

JobOrder quick(std::function<void()> what, const std::string& title = "quick") {
  return {.kind = "fit", .title = title, .work = [what = std::move(what)](JobProgress&) {
            what();
            return std::string("file");
          }};
}

/// Works until it is told to go on, or stopped.
JobOrder waiting_for(std::atomic<bool>& go) {
  return {.kind = "fit", .title = "waiting", .steps = 4, .work = [&go](JobProgress& progress) {
            progress.done = 1;
            while (!go && !progress.stop) std::this_thread::yield();
            if (progress.stop) throw std::runtime_error("left half-way");
            return std::string("file");
          }};
}

std::string state_of(const Jobs& jobs, std::size_t number) {
  for (const auto& job : jobs.list()) {
    if (job["job"] == number) return job["state"];
  }
  return "forgotten";
}

TEST(StudioJobs, RunInOrderAndOneAtATime) {
  Jobs jobs;
  std::vector<int> order;
  std::atomic<int> at_work{0};
  int most = 0;
  std::size_t last = 0;
  for (int i = 0; i < 5; ++i) {
    last = jobs.add(quick([&, i] {
      most = std::max(most, ++at_work);
      order.push_back(i);
      --at_work;
    }));
  }
  const auto job = ended_job(jobs, last);
  EXPECT_THAT(order, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(most, 1);
  EXPECT_EQ(job["state"], "done");
  EXPECT_EQ(job["file"], "file");
  EXPECT_EQ(job["share"], 1.0);
}

TEST(StudioJobs, OneThatFailsSaysWhyAndTheNextRuns) {
  Jobs jobs;
  const std::size_t bad = jobs.add(quick([] { throw std::invalid_argument("there is no force in it"); }));
  const std::size_t odd = jobs.add(quick([] { throw 7; }));
  const std::size_t good = jobs.add(quick([] {}));
  EXPECT_EQ(ended_job(jobs, good)["state"], "done");
  EXPECT_EQ(ended_job(jobs, bad)["state"], "failed");
  EXPECT_EQ(ended_job(jobs, bad)["error"], "there is no force in it");
  EXPECT_EQ(ended_job(jobs, odd)["state"], "failed");
  EXPECT_NE(ended_job(jobs, odd)["error"], "");
}

TEST(StudioJobs, StopWhereTheyAreAndBeforeTheyBegin) {
  std::atomic<bool> go{false};
  bool ran = false;
  Jobs jobs;
  const std::size_t running = jobs.add(waiting_for(go));
  const std::size_t waiting = jobs.add(quick([&] { ran = true; }));
  while (state_of(jobs, running) != "running") std::this_thread::yield();
  while (jobs.list().back()["share"] == 0.0) std::this_thread::yield();
  EXPECT_EQ(jobs.list().back()["share"], 0.25);
  jobs.stop(waiting);
  EXPECT_EQ(state_of(jobs, waiting), "stopped");
  jobs.stop(running);
  const auto job = ended_job(jobs, running);
  EXPECT_EQ(job["state"], "stopped");
  EXPECT_EQ(job["error"], "") << "what is thrown on the way out is nobody's concern";
  EXPECT_EQ(ended_job(jobs, jobs.add(quick([] {})))["state"], "done");
  EXPECT_FALSE(ran);
  jobs.stop(4711);
}

TEST(StudioJobs, EndWithTheStudio) {
  std::atomic<bool> go{false};
  bool ran = false;
  {
    Jobs jobs;
    const std::size_t running = jobs.add(waiting_for(go));
    (void)jobs.add(quick([&] { ran = true; }));
    while (state_of(jobs, running) != "running") std::this_thread::yield();
  }
  EXPECT_FALSE(ran);
}

TEST(StudioJobs, NoMoreThanTwentyWait) {
  std::atomic<bool> go{false};
  Jobs jobs;
  const std::size_t running = jobs.add(waiting_for(go));
  while (state_of(jobs, running) != "running") std::this_thread::yield();
  for (int i = 0; i < 20; ++i) (void)jobs.add(quick([] {}));
  try {
    (void)jobs.add(quick([] {}));
    ADD_FAILURE() << "a 21st was taken";
  } catch (const RequestError& error) {
    EXPECT_EQ(error.status, 503);
  }
  go = true;
}

TEST(StudioJobs, FiftyThatEndedAreRememberedNewestFirst) {
  Jobs jobs;
  std::size_t last = 0;
  for (int i = 0; i < 60; ++i) {
    last = jobs.add(quick([] {}));
    (void)ended_job(jobs, last);
  }
  const auto list = jobs.list();
  EXPECT_EQ(list.size(), 50U);
  EXPECT_EQ(list.front()["job"], last);
  EXPECT_EQ(list.back()["job"], last - 49);
}

TEST(StudioJobs, GiveWayAndHearNoSignals) {
  Jobs jobs;
  int niceness = 0;
  bool masked = false;
  const std::size_t job = jobs.add(quick([&] {
    niceness = getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
    sigset_t mask;
    pthread_sigmask(SIG_SETMASK, nullptr, &mask);
    masked = sigismember(&mask, SIGINT) == 1 && sigismember(&mask, SIGTERM) == 1;
  }));
  (void)ended_job(jobs, job);
  EXPECT_EQ(niceness, std::max(10, getpriority(PRIO_PROCESS, 0)));
  EXPECT_TRUE(masked);
  EXPECT_EQ(getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())), getpriority(PRIO_PROCESS, 0));
}

}  // namespace
}  // namespace kerf::bench
