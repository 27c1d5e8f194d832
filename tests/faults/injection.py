"""Lets the n-th call that writes, or the n-th allocation, of each verb fail, and looks at what is left.

Whatever fails: nothing wrong stands under a final name, a line on standard error says what it was, the exit status is that of the
table in docs/command-line.md, and nothing crashes or hangs.
"""

import os
import random
import signal
import subprocess
from dataclasses import dataclass, field, replace
from pathlib import Path

from verbs import Bench, Verb
from whole_files import wrong_with

# With a +: from that call on. What is short or late is no failure, and what was interrupted may be asked again.
KINDS = ["short", "short+", "EINTR", "ENOSPC", "ENOSPC+", "EIO", "EIO+", "EDQUOT", "slow+"]
HARMLESS = ("short", "slow")
TIME_OUT_S = 60.0
# They exit where they have no memory, or follow a null: HDF5, matio, and OpenSSL's libcrypto while it fetches its first digest.
LIBRARIES = ("libhdf5", "libmatio", "libcrypto")


@dataclass
class Tally:
    tried: int = 0
    failed: int = 0  # runs that ended with another status than undisturbed
    by_library: int = 0  # of these, ended by one of LIBRARIES itself
    faults: list[str] = field(default_factory=list)  # what is wrong with the program


@dataclass(frozen=True)
class Ended:
    status: int | None  # none: it hung
    errors: str
    log: str  # of the faults that came about


class Injector:
    def __init__(self, bench: Bench, calls: Path, allocations: Path) -> None:
        self.bench = bench
        self.calls = calls
        self.allocations = allocations

    def run(self, verb: Verb, folder: Path, variables: dict[str, str]) -> Ended:
        log = self.bench.folder / "log"
        log.unlink(missing_ok=True)
        environment = dict(self.bench.environment, KERF_FAULT_BELOW=str(folder), KERF_FAULT_LOG=str(log), **variables)
        with subprocess.Popen(self.bench.words(verb.command), cwd=folder, env=environment, start_new_session=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as process:
            try:
                errors = process.communicate(timeout=TIME_OUT_S)[1].decode(errors="replace")
                status = process.returncode
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                errors, status = "", None
        return Ended(status, errors, log.read_text() if log.exists() else "")

    def with_calls(self, verb: Verb, folder: Path, kind: str, at: int) -> Ended:
        return self.run(verb, folder, {"LD_PRELOAD": str(self.calls), "KERF_FAULT_KIND": kind.rstrip("+"),
                                       "KERF_FAULT_AT": str(at) + ("+" if kind.endswith("+") else "")})

    def with_allocations(self, verb: Verb, folder: Path, at: int) -> Ended:
        return self.run(verb, folder, {"LD_PRELOAD": str(self.allocations), "KERF_FAULT_AT": str(at)})

    def count_calls(self, verb: Verb) -> int:
        """How many calls the verb's largest process makes."""
        ended = self.with_calls(verb, self.bench.working_folder(verb), "count", 1)
        return max(int(line.split()[1]) for line in ended.log.splitlines() if line.startswith("calls "))

    def count_allocations(self, verb: Verb) -> int:
        return int(self.with_allocations(verb, self.bench.working_folder(verb), 0).log.split()[-1])

    def judge(self, verb: Verb, folder: Path, ended: Ended, harmless: bool, older: bool = False) -> str:
        """What is wrong; nothing if all is as promised."""
        reference, undisturbed = self.bench.reference(verb)
        if ended.status is None:
            return "it hangs"
        said = ended.errors.strip()[-300:]
        if not 0 <= ended.status <= 4:
            return f"it crashes ({ended.status}): {said}"
        well = verb.ends_well(ended.status, undisturbed)
        if harmless and not well:
            return f"what was no failure ends with {ended.status}: {said}"
        if not well and ended.status not in verb.failures:
            return f"it ends with {ended.status}: {said}"
        if not well and not any(line.startswith("kerf: " if ended.status > 1 else "warning: ")
                                for line in ended.errors.splitlines()):  # fmt: skip
            return f"it ends with {ended.status} and does not say why: {said}"
        for name in verb.outputs:
            output = folder / name
            if well and not output.exists():
                return f"it ends with {ended.status}, and there is no {name}"
            if (older or name in verb.brings) and not output.exists():
                return f"{name}, which was there before, is gone"
            befores = [self.bench.inputs / name] if name in verb.brings and not well else []
            if wrong := wrong_with(self.bench.kerf, output, [reference / name, *befores], not verb.is_drawn):
                return f"it ends with {ended.status}, and {wrong}"
        return ""

    def try_call(self, verb: Verb, kind: str, at: int, older: bool, tally: Tally) -> bool:
        """Whether there was an n-th call. `older`: an earlier output stands there, to be replaced."""
        undisturbed = self.bench.reference(verb)[1]
        folder = self.bench.working_folder(verb, older)
        if older:
            verb = replace(verb, command=f"{verb.command} --force")
        ended = self.with_calls(verb, folder, kind, at)
        if not ended.log and ended.status is not None:
            return False
        tally.tried += 1
        tally.failed += not verb.ends_well(ended.status, undisturbed)
        if wrong := self.judge(verb, folder, ended, kind.startswith(HARMLESS), older):
            what = ended.log.strip().replace(str(folder) + "/", "")
            tally.faults.append(f"{verb.name}: {kind} at call {at}{' over an older output' if older else ''} ({what}): {wrong}")
        return True

    def try_allocation(self, verb: Verb, at: int, tally: Tally) -> None:
        undisturbed = self.bench.reference(verb)[1]
        folder = self.bench.working_folder(verb)
        ended = self.with_allocations(verb, folder, at)
        tally.tried += 1
        tally.failed += not verb.ends_well(ended.status, undisturbed)
        crashed = ended.status is not None and not 0 <= ended.status <= 4
        if crashed and any(library in ended.log for library in LIBRARIES):
            tally.by_library += 1
            ended = Ended(4, "kerf: ", ended.log)  # what it left is held to the same
        if wrong := self.judge(verb, folder, ended, False):
            tally.faults.append(f"{verb.name}: no memory at allocation {at}: {wrong}")


def places_of_allocations(total: int, first: int, drawn: int, seed: random.Random) -> list[int]:
    """The first so many, and as many more as are drawn on a logarithmic scale."""
    places = set(range(1, min(first, total) + 1))
    if total > first:
        places |= {round(first * (total / first) ** seed.random()) for _ in range(drawn)}
    return sorted(places)
