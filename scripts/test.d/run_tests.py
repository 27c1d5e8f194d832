#!/usr/bin/env python3
"""Runs ctest, and says in the last lines what failed and what was not tested: skips by reason, and which command brings what
was missing.

    scripts/test.d/run_tests.py [--totals FILE] [--until TIME] CTEST_ARGUMENT...

The very last line is "N passed, N failed, N skipped". Where a test is a whole suite of GoogleTest (over USB, or under the
sanitizers), each of its cases counts, and is named, as a test of its own. Where the environment says CI=true a skip is a failure,
unless tests/skips-allowed.txt names it with its reason. --totals appends "passed failed skipped" to a file, and a line for every
test that failed: "failed NAME", and one where not all were run. --until (seconds since 1970) runs the tests in parts, each of them one in so many of all, and begins
none that may not end in time. On CI, where others may use the machine, what failed is run once more, alone: one that then passes
passed, and is named. Not where more than a few failed, nor what a sanitizer has found.

Exit status: ctest's own; 1 if ctest passed and a skip was a failure; 124 if what was run passed, and not all was.
"""

import argparse
import fnmatch
import math
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

ALLOWED = Path(__file__).resolve().parents[2] / "tests" / "skips-allowed.txt"

# Of what a failed test said, at the end: this many lines, and of each this many characters.
SHOWN = 12
LONGEST_LINE = 300

PARTS = 12  # of tests that must end at a time
MOST_AGAIN = 10  # tests that may have been disturbed; where more fail, something else is wrong
NO_DISTURBANCE = re.compile(r"Sanitizer|runtime error:")
TIME_IS_UP = 124  # as timeout(1) has it

SAYS_NOTHING = "it says nothing"

# What brings what is missing, for reasons that do not say so themselves.
REMEDIES = [
    (r"measured data", "scripts/fetch-data"),
    (r"is not installed|is missing|are not there|no chrom|there is no Chromium", "scripts/set-up --tests"),
]


@dataclass(frozen=True)
class Skip:
    name: str
    reason: str


@dataclass(frozen=True)
class Failure:
    name: str
    said: tuple[str, ...]  # the lines of its output that tell most


@dataclass
class Outcome:
    passed: int
    failures: list[Failure]
    skips: list[Skip]

    def add(self, other: "Outcome") -> None:
        self.passed += other.passed
        self.failures += other.failures
        self.skips += other.skips


def last_line(text: str) -> str:
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1].removeprefix("skipped: ") if lines else SAYS_NOTHING


@dataclass(frozen=True)
class Case:
    """A case of GoogleTest, as its program printed it."""

    name: str
    result: str  # OK, FAILED, SKIPPED, or nothing where the program ended within it
    output: str


def cases_in(output: str) -> list[Case]:
    cases = []
    for begin in re.finditer(r"^\[ RUN      \] (\S+)\n", output, re.MULTILINE):
        name = begin[1]
        end = re.compile(rf"^\[ +(OK|FAILED|SKIPPED) +\] {re.escape(name)}(,.*)? \(\d+ ms\)", re.MULTILINE).search(output, begin.end())
        stop = end.start() if end else len(output)
        cases.append(Case(name, end[1] if end else "", output[begin.end():stop]))
    return cases


def reason_of_skip(output: str) -> str:
    """The first line of what a skipped case says."""
    said = re.search(r":\d+: Skipped\s*\n\s*(\S.*)", output)
    return said[1].strip() if said else SAYS_NOTHING


def telling_lines(output: str) -> tuple[str, ...]:
    """What of a failed test's output stands again at the end: GoogleTest's first failure, else its last lines."""
    lines = [line.rstrip() for line in output.splitlines() if line.strip()]
    first = next((i for i, line in enumerate(lines) if re.search(r": (Failure|error:)", line)), max(0, len(lines) - SHOWN))
    return tuple(line[:LONGEST_LINE] for line in lines[first:first + SHOWN])


def failed_in(junit: str) -> dict[str, bool]:
    """Tests that failed, and whether the machine may be to blame."""
    return {test.get("name", ""): not NO_DISTURBANCE.search(test.findtext("system-out") or "")
            for test in ElementTree.fromstring(junit).iter("testcase") if test.get("status") == "fail"}


def outcome_of(junit: str, left_out: Collection[str] = ()) -> Outcome:
    """Reads what `ctest --output-junit` writes. There, "notrun" is both a skip and a program that is missing."""
    outcome = Outcome(0, [], [])
    for test in ElementTree.fromstring(junit).iter("testcase"):
        name = test.get("name", "")
        if name in left_out:
            continue
        status = test.get("status")
        output = test.findtext("system-out") or ""
        skipped = test.find("skipped")
        cases = cases_in(output)
        own = {case.name: case.name if name in (case.name, case.name.split(".")[0]) else f"{name}: {case.name}" for case in cases}
        outcome.passed += sum(case.result == "OK" for case in cases)
        outcome.skips += [Skip(own[case.name], reason_of_skip(case.output)) for case in cases if case.result == "SKIPPED"]
        if status == "disabled":
            outcome.skips.append(Skip(name, "it is disabled"))
        elif status == "notrun" and skipped is not None and skipped.get("message", "").startswith("SKIP_"):
            if not cases:
                outcome.skips.append(Skip(name, last_line(output)))
        elif status == "run":
            outcome.passed += not cases
        else:
            failed = [case for case in cases if case.result in ("FAILED", "")]
            outcome.failures += [Failure(own[case.name], telling_lines(case.output)) for case in failed]
            if not failed:
                outcome.failures.append(Failure(name, telling_lines(output)))
    return outcome


@dataclass(frozen=True)
class Allowance:
    """A line of tests/skips-allowed.txt: a shell pattern of names, and a part of the reason that they may give."""

    pattern: str
    reason: str

    def covers(self, skip: Skip) -> bool:
        return fnmatch.fnmatchcase(skip.name, self.pattern) and self.reason in skip.reason


def read_allowances(text: str) -> list[Allowance]:
    allowances = []
    for number, line in enumerate(text.splitlines(), 1):
        line = line.strip()
        if not line or line.startswith("#"):
            continue
        pattern, bar, reason = (part.strip() for part in line.partition("|"))
        if not (pattern and bar and reason):
            raise ValueError(f"line {number}: expected 'pattern of names | part of the reason', got '{line}'")
        allowances.append(Allowance(pattern, reason))
    return allowances


def remedy(reason: str) -> str:
    if "scripts/" in reason:
        return ""
    for pattern, command in REMEDIES:
        if re.search(pattern, reason):
            return f" ({command} brings it)"
    return ""


def names_of(skips: list[Skip]) -> str:
    shown = [skip.name for skip in skips[:3]]
    more = len(skips) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more else "")


def closing_lines(outcome: Outcome, allowances: list[Allowance], skip_is_failure: bool) -> tuple[list[str], bool]:
    """What stands at the end of the output, and whether the skips let the run pass."""
    lines = []
    for failure in outcome.failures:
        lines += [f"Failed: {failure.name}", *(f"    {line}" for line in failure.said)]
    by_reason: dict[str, list[Skip]] = {}
    for skip in outcome.skips:
        by_reason.setdefault(skip.reason, []).append(skip)
    if by_reason:
        lines.append("Skipped, by reason:")
    for reason, skips in sorted(by_reason.items(), key=lambda item: -len(item[1])):
        lines.append(f"{len(skips):6}  {reason}{remedy(reason)}: {names_of(skips)}")
    refused = []
    if skip_is_failure:
        refused = [skip for skip in outcome.skips if not any(one.covers(skip) for one in allowances)]
        if refused:
            lines.append(f"On CI a skip is a failure unless tests/skips-allowed.txt names it, and {len(refused)} it does "
                         f"not: {names_of(refused)}")
        unused = [one for one in allowances if not any(one.covers(skip) for skip in outcome.skips)]
        lines += [f"Allowed to be skipped, and was not: {one.pattern} | {one.reason}" for one in unused]
    lines.append(f"{outcome.passed} passed, {len(outcome.failures)} failed, {len(outcome.skips)} skipped")
    return lines, not refused


def run_without_terminal(command: list[str]) -> int:
    """Runs it in a session of its own: a program that would ask a person at the terminal is told that there is none."""
    with subprocess.Popen(command, start_new_session=True) as process:
        try:
            return process.wait()
        except KeyboardInterrupt:
            os.killpg(process.pid, signal.SIGINT)
            raise


def count_of(ctest: list[str]) -> int:
    listed = subprocess.run([*ctest, "--show-only"], capture_output=True, text=True, check=False).stdout
    total = re.search(r"^Total Tests: (\d+)", listed, re.MULTILINE)
    return int(total[1]) if total else 0


def run_parts(ctest: list[str], folder: Path, until: float, count: int) -> tuple[int, list[Path], int]:
    """@returns ctest's status, what it wrote of each part, and how many of so many tests were not begun."""
    status, written, longest = 0, [], 0.0
    parts = min(PARTS, count)  # of a part that begins behind the last test ctest runs all
    for first in range(1, parts + 1):
        began = time.time()
        if began + longest > until:
            return status, written, sum(len(range(part, count + 1, parts)) for part in range(first, parts + 1))
        written.append(folder / f"junit{first}.xml")
        status = max(status, run_without_terminal([*ctest, "--output-junit", str(written[-1]),
                                                   "--tests-information", f"{first},,{parts}"]))
        longest = max(longest, time.time() - began)
    return status, written, 0


def run_again(ctest: list[str], folder: Path, tests: Collection[str]) -> tuple[int, str]:
    """Runs these, one at a time. @returns ctest's status and what it wrote."""
    written = folder / "again.xml"
    print("\nOnce more, alone: " + ", ".join(tests), flush=True)
    status = run_without_terminal([*ctest, "--output-junit", str(written), "--parallel", "1",
                                   "--tests-regex", "^(" + "|".join(map(re.escape, tests)) + ")$"])
    return status, written.read_text()


def main(arguments: list[str]) -> int:
    own = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    own.add_argument("--totals")
    own.add_argument("--until", type=float, default=math.inf)
    options, arguments = own.parse_known_args(arguments)
    on_ci = os.environ.get("CI", "").lower() in ("true", "1")
    try:
        allowances = read_allowances(ALLOWED.read_text()) if on_ci else []
    except ValueError as problem:
        print(f"{ALLOWED}: {problem}", file=sys.stderr)
        return 2
    notes = []
    with tempfile.TemporaryDirectory() as folder:
        # Of a passed test ctest keeps 1 KiB, and the skips within it may stand behind that.
        ctest = ["ctest", "--no-tests=error", "--test-output-size-passed", "10000000", *arguments]
        files, not_run = [Path(folder) / "junit.xml"], 0
        if math.isfinite(options.until) and (count := count_of(ctest)):
            status, files, not_run = run_parts(ctest, Path(folder), options.until, count)
            if not_run:
                notes.append(f"The time was up: {not_run} of {count} tests were not run")
        else:
            status = run_without_terminal([*ctest, "--output-junit", str(files[0])])
        written = [file.read_text() for file in files if file.exists()]
        failed = {name: disturbed for junit in written for name, disturbed in failed_in(junit).items()}
        again = [name for name, disturbed in failed.items() if disturbed and on_ci and time.time() < options.until]
        if len(failed) > MOST_AGAIN:
            again = []
        outcome = Outcome(0, [], [])
        for junit in written:
            outcome.add(outcome_of(junit, left_out=again))
        if again:
            status_again, junit = run_again(ctest, Path(folder), again)
            outcome.add(outcome_of(junit))
            if passed := [name for name in again if name not in failed_in(junit)]:
                notes.append("Failed beside others, and passed alone: " + ", ".join(passed))
            status = status if outcome.failures else status_again
    if outcome.passed + len(outcome.failures) + len(outcome.skips) + not_run == 0:  # `ctest --show-only` and the like
        return status
    lines, passes = closing_lines(outcome, allowances, on_ci)
    if options.totals:
        with open(options.totals, "a", encoding="utf-8") as file:
            file.write(f"{outcome.passed} {len(outcome.failures)} {len(outcome.skips)}\n")
            file.writelines(f"failed {failure.name}\n" for failure in outcome.failures)
            file.writelines(f"{note}\n" for note in notes)
    print("\n" + "\n".join([*notes, *lines]), flush=True)
    if status or not passes:
        return status or 1
    return TIME_IS_UP if not_run else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
