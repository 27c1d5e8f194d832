"""Every verb that writes, with small inputs: what nets of tests (injection.py, pairs.py) throw faults at."""

import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

SUITE = """name = "one law"
[defaults]
rate = { value = 1000, unit = "Hz" }
seconds = { value = 0.2, unit = "s" }
absolute = [{ value = 1e-12, unit = "N" }]
[[case]]
name = "kelvin"
law = "kelvin.law.toml"
[[case.motion]]
kind = "strokes"
from = { value = 35, unit = "deg" }
to = { value = 8, unit = "deg" }
stroke = { value = 0.3, unit = "s" }
pause = { value = 0.05, unit = "s" }
"""

WALLS = """version = 1
verb = "stability"
[cells]
mass = [0.1, 0.2]
stiffness = [100, 100000]
seconds = 0.05
"""


@dataclass(frozen=True)
class Verb:
    name: str
    command: str  # {examples} and {in} are folders; what is written lies in the working folder
    outputs: tuple[str, ...]  # its final names
    brings: tuple[str, ...] = ()  # of the inputs, copied into the working folder, because they are changed or stand beside
    seconds: float = 0.1  # about how long it takes
    replaces: bool = False  # an earlier output unasked: what is made again at will
    can_force: bool = True  # replaces an earlier output with --force
    failures: tuple[int, ...] = (2, 4)  # exit statuses where a call or memory fails; 1: it lists what failed, and goes on
    judges_time: bool = False  # by the clock: ends with 0 or 1 as the machine will

    def ends_well(self, status: int, undisturbed: int) -> bool:
        return status == undisturbed or (self.judges_time and status in (0, 1))

    @property
    def is_drawn(self) -> bool:
        """Answers, samples and keys are drawn: of such a file can only be said that it is valid."""
        return self.name.startswith("session")


VERBS = [
    Verb("record", "record --device sim:scissors --seconds 0.5 --virtual --law {in}/kelvin.law.toml -o r.h5", ("r.h5",)),
    Verb("import", "import {examples}/data/punch.txt --map time=time,position=angle,force=force -o p.h5", ("p.h5",)),
    Verb("prepare", "prepare {in}/cut.h5 --bias --filter butterworth2:20 --filter-chart f.svg -o p.h5", ("p.h5", "f.svg")),
    Verb("segment", "segment cut.h5 -o charts", ("cut.h5", "charts"), ("cut.h5",), 0.4, can_force=False),
    Verb("fit", "fit {in}/cut.h5 --models kelvin --no-folds -o fits", ("fits",)),
    Verb("fit --batch", "fit --batch {in}/batch --jobs 1 --models kelvin --no-folds -o fits", ("fits/cut",),
         failures=(1, 2, 4)),
    Verb("calibrate", "calibrate {examples}/calibration/cell.csv --map signal_1=3,fz=2[N],time=1[s] --tolerance 0.001 "
         "--date 2026-11-28 -o c.calibration.toml", ("c.calibration.toml", "c.json", "c.csv")),
    Verb("chart", "chart {in}/cut.h5 --laws kelvin,exponential --no-folds --no-cold -o chart", ("chart",), (), 0.4),
    Verb("identify", "identify sim:axis?hand=off --seconds 5 --places 1 -o axis", ("axis",), (), 3.0),
    Verb("report", "report {in}/cut.h5 -o r.html", ("r.html",), (), 0.2),
    Verb("replay", "replay {in}/cut.h5 --through {in}/kelvin.law.toml -o replay", ("replay",), (), 0.3),
    Verb("replay --record", "replay {in}/cut.h5 --as table --virtual --seconds 0.5 --record t.h5", ("t.h5",), (), 0.2),
    Verb("replay --as table", "replay {in}/cut.h5 --as table --virtual --seconds 0.5 -o table", ("table",), (), 0.2,
         judges_time=True),
    Verb("compare", "compare {in}/cut.h5 {in}/cut.h5 -o compared", ("compared",), (), 0.2),
    Verb("regress update", "regress update suite.toml --reason first --yes", ("suite.h5",), ("suite.toml", "kelvin.law.toml"),
         replaces=True, can_force=False),
    Verb("regress run", "regress run {in}/suite.toml --no-cost --junit j.xml -o regress", ("j.xml", "regress"), replaces=True,
         can_force=False),
    Verb("repair", "repair killed.h5", ("killed.h5",), ("killed.h5.partial",), can_force=False),
    Verb("train --example", "train --example -o ruptures.csv", ("ruptures.csv",)),
    Verb("train", "train {in}/ruptures.csv -o threshold.law.toml", ("threshold.law.toml",), (), 0.2),
    Verb("blade", "blade {in}/pose.h5 --shape {examples}/blade.law.toml -o blade.law.toml", ("blade.law.toml",)),
    Verb("session key", "session key new.key", ("new.key",), can_force=False),
    Verb("session new", "session new {examples}/sessions/abx.protocol.toml --subject S02 --key-file {in}/keeper.key -o S02.h5",
         ("S02.h5",), (), 0.2),
    Verb("session new --subjects",
         "session new {examples}/sessions/abx.protocol.toml --subjects 3 --key-file {in}/keeper.key --no-check -o study", ("study",)),
    Verb("session run", "session run S01.h5 --key-file {in}/keeper.key --rehearse --no-check", ("S01.h5",), ("S01.h5",), 1.0,
         can_force=False),
    Verb("session note", "session note S01.h5 rain --key-file {in}/keeper.key", ("S01.h5",), ("S01.h5",), 0.2, can_force=False),
    Verb("session analyze", "session analyze {in}/done.h5 --key-file {in}/keeper.key -o analysis", ("analysis",), (), 0.5),
    Verb("session open", "session open done.h5 --key-file {in}/keeper.key -o opened", ("done.h5", "opened"), ("done.h5",), 0.5),
    Verb("session share", "session share done.h5 --key-file {in}/keeper.key -o shared", ("done.h5", "shared"), ("done.h5",), 0.5),
    Verb("session simulate", "session simulate {examples}/sessions/abx.protocol.toml --subjects 2 -o power", ("power",), (), 1.0),
    Verb("check", "check {in}/kelvin.law.toml --device sim:scissors --seconds 0.1 -o c.json", ("c.json",), (), 0.5,
         judges_time=True),
    Verb("check --record", "check {in}/kelvin.law.toml --device sim:scissors --virtual --seconds 1 --record c.h5", ("c.h5",), (),
         0.2),
    Verb("stability", "stability --cells 2 --seconds 0.1 --threads 1 -o wall", ("wall",)),
    Verb("choose", "choose {in}/short.h5 --no-loop --folds 2 --most-segments 1 -o choice", ("choice",), (), 0.4),
    Verb("reproduce", "reproduce Okamura2003 -o okamura", ("okamura",), (), 3.0),
    Verb("demo", "demo --seconds 0.1 -o demo", ("demo",), (), 6.0),
    Verb("convert to CSV", "convert {in}/short.h5 -o r.csv", ("r.csv", "r.dictionary.csv", "r.events.csv")),
    Verb("convert to MAT", "convert {in}/short.h5 -o r.mat", ("r.mat",)),
    Verb("convert to MCAP", "convert {in}/short.h5 -o r.mcap", ("r.mcap",)),
    Verb("sweep plan", "sweep plan {in}/walls.toml --no-sample -o w.plan.json", ("w.plan.json",)),
    Verb("sweep merge", "sweep merge {in}/walls.plan.json -o merged", ("merged",), (), 0.2),
    Verb("sweep submit", "sweep submit {in}/walls.plan.json --engine slurm -o w.sbatch", ("w.sbatch",)),
    # New ones here: the faults of those above stay the ones that a seed draws.
]  # fmt: skip


class Bench:
    """The program, its inputs (made once), and folders to work in."""

    def __init__(self, kerf: Path, examples: Path, folder: Path) -> None:
        self.kerf = kerf
        self.examples = examples
        self.folder = folder
        self.inputs = folder / "in"
        self.references: dict[str, tuple[Path, int]] = {}
        self.environment = dict(os.environ, XDG_CACHE_HOME=str(folder / "cache"), LC_ALL="C.UTF-8")
        self.inputs.mkdir()
        (self.inputs / "suite.toml").write_text(SUITE)
        (self.inputs / "walls.toml").write_text(WALLS)
        shutil.copy(examples / "kelvin.law.toml", self.inputs)
        for command in (
            "record --device sim:scissors --seconds 6 --virtual -o cut.h5", "segment cut.h5",
            "record --device sim:scissors --seconds 2 --virtual -o short.h5",
            "record --device sim:pose6 --seconds 1 --virtual -o pose.h5",
            "regress update suite.toml --reason first --yes", "train --example -o ruptures.csv", "session key keeper.key",
            "session new {examples}/sessions/abx.protocol.toml --subject S01 --key-file keeper.key -o S01.h5",
            "session new {examples}/sessions/abx.protocol.toml --subject S03 --key-file keeper.key -o done.h5",
            "session run done.h5 --key-file keeper.key --rehearse --no-check",
            "sweep plan walls.toml --no-sample", "sweep run walls.plan.json -j 1",
            "check kelvin.law.toml --device sim:scissors --seconds 0.1",  # keeps the floor of this machine
        ):  # fmt: skip
            made = subprocess.run(self.words(command), cwd=self.inputs, env=self.environment, capture_output=True, text=True,
                                  check=False)
            if made.returncode not in (0, 1):  # 1: on a busy machine the check does not pass
                raise RuntimeError(f"kerf {command}: {made.stderr}")
        (self.inputs / "batch").mkdir()
        shutil.copy(self.inputs / "cut.h5", self.inputs / "batch")
        self.leave_a_partial_file()

    def leave_a_partial_file(self) -> None:
        partial = self.inputs / "killed.h5.partial"
        with subprocess.Popen(self.words("record --device sim:scissors --seconds 600 -o killed.h5"), cwd=self.inputs,
                              env=self.environment, stderr=subprocess.DEVNULL) as process:
            while not self.rows(partial):
                pass
            process.kill()

    def rows(self, recording: Path) -> int:
        found = subprocess.run([self.kerf, "info", recording, "--json"], env=self.environment, capture_output=True, check=False)
        return found.returncode == 0 and b'"samples": 0' not in found.stdout and b'"samples"' in found.stdout

    def words(self, command: str) -> list[str]:
        places = {"examples": self.examples, "in": self.inputs}
        return [str(self.kerf), *(word.format(**places) for word in command.split())]

    def working_folder(self, verb: Verb, older: bool = False) -> Path:
        """Made anew. `older`: what the verb wrote undisturbed stands there already."""
        folder = self.folder / "work"
        shutil.rmtree(folder, ignore_errors=True)
        if older:
            shutil.copytree(self.reference(verb)[0], folder)
        else:
            folder.mkdir()
        for name in verb.brings:
            shutil.copy(self.inputs / name, folder)
        return folder

    def reference(self, verb: Verb) -> tuple[Path, int]:
        """What the verb writes undisturbed, and how it ends."""
        if verb.name not in self.references:
            folder = self.working_folder(verb)
            done = subprocess.run(self.words(verb.command), cwd=folder, env=self.environment, capture_output=True, text=True,
                                  check=False)
            if done.returncode not in (0, 1):
                raise RuntimeError(f"kerf {verb.command}: {done.stderr}")
            kept = self.folder / "reference" / verb.name.replace(" ", "-")
            shutil.copytree(folder, kept)
            self.references[verb.name] = (kept, done.returncode)
        return self.references[verb.name]
