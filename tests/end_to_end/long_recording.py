"""What the verbs take for a recording of many rows: their largest memory and their time."""

import os
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Cost:
    seconds: float
    mebibytes: float  # the most that the program, or its reader, had at once


def run(command: list[str | Path], folder: Path, while_it_runs: Callable[[subprocess.Popen], None] | None = None) -> Cost:
    """Runs a program to its end, calling what is to be called some hundred times a second; what fails raises with its errors."""
    begin = time.monotonic()
    with open(folder / "errors", "w+b") as errors:
        child = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=errors)
        done = 0
        while while_it_runs and not done:
            while_it_runs(child)
            time.sleep(0.005)
            done, status, usage = os.wait4(child.pid, os.WNOHANG)
        if not done:
            _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            errors.seek(0)
            raise RuntimeError(f"{' '.join(map(str, command))}: {errors.read().decode().strip()}")
    return Cost(time.monotonic() - begin, usage.ru_maxrss / 1024)


def looks(name: str) -> dict[str, list[str]]:
    """Everything that goes through all rows of a recording, in an order that can be run; by the verb."""
    return {
        "info": ["info", name],
        "validate": ["validate", name],
        "segment": ["segment", name, "-o", "charts"],
        "report": ["report", name, "-o", "report.html", "--force"],
    }


def record_command(kerf: Path, name: str, rows: int) -> list[str | Path]:
    return [kerf, "record", "--device", "sim:scissors", "--virtual", "--seconds", f"{rows / 1000}", "-o", name]


BYTES_A_ROW = 100  # at least


def repair(kerf: Path, rows: int, folder: Path) -> Cost:
    """What it takes to close a recording that was killed after at least so many rows; nothing is left of it."""
    partial = folder / "killed.h5.partial"
    with subprocess.Popen(record_command(kerf, "killed.h5", rows + rows // 10), cwd=folder, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL) as child:
        while child.poll() is None and not (partial.exists() and partial.stat().st_size >= BYTES_A_ROW * rows):
            time.sleep(0.005)
        child.kill()
    cost = run([kerf, "repair", "killed.h5"], folder)
    (folder / "killed.h5").unlink()
    return cost
