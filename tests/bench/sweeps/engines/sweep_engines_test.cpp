// The engines that run shards, tried for real: what comes of each is what one worker gives, byte by byte.

#include <filesystem>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bench/sweeps/swept.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using testing::HasSubstr;

/// Where 'scripts/set-up --tests' unpacks engines.
const fs::path engines = fs::path(KERF_SOURCE_DIR) / "build/engines";
const fs::path here = fs::path(KERF_SOURCE_DIR) / "tests/bench/sweeps/engines";

/// Twenty walls in four shards, and what one worker makes of them.
class SweepEngines : public test::SweepFolder {
 protected:
  void SetUp() override {
    (void)plan_of(test::walls("shards = 4\nlimits = { seconds = 600 }\n"));
    ASSERT_EQ(run_it({"-j", "1", "-o", file("one").string()}).exit_status, 0);
    whole_ = merged("one");
    ASSERT_FALSE(whole_.empty());
  }

  /// Writes the script of an engine; returns how it is started, as 'kerf sweep submit' says.
  [[nodiscard]] std::string submit(std::vector<std::string> words) const {
    words.insert(words.begin(), {"submit", file("w.plan.json").string(), "--json", "--engine"});
    const Outcome outcome = sweep(words);
    EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
    return nlohmann::json::parse(outcome.output).at("command").get<std::string>();
  }
  /// In the folder, with a home of its own.
  [[nodiscard]] Outcome shell(const std::string& script, std::vector<std::string> before = {}) const {
    before.insert(before.end(), {"/usr/bin/env", "HOME=" + folder_.path().string(),
                                 "XDG_CACHE_HOME=" + file("cache").string(), "bash", "-c",
                                 "cd '" + folder_.path().string() + "' && " + script});
    return test::run(before);
  }
  void write_program(const std::string& name, const std::string& text) const {
    test::write_text(file(name), text);
    fs::permissions(file(name), fs::perms::owner_all);
  }
  [[nodiscard]] bool is_complete(int shard) const {
    return fs::exists(file("w.shards/" + std::to_string(shard) + "-of-4.shard"));
  }

  std::map<std::string, std::string> whole_;
};

TEST_F(SweepEngines, NoneIsNeededForTwoWorkers) {
  ASSERT_EQ(run_it({"-j", "2"}).exit_status, 0);
  EXPECT_EQ(merged(), whole_);
}

TEST_F(SweepEngines, ParallelRunsShardsOnTwoHostsAndGoesOn) {
  const fs::path sshd = engines / "ssh/usr/sbin/sshd";
  if (!fs::exists(sshd)) GTEST_SKIP() << "no server of ssh is unpacked";
  if (::geteuid() == 0 && test::run({"unshare", "--mount", "true"}).exit_status != 0)
    GTEST_SKIP() << "no right to mount a disk";
  write_program("run-kerf", "#!/bin/sh\necho \"$SSH_CONNECTION\" >> '" + file("connections").string() +
                                "'\n[ -e '" + file("again").string() +
                                "' ] || export KERF_SWEEP_FAULT=kill@3\nexec '" KERF_PROGRAM "' \"$@\"\n");
  const std::string command =
      submit({"parallel", "--hosts", "1/one,1/two", "--program", file("run-kerf").string()});
  const std::string libraries = (engines / "ssh/usr/lib/x86_64-linux-gnu").string();
  const Outcome outcome = shell("export PARALLEL_SSH='ssh -F " + file("ssh/config").string() + "'; " +
                                    command + "; echo status $?; ls w.shards; touch again; " + command,
                                {"/usr/bin/env", "LD_LIBRARY_PATH=" + libraries,
                                 (here / "with_sshd").string(), sshd.string(), file("ssh").string()});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("status 4")) << "all four were killed: " << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("3-of-4.shard.partial"));
  EXPECT_EQ(merged(), whole_);
  const std::string joblog = test::read_text(file("w.shards/joblog"));
  EXPECT_THAT(joblog, HasSubstr("\tone\t"));
  EXPECT_THAT(joblog, HasSubstr("\ttwo\t"));
  EXPECT_THAT(test::read_text(file("connections")), HasSubstr("127.0.0.1")) << "they came by ssh";
}

TEST_F(SweepEngines, SnakemakeRunsShardsOnTwoCoresAndGoesOn) {
  const fs::path snakemake = engines / "snakemake/usr";
  if (!fs::exists(snakemake / "bin/snakemake")) GTEST_SKIP() << "no Snakemake is unpacked";
  const std::string command = submit({"snakemake", "--at-once", "2", "--program", KERF_PROGRAM});
  EXPECT_THAT(command, HasSubstr("--cores 2"));
  const std::string set = "export PYTHONPATH='" + (snakemake / "lib/python3/dist-packages").string() +
                          "' PYTHONDONTWRITEBYTECODE=1; PATH='" + (snakemake / "bin").string() + "':$PATH; ";
  const Outcome killed = shell(set + "export KERF_SWEEP_FAULT=kill@3; " + command + " --keep-going");
  EXPECT_EQ(killed.exit_status, 1) << killed.errors;
  for (int shard = 0; shard < 4; ++shard) EXPECT_FALSE(is_complete(shard)) << shard;
  EXPECT_TRUE(fs::exists(file("w.shards/0-of-4.shard.partial")))
      << "it is left where it was: " << killed.errors;
  const Outcome again = shell(set + command);
  EXPECT_EQ(again.exit_status, 0) << again.errors;
  EXPECT_EQ(merged(), whole_);
  EXPECT_THAT(shell(set + command).errors, HasSubstr("Nothing to be done"));
}

TEST_F(SweepEngines, SlurmAsksForATaskAgainThatItsSignalStopped) {
  const fs::path slurm = engines / "slurm";
  if (!fs::exists(slurm / "usr/bin/sbatch")) GTEST_SKIP() << "no Slurm is unpacked";
  // The first time task 1 hangs in its third cell, until the signal that tells of a time limit comes.
  write_program("run-kerf",
                "#!/bin/sh\necho \"task $SLURM_ARRAY_TASK_ID, restart ${SLURM_RESTART_COUNT:-0}\" >> '" +
                    file("tasks").string() +
                    "'\n[ \"$SLURM_ARRAY_TASK_ID ${SLURM_RESTART_COUNT:-0}\" != '1 0' ] || export "
                    "KERF_SWEEP_FAULT=hang@7\nexec '" KERF_PROGRAM "' \"$@\"\n");
  const std::string command = submit({"slurm", "--program", file("run-kerf").string()});
  test::write_text(file("script"), R"sh(set -e
until_so() { for _ in {1..600}; do eval "$1" && return; sleep 0.2; done; echo "never: $1" >&2; squeue >&2; exit 1; }
KERF=$1
job=$($2 | grep -o '[0-9]*$')
until_so '"$KERF" sweep status w.plan.json --json | grep -q "\"computed\": 17"'
scontrol show job "${job}_1" | grep -o 'NumCPUs=[0-9]*'
scancel --batch --signal=USR1 "${job}_1"
until_so '[ -z "$(squeue --noheader)" ]'
)sh");
  const Outcome outcome = shell("bash script '" KERF_PROGRAM "' '" + command + "'",
                                {(here / "with_slurm").string(), slurm.string(), file("cluster").string()});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors << test::read_text(file("cluster/slurmctld.out"));
  const std::string tasks = test::read_text(file("tasks"));
  for (int shard = 0; shard < 4; ++shard) {
    EXPECT_TRUE(is_complete(shard)) << shard;
    EXPECT_THAT(tasks, HasSubstr("task " + std::to_string(shard) + ", restart 0"));
  }
  EXPECT_THAT(tasks, HasSubstr("task 1, restart 1"));
  EXPECT_EQ(tasks.find("task 0, restart 1"), std::string::npos) << "nobody asked for it again";
  EXPECT_EQ(merged(), whole_);
}

}  // namespace
}  // namespace kerf::bench
