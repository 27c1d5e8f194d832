"""The copy of the tree in which mutants are built and tried, so that the tree itself is never touched."""

import fcntl
import json
import os
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

from results import ENDLESS, KILLED, LIVES
from rooms import Room

MOST_SECONDS = 20.0  # of a test that counts; who waits for the program does so for ever


def batches(seconds: dict[str, float]) -> Iterator[tuple[list[str], float]]:
    """Tests that are run together, the quick ones first, each batch about as long as all before it: most mutants die early."""
    batch, before, within = [], 0.0, 0.0
    for case in sorted(seconds, key=seconds.__getitem__):
        batch.append(case)
        within += seconds[case]
        if within >= max(1.0, before):
            yield batch, within
            batch, before, within = [], before + within, 0.0
    if batch:
        yield batch, within


class Scratch:
    """build/mutate/source, and build/mutate/build beside it: no unity builds, so that a mutant costs one source."""

    def __init__(self, root: Path, jobs: int) -> None:
        self.root = root
        self.source = root / "build/mutate/source"
        self.build = root / "build/mutate/build"
        self.jobs = jobs
        self.bases: dict[str, dict[str, float]] = {}  # of a program: seconds of each test that holds

    def files(self) -> list[str]:
        listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=self.root,
                                check=True, capture_output=True, text=True).stdout
        return sorted(name for name in listed.split("\0") if name and (self.root / name).is_file())

    def refresh(self) -> None:
        """Makes the copy what the tree is; a file that is the same keeps its time, and is not built again.

        @throws BlockingIOError if another one is at work in it.
        """
        self.source.mkdir(parents=True, exist_ok=True)
        self.lock = (self.source.parent / "lock").open("w")  # until the end
        fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        files = self.files()
        for name in files:
            self.put(name, (self.root / name).read_bytes())
            (self.source / name).chmod((self.root / name).stat().st_mode)
        for path in [path for path in self.source.rglob("*") if path.is_file()]:
            if str(path.relative_to(self.source)) not in set(files):
                path.unlink()
        if not (self.build / "build.ninja").exists():
            subprocess.run(
                ["cmake", "-S", self.source, "-B", self.build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Mutants",
                 "-DCMAKE_CXX_FLAGS_MUTANTS=-O1", "-DCMAKE_UNITY_BUILD=OFF", "-DKERF_STUDIO=OFF",
                 "-DKERF_TESTS_WITHOUT_PROGRAM=ON"], check=True, stdout=subprocess.DEVNULL)

    def put(self, name: str, content: bytes) -> None:
        path = self.source / name
        if path.exists() and path.read_bytes() == content:
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)

    def restore(self, name: str) -> None:
        self.put(name, (self.root / name).read_bytes())

    def compiles(self, room: Room) -> bool:
        return subprocess.run(["ninja", "-j", str(self.jobs), "-C", self.build, *room.programs], capture_output=True,
                              check=False).returncode == 0

    def take_bases(self, room: Room) -> None:
        """Learns which tests hold without a mutant, and how long they take, each by itself: some wait for the program for ever.
        Names those that do not.

        What was learned is kept beside the program; of another version of it only the new tests are learned, unless one that held
        does not any more.
        """
        for program in room.programs:
            kept = self.build / f"{program}.tests.json"
            known = json.loads(kept.read_text()) if kept.exists() else {}
            cases = self.cases(program)
            seconds = {case: known[case] if case in known else self.seconds_of(program, case) for case in cases}
            self.bases[program] = {case: taken for case, taken in seconds.items() if taken is not None}
            if self.verdict_by(program) != LIVES:
                seconds = {case: self.seconds_of(program, case) for case in cases}
                self.bases[program] = {case: taken for case, taken in seconds.items() if taken is not None}
            kept.write_text(json.dumps(seconds))
            if failing := [case for case in cases if seconds[case] is None]:
                print(f"{program}: left out, since they fail without any mutant: {', '.join(failing)}", flush=True)

    def seconds_of(self, program: str, case: str) -> float | None:
        """None if it does not hold."""
        start = time.monotonic()
        holds = self.run(program, [f"--gtest_filter={case}"], MOST_SECONDS) == 0
        return time.monotonic() - start if holds else None

    def cases(self, program: str) -> list[str]:
        listed = subprocess.run([self.build / "bin" / program, "--gtest_list_tests"], check=True, capture_output=True, text=True)
        found = []
        suite = ""
        for line in listed.stdout.splitlines()[1:]:
            name = line.split("#")[0]
            if name.startswith(" "):
                found.append(suite + name.strip())
            else:
                suite = name.strip()
        return found

    def verdict(self, room: Room) -> str:
        verdicts = (self.verdict_by(program) for program in room.programs)
        return next((verdict for verdict in verdicts if verdict != LIVES), LIVES)

    def verdict_by(self, program: str) -> str:
        for cases, seconds in batches(self.bases[program]):
            flags = self.build / f"{program}.flags"
            flags.write_text("--gtest_fail_fast\n--gtest_filter=" + ":".join(cases) + "\n")
            status = self.run(program, [f"--gtest_flagfile={flags}"], 10.0 + 4.0 * seconds)
            if status != 0:
                return ENDLESS if status is None else KILLED
        return LIVES

    def run(self, program: str, arguments: list[str], seconds: float) -> int | None:
        """The exit status; none if it did not end in time."""
        with subprocess.Popen([self.build / "bin" / program, *arguments], cwd=self.build, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, start_new_session=True,
                              env=dict(os.environ, XDG_CACHE_HOME=str(self.build / "cache"))) as process:
            try:
                return process.wait(seconds)
            except subprocess.TimeoutExpired:
                return None
            finally:  # nor does what it started outlive it
                try:
                    os.killpg(process.pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass
