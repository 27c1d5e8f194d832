"""Two at once: verbs that want one output, and readers beside a writer, some of them killed at a random moment.

Whatever stands under a final name is whole and of one of the two; who ends with status 0 has not lost what it wrote; a reader sees
what is valid or says in a sentence why not; nothing crashes or hangs.
"""

import itertools
import os
import random
import signal
import subprocess
import time
from dataclasses import dataclass, replace
from pathlib import Path

from verbs import VERBS, Bench, Verb
from whole_files import names_in, wrong_with

TIME_OUT_S = 60.0
KILLED = -signal.SIGKILL
READERS = ("info {file}", "validate {file}", "report {file} -o page.html")


@dataclass(frozen=True)
class Pair:
    first: Verb
    second: Verb
    name: str  # the output that both want

    def __str__(self) -> str:
        return f"{self.first.name} and {self.second.name}"


@dataclass
class Party:
    command: list[str]
    starts_s: float
    dies_s: float | None
    process: subprocess.Popen | None = None
    errors: str = ""
    status: int | None = None  # none: it hung


def kind_of(verb: Verb) -> str:
    """What its output is: verbs of one kind can want one name. In place: the file itself is the output."""
    output = verb.outputs[0]
    has_own_name = output in verb.brings or "/" in output or verb.name in ("repair", "regress update")
    return verb.name if has_own_name else Path(output).suffix or "folder"


def pairs(most_seconds: float) -> list[Pair]:
    quick = [verb for verb in VERBS if verb.seconds <= most_seconds]
    return [Pair(first, second, first.outputs[0]) for first, second in itertools.combinations_with_replacement(quick, 2)
            if kind_of(first) == kind_of(second)]  # fmt: skip


def wanting(verb: Verb, name: str) -> list[str]:
    """The words of the verb, with this output."""
    return [name if word == verb.outputs[0] else word for word in verb.command.split()]


def run_together(parties: list[Party], folder: Path, bench: Bench) -> None:
    """Starts and kills each at its moment, and waits for all."""
    events = [(one.starts_s, "start", at) for at, one in enumerate(parties)]
    events += [(one.dies_s, "kill", at) for at, one in enumerate(parties) if one.dies_s is not None]
    begin = time.monotonic()
    for moment, what, at in sorted(events):
        time.sleep(max(0.0, begin + moment - time.monotonic()))
        if what == "start":
            parties[at].process = subprocess.Popen(
                bench.words(" ".join(parties[at].command)), cwd=folder, env=bench.environment, stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True)
        else:
            parties[at].process.kill()
    for one in parties:
        try:
            one.errors = one.process.communicate(timeout=TIME_OUT_S)[1].decode(errors="replace")
            one.status = one.process.returncode
        except subprocess.TimeoutExpired:
            os.killpg(one.process.pid, signal.SIGKILL)
            one.process.wait()


def drawn_party(command: list[str], seconds: float, drawn: random.Random) -> Party:
    start = drawn.uniform(0.0, 0.5 * seconds)
    return Party(command, start, start + drawn.uniform(0.0, 1.5 * seconds) if drawn.random() < 0.3 else None)


def wrong_with_party(party: Party) -> str:
    if party.status is None:
        return f"kerf {' '.join(party.command)} hangs"
    if party.status == KILLED and party.dies_s is not None:
        return ""
    if not 0 <= party.status <= 4:
        return f"kerf {' '.join(party.command)} crashes ({party.status}): {party.errors.strip()[-300:]}"
    if party.status > 1 and not any(line.startswith("kerf: ") for line in party.errors.splitlines()):
        return f"kerf {' '.join(party.command)} ends with {party.status} and says nothing"
    return ""


def are_apart(references: list[Path]) -> bool:
    """Folders that have no name in common."""
    return all(one.is_dir() for one in references) and not set.intersection(*(names_in(one) for one in references))


def try_pair(bench: Bench, pair: Pair, seed: int) -> str:
    """What does not hold when both want the name; nothing if all does."""
    drawn = random.Random(f"{pair} {seed}")
    verbs = (pair.first, pair.second)
    references = [bench.reference(verb)[0] / verb.outputs[0] for verb in verbs]
    folder = bench.working_folder(replace(pair.first, brings=tuple({*pair.first.brings, *pair.second.brings})))
    parties = [drawn_party(wanting(verb, pair.name), verb.seconds, drawn) for verb in verbs]
    run_together(parties, folder, bench)
    for party in parties:
        if wrong := wrong_with_party(party):
            return wrong
    deterministic = not any(verb.is_drawn for verb in verbs)
    done = [at for at, party in enumerate(parties) if party.status == 0]
    output = folder / pair.name
    is_changed_in_place = pair.name in pair.first.brings
    is_replaced = is_changed_in_place or any(verb.replaces for verb in verbs)
    if are_apart(references):  # a folder keeps what both write
        if wrong := wrong_with(bench.kerf, output, references, deterministic):
            return f"{[party.status for party in parties]}: {wrong}"
        lost = [verbs[at].name for at in done if not names_in(references[at]) <= names_in(output)]
        return f"{lost[0]} ends with 0, and its results are not there" if lost else ""
    if len(done) == 2 and not is_replaced:
        return f"both end with 0, and there is one {pair.name}"
    if done and not output.exists():
        return f"{verbs[done[0]].name} ends with 0, and there is no {pair.name}"
    befores = [bench.inputs / pair.name] if is_changed_in_place else []
    whose = [references[at] for at in done] if len(done) == 1 and not is_replaced else references + befores
    complaints = [wrong_with(bench.kerf, output, [one], deterministic) for one in whose]
    return "" if "" in complaints else f"{[party.status for party in parties]}: {complaints[0]}"


def try_readers(bench: Bench, writer: Verb, seed: int) -> str:
    """What readers of its output do not bear while a verb writes."""
    drawn = random.Random(f"{writer.name} {seed}")
    folder = bench.working_folder(writer)
    parties = [drawn_party(writer.command.split(), writer.seconds, drawn)]
    for reader in READERS:
        parties.append(Party(reader.format(file=writer.outputs[0]).split(), drawn.uniform(0.0, writer.seconds), None))
    run_together(parties, folder, bench)
    return next((wrong for party in parties if (wrong := wrong_with_party(party))), "")
