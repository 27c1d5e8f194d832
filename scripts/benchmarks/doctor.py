# peers:
# targets: kerf
"""How often kerf doctor names a cause that was put there, and how often one that was not.

scripts/benchmark doctor [RUNS [SECONDS]]
"""

import ctypes
import json
import os
import pathlib
import subprocess
import sys
import time

from latencies import last_processor
from sections import replace_section

SLACK_NS = 2_000_000
PR_SET_TIMERSLACK = 29
GROUP = pathlib.Path("/sys/fs/cgroup/cpu/kerf-doctor")
SPIN = "import os; os.sched_setaffinity(0, {%d}); %s"
BURSTS = """os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(99))
import time
while True:
    until = time.monotonic() + 0.003
    while time.monotonic() < until: pass
    time.sleep(0.047)
"""
FOREVER = """
while True: pass
"""


class Nothing:
    """Nothing is put there."""

    name = "nothing"
    finding = ""
    brings = ()  # other findings that are then true as well
    user = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def prepare(self):
        """In the process that becomes kerf."""

    def is_named(self, findings):
        return findings[self.finding]["state"] == "costs"


class Process(Nothing):
    """Another process on the loop's processor."""

    finding = "other_processes"

    def __init__(self, name, work):
        self.name, self.work, self.child = name, work, None

    def __enter__(self):
        self.child = subprocess.Popen([sys.executable, "-c", SPIN % (last_processor(), self.work)])
        time.sleep(0.2)
        return self

    def __exit__(self, *_):
        self.child.kill()
        self.child.wait()

    def is_named(self, findings):
        found = findings[self.finding]
        return found["state"] == "costs" and "(%d)" % self.child.pid in found["seen"]


class NoRights(Nothing):
    name, finding, user = "a user without rights", "realtime_scheduling", 65534


class Slack(Nothing):
    name, finding = "a timer slack of 2 ms, handed down", "timer_slack"

    def prepare(self):
        ctypes.CDLL(None).prctl(PR_SET_TIMERSLACK, SLACK_NS, 0, 0, 0)


class Quota(Nothing):
    name, finding = "a control group with a fifth of a processor", "cgroup_quota"
    brings = ("realtime_scheduling",)  # a new group of version 1 gives real-time threads no time

    def __enter__(self):
        GROUP.mkdir(exist_ok=True)
        (GROUP / "cpu.cfs_quota_us").write_text("20000")
        return self

    def __exit__(self, *_):
        GROUP.rmdir()

    def prepare(self):
        (GROUP / "cgroup.procs").write_text(str(os.getpid()))


def injections():
    all_of_them = [Nothing(), Process("a process that computes on the loop's processor", FOREVER)]
    if os.geteuid() == 0:
        all_of_them += [Process("one more urgent than the loop there, 3 ms in each 50 ms", BURSTS), NoRights()]
        if GROUP.parent.joinpath("cpu.cfs_quota_us").exists():
            all_of_them.append(Quota())
    return [*all_of_them, Slack()]


def examine(kerf, seconds, injection):
    with injection:
        done = subprocess.run([str(kerf), "doctor", "--json", "--seconds", str(seconds)], capture_output=True, text=True,
                              preexec_fn=injection.prepare, user=injection.user, check=False)
        if done.returncode > 1:
            sys.exit(done.stderr)
        told = json.loads(done.stdout)
        findings = {finding["name"]: finding for finding in told["findings"]}
        late = [wake for wake in told["latest"] if wake["late_us"] >= 1000.0]
        child = getattr(injection, "child", None)
        return {
            "findings": findings,
            "named": bool(injection.finding) and injection.is_named(findings),
            "late": len(late),
            "explained": sum(wake["cause"] != "unknown" for wake in late),
            "its": sum(wake["pid"] == child.pid for wake in late) if child else None,
        }


def accused_without(cause, runs):
    """Of the runs without a cause of that finding, those that say that it costs. Of processes: that one more urgent
    than the loop made a wake-up late."""
    others = [run for injection, all_runs in runs if cause.finding not in (injection.finding, *injection.brings)
              for run in all_runs]
    if cause.finding == "other_processes":
        return "%d of %d" % (sum("priority 99" in run["findings"][cause.finding]["seen"].split("on the loop's processor")[0]
                                 for run in others), len(others))
    return "%d of %d" % (sum(run["findings"][cause.finding]["state"] == "costs" for run in others), len(others))


def main():
    house = pathlib.Path(sys.argv[1])
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 10
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else 2.0
    kerf = house / "build/release/bin/kerf"
    causes = injections()
    runs = [(cause, []) for cause in causes]
    loads = []
    for _ in range(count):
        for cause, results in runs:
            results.append(examine(kerf, seconds, cause))
            loads.append(os.getloadavg()[0])
    lines = ["| put there | finding | named | accused without it | wake-ups 1 ms late or more | of these its own, by name | "
             "of these with any cause |", "|---|---|---|---|---|---|---|"]
    for cause, results in runs:
        late = sum(run["late"] for run in results)
        its = "-" if results[0]["its"] is None else sum(run["its"] for run in results)
        lines.append("| %s | %s | %s | %s | %d | %s | %d |" % (
            cause.name, "`%s`" % cause.finding if cause.finding else "-",
            "%d of %d" % (sum(run["named"] for run in results), count) if cause.finding else "-",
            accused_without(cause, runs) if cause.finding else "-", late, its, sum(run["explained"] for run in results)))
    lines += ["", "Runs of %g s each, by turns; loop and sleeper together, the 64 latest of a run. A process that only computes makes no "
              "wake-up late where the loop is more urgent: it is named if it takes 10 %% of the loop's processor and is among the six that "
              "take most. While this ran, %.0f threads wanted to run on %d processors: what was not put there made wake-ups late too."
              % (seconds, max(loads), os.cpu_count())]
    replace_section(house / "docs/benchmarks.md", "doctor", "Whether kerf doctor names what was put there", "\n".join(lines))


main()
