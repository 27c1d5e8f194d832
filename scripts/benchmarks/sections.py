"""The sections of docs/benchmarks.md, one a subject."""

import pathlib
import platform
import re
from datetime import date

HEAD = """# Benchmarks

Made by `scripts/benchmark SUBJECT`; each section by its own run. Absolute times drift on shared machines:
read the ratios.
"""


def replace_section(path, subject, title, body):
    text = path.read_text() if path.exists() else HEAD
    block = "<!-- %s -->\n## %s\n\n%s, %s\n\n%s\n<!-- end -->\n" % (subject, title, machine(), date.today(), body)
    pattern = re.compile(r"<!-- %s -->.*?<!-- end -->\n" % subject, re.S)
    text = pattern.sub(lambda _: block, text) if pattern.search(text) else text + "\n" + block
    path.write_text(text)


def machine():
    model = re.search(r"model name\s*:\s*(.*)", pathlib.Path("/proc/cpuinfo").read_text())
    cores = len(re.findall(r"^processor", pathlib.Path("/proc/cpuinfo").read_text(), re.M))
    return "%s, %d cores, Linux %s" % (model.group(1) if model else platform.machine(), cores, platform.release().split("-")[0])
