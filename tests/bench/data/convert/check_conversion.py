"""check_conversion.py READER FOLDER NAME...: holds FOLDER/NAME, a converted recording of the reader's ending, against FOLDER/NAME.h5 as h5py
reads it, number by number and bit by bit; exits with 77 where a reader is not installed. Readers that are not Kerf's: pandas, SciPy,
Octave, Foxglove's of MCAP (mcap_core:NODE:NODE_MODULES), and mcap_reader.py beside this file, which looks at every byte."""

import csv
import json
import math
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import h5py
    import numpy
    import pandas
    import scipy.io
except ImportError as missing:
    print(missing)
    sys.exit(77)

import mcap_reader


def text(value) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


class Expected:
    """Columns of the recording by name, in order: values, unit."""

    def __init__(self, path: str):
        with h5py.File(path) as file:
            samples = file["samples"]
            axes = [text(axis) for axis in samples.attrs["axes"]]
            self.columns = {}
            for name in ("time", "tick"):
                self.add(name, samples[name])
            for name in ("position", "velocity", "force_commanded", "force_measured"):
                if name in samples:
                    for i, axis in enumerate(axes):
                        self.columns[f"{name}.{axis}"] = (samples[name][:, i], text(samples[name].attrs["units"][i]))
            for name, channel in sorted(samples.get("channels", {}).items()):
                self.add(f"channel.{name}", channel)
            for name in ("wake_latency", "read_time", "compute_time", "write_time", "flags"):
                if name in samples:
                    self.add(name, samples[name])
            self.events = [(float(e["time"]), text(e["kind"]), text(e["text"])) for e in file["events"]]
            self.start_ns = int(file.attrs.get("start_ns", 0))
            self.uuid = text(file.attrs["uuid"])
            device = file.get("device")
            self.device_toml = text(device.attrs["toml"]) if device is not None and "toml" in device.attrs else None

    def add(self, name, dataset):
        self.columns[name] = (dataset[:], text(dataset.attrs["units"]))


def same(got, wanted) -> bool:
    got = numpy.asarray(got, dtype=wanted.dtype)
    if wanted.dtype.kind != "f":
        return numpy.array_equal(got, wanted)
    nan = numpy.isnan(wanted)
    bits = f"u{wanted.dtype.itemsize}"
    return numpy.array_equal(numpy.isnan(got), nan) and numpy.array_equal(got[~nan].view(bits), wanted[~nan].view(bits))


def check_csv(path: str, expected: Expected):
    # As floats where they are: a column of whole numbers alone would come as integers, which have no -0.
    headings = {f"{name} [{unit}]": values for name, (values, unit) in expected.columns.items()}
    kinds = {heading: values.dtype.name.replace("float32", "float64") for heading, values in headings.items()}
    table = pandas.read_csv(path, float_precision="round_trip", dtype=kinds)
    assert sorted(table.columns) == sorted(headings), list(table.columns)
    for heading, values in headings.items():
        assert same(table[heading].to_numpy(), values), heading
    with open(path.replace(".csv", ".dictionary.csv"), encoding="utf-8", newline="") as file:
        dictionary = list(csv.DictReader(file))
    assert [row["column"] for row in dictionary] == list(table.columns)
    assert all(row["description"] and row["source"].startswith("/samples/") for row in dictionary)
    if expected.events:
        with open(path.replace(".csv", ".events.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))[1:]
        assert [(float(time), kind, said) for time, kind, said in rows] == expected.events


def check_mat(path: str, expected: Expected):
    mat = scipy.io.loadmat(path)
    units = mat["units"][0, 0]
    names = {name: "".join(c if c.isascii() and c.isalnum() else "_" for c in name) for name in expected.columns}
    assert sorted(str(row[0][0]) for row in mat["dictionary"]) == sorted(names.values())
    for name, (values, unit) in expected.columns.items():
        got = mat[names[name]]
        assert got.dtype == values.dtype and got.shape == (len(values), 1), name
        assert same(got[:, 0], values), name
        assert str(units[names[name]][0]) == unit.replace("·", "*"), name
    about = {str(row[0][0]): str(row[1][0]) for row in mat["about"]}
    assert about["uuid"] == expected.uuid
    assert about.get("device_toml") == expected.device_toml
    assert mat["rows"][0, 0] == len(expected.columns["time"][0])
    if expected.events:
        said = [(float(row[0][0]), *(str(cell[0]) if cell.size else "" for cell in row[1:])) for row in mat["events"]]
        assert said == expected.events, said


def flat(topic: str, message: dict) -> dict:
    found = {}
    for key, value in message.items():
        if isinstance(value, dict):
            found.update({f"{key}.{inner}": number for inner, number in value.items()})
        else:
            found[f"channel.{key}" if topic == "/kerf/channels" else key] = value
    return found


# Each variable as its bytes, in a file of its name; then what units it has.
OCTAVE = """
s = load(argv(){1});
names = setdiff(fieldnames(s), {"units", "dictionary", "about", "events"});
for i = 1:numel(names)
  file = fopen(fullfile(argv(){2}, names{i}), "w");
  fwrite(file, s.(names{i}), class(s.(names{i})));
  fclose(file);
endfor
units = fieldnames(s.units);
for i = 1:numel(units)
  printf("%s %s\\n", units{i}, s.units.(units{i}));
endfor
"""


def check_by_octave(path: str, expected: Expected):
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / "script.m"
        script.write_text(OCTAVE)
        said = subprocess.run(["octave-cli", "--norc", "--quiet", script, path, folder], check=True, capture_output=True, text=True)
        units = dict(line.split(" ") for line in said.stdout.splitlines())
        for name, (values, unit) in expected.columns.items():
            variable = "".join(c if c.isascii() and c.isalnum() else "_" for c in name)
            assert same(numpy.fromfile(f"{folder}/{variable}", values.dtype), values), name
            assert units[variable] == unit.replace("·", "*"), name


class McapByCore:
    """What Foxglove's reader says, in the shape of mcap_reader.Mcap."""

    def __init__(self, path: str, node: str, modules: str):
        script = Path(__file__).with_name("read_mcap.mjs")
        read = json.loads(subprocess.run([node, script, path, modules], check=True, capture_output=True).stdout)
        self.schemas = {int(number): tuple(schema) for number, schema in read["schemas"].items()}
        self.channels = {int(number): tuple(channel) for number, channel in read["channels"].items()}
        self.messages = [(channel, sequence, int(log), int(publish), data) for channel, sequence, log, publish, data in read["messages"]]
        self.metadata = read["metadata"]
        self.attachments = {name: data.encode() for name, data in read["attachments"].items()}


def check_mcap(path: str, expected: Expected, reader=mcap_reader.Mcap):
    mcap = reader(path)
    times = expected.columns["time"][0]
    log_times = [expected.start_ns + round(1e9 * float(time)) for time in times]
    by_topic = {}
    for channel, sequence, log, publish, data in mcap.messages:
        assert log == publish
        by_topic.setdefault(mcap.channels[channel][1], []).append((sequence, log, json.loads(data)))
    seen = set()
    for schema_number, topic, encoding, units in mcap.channels.values():
        assert encoding == "json" and mcap.schemas[schema_number][1] == "jsonschema"
        schema = json.loads(mcap.schemas[schema_number][2])
        assert schema["type"] == "object"
        if topic == "/kerf/events":
            assert mcap.schemas[schema_number][0] == "foxglove.Log"
            continue
        described = flat(topic, {key: value.get("properties", value) if value["type"] == "object" else 0
                                 for key, value in schema["properties"].items()})
        assert dict(units) == {name: expected.columns[name][1] for name in described}
        messages = by_topic.pop(topic, [])
        assert [log for _, log, _ in messages] == log_times
        assert [sequence for sequence, _, _ in messages] == [int(tick) & 0xFFFFFFFF for tick in expected.columns["tick"][0]]
        rows = [flat(topic, message) for _, _, message in messages]
        assert all(set(row) <= set(described) for row in rows)
        for name in described:
            values = expected.columns[name][0]
            seen.add(name)
            for row, value in zip(rows, values):
                assert (name in row) == math.isfinite(value), name
            finite = numpy.isfinite(values)
            assert same([row[name] for row in rows if name in row], values[finite]), name
    assert seen == set(expected.columns)
    said = [(log - expected.start_ns, message["message"]) for _, log, message in by_topic.pop("/kerf/events", [])]
    assert said == [(round(1e9 * time), kind + (": " + what if what else "")) for time, kind, what in expected.events], said
    assert not by_topic
    assert mcap.metadata["kerf.recording"]["uuid"] == expected.uuid
    if expected.device_toml:
        assert mcap.attachments["device.toml"].decode() == expected.device_toml


def main() -> int:
    reader, folder, *names = sys.argv[1:]
    reader, *where = reader.split(":")
    check, ending = {
        "pandas": (check_csv, "csv"),
        "scipy": (check_mat, "mat"),
        "octave": (check_by_octave, "mat"),
        "mcap": (check_mcap, "mcap"),
        "mcap_core": (lambda path, expected: check_mcap(path, expected, lambda path: McapByCore(path, *where)), "mcap"),
    }[reader]
    if reader == "octave" and not shutil.which("octave-cli"):
        print("Octave is not installed")
        return 77
    for name in names:
        print(name)
        check(f"{folder}/{name}.{ending}", Expected(f"{folder}/{name}.h5"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
