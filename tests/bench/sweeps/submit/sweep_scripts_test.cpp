// The scripts of engines, run by the shells that would run them.

#include "submit/sweep_scripts.h"

#include <filesystem>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sweeps/swept.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using testing::HasSubstr;

class SweepScripts : public test::SweepFolder {
 protected:
  [[nodiscard]] SubmitOptions options(SweepEngine engine) const {
    return {.engine = engine, .program = KERF_PROGRAM, .shards = file("w.shards")};
  }
  void write_program(const std::string& name, const std::string& text) const {
    fs::create_directories(file("bin"));
    test::write_text(file("bin/" + name), text);
    fs::permissions(file("bin/" + name), fs::perms::owner_all);
  }
  /// As a task of an array, with the programs of bin/ before all others.
  [[nodiscard]] Outcome run_task(const SweepScript& script, const std::string& task,
                                 const std::string& fault = "none@0") const {
    test::write_text(file(script.name), script.text);
    return test::run({"/usr/bin/env", "PATH=" + file("bin").string() + ":/usr/bin:/bin",
                      "SLURM_ARRAY_JOB_ID=55", "SLURM_ARRAY_TASK_ID=" + task, "KERF_SWEEP_FAULT=" + fault,
                      "bash", file(script.name).string()});
  }
};

TEST_F(SweepScripts, OfSlurmRunsTheShardOfItsTask) {
  const PlanFile plan = plan_of(test::walls("shards = 3\n"));
  SubmitOptions with = options(SweepEngine::slurm);
  with.at_once = 2;
  const SweepScript script = sweep_script(plan, with);
  for (const char* line : {"#SBATCH --array=0-2%2\n", "#SBATCH --requeue\n", "#SBATCH --signal=B:USR1@120\n",
                           "#SBATCH --open-mode=append\n"})
    EXPECT_THAT(script.text, HasSubstr(line));
  const Outcome outcome = run_task(script, "1");
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_TRUE(fs::exists(file("w.shards/1-of-3.shard")));
}

TEST_F(SweepScripts, OfSlurmAsksForATaskAgainThatWasStopped) {
  const PlanFile plan = plan_of(test::walls("shards = 3\n"));
  write_program("scontrol", "#!/bin/sh\necho \"$@\"\n");
  // A program that waits for the signal which the script hands on.
  write_program("stopped",
                "#!/bin/bash\ntrap 'exit 75' USR1\nkill -USR1 $PPID\nwhile :; do sleep 0.02; done\n");
  SubmitOptions with = options(SweepEngine::slurm);
  with.program = file("bin/stopped").string();
  const Outcome outcome = run_task(sweep_script(plan, with), "2");
  EXPECT_EQ(outcome.exit_status, 75) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("requeue 55_2"));
}

TEST_F(SweepScripts, NameTheShardsThatAreAskedFor) {
  const PlanFile plan = plan_of(test::walls("shards = 20\n"));
  SubmitOptions with = options(SweepEngine::slurm);
  with.only = "3,7,12-14";
  EXPECT_THAT(sweep_script(plan, with).text, HasSubstr("--array=3,7,12-14\n"));
  with.engine = SweepEngine::parallel;
  with.hosts = ":,node7";
  const std::string text = sweep_script(plan, with).text;
  EXPECT_THAT(text, HasSubstr("::: 3 7 $(seq 12 14)\n"));
  EXPECT_THAT(text, HasSubstr("--sshlogin ':,node7'"));
  with.hosts.clear();
  with.only = "3; rm";
  EXPECT_THROW((void)sweep_script(plan, with), std::invalid_argument);
}

TEST_F(SweepScripts, OfParallelRunsEveryShardAndGoesOn) {
  const PlanFile plan = plan_of(test::walls("shards = 3\n"));
  SubmitOptions with = options(SweepEngine::parallel);
  with.at_once = 2;
  test::write_text(file("p.sh"), sweep_script(plan, with).text);
  EXPECT_EQ(test::run({"bash", "-n", file("p.sh").string()}).exit_status, 0);
  if (test::run({"sh", "-c", "command -v parallel"}).exit_status != 0) GTEST_SKIP() << "no GNU parallel";
  const auto run_script = [&](const std::string& fault) {
    return test::run({"/usr/bin/env", "KERF_SWEEP_FAULT=" + fault, "bash", file("p.sh").string()});
  };
  EXPECT_EQ(run_script("kill@3").exit_status, 3) << "as many as failed";
  EXPECT_FALSE(fs::exists(file("w.shards/1-of-3.shard")));
  const Outcome again = run_script("none@0");
  EXPECT_EQ(again.exit_status, 0) << again.errors;
  const auto apart = merged();
  fs::remove_all(file("w.shards"));
  EXPECT_EQ(run_it({"-j", "1"}).exit_status, 0);
  EXPECT_EQ(merged(), apart);
}

TEST_F(SweepScripts, OfSnakemakeKeepsWhatIsNotCompleteOutOfItsSight) {
  const PlanFile plan = plan_of(test::walls("shards = 3\n"));
  const std::string text = sweep_script(plan, options(SweepEngine::snakemake)).text;
  EXPECT_THAT(text, HasSubstr("-of-\" + str(SHARDS) + \".shard\""));
  EXPECT_EQ(text.find(".partial\""), std::string::npos);
}

TEST_F(SweepScripts, AreOnlyPrintedWithDryRun) {
  (void)plan_of(test::walls("shards = 3\n"));
  for (const char* engine : {"slurm", "parallel", "snakemake"}) {
    const Outcome outcome = sweep({"submit", file("w.plan.json").string(), "--engine", engine, "--dry-run"});
    EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
    EXPECT_THAT(outcome.output, HasSubstr("sweep run"));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 2)
      << "the sweep and its plan";
  EXPECT_EQ(sweep({"submit", file("w.plan.json").string(), "--engine", "slurm"}).exit_status, 0);
  EXPECT_TRUE(fs::exists(file("w.sbatch")));
}

}  // namespace
}  // namespace kerf::bench
