"""Recordings read from Python are what the file holds."""

import csv
import gc
import math
import multiprocessing
import pathlib
import threading
import unittest

import h5py
import numpy as np

import kerf
from support import InFolder, bits, run


def readers():
    """How many processes this one has that read files."""
    children = pathlib.Path("/proc/self/task").glob("*/children")
    pids = [pid for file in children for pid in file.read_text().split()]
    return sum(pathlib.Path("/proc", pid, "comm").read_text().strip() == "kerf-reader" for pid in pids)


def read_in_a_fork(recording, answers):
    answers.put(bits(recording["position"]))


class Recordings(InFolder):
    @classmethod
    def make(cls):
        cls.punch = cls.import_punch()
        cls.scissors = cls.record("scissors.h5", "sim:scissors")
        cls.pose = cls.record("pose.h5", "sim:pose6", seconds=0.5)

    def altered(self, name, change):
        """A copy of a recording, changed by h5py."""
        file = self.folder / name
        file.write_bytes(self.scissors.read_bytes())
        with h5py.File(file, "r+") as opened:
            change(opened["samples"])
        return file

    def test_have_the_bits_of_the_file(self):
        for path in (self.punch, self.scissors, self.pose):
            recording = kerf.Recording(path)
            with h5py.File(path) as opened:
                for name, dataset in opened["samples"].items():
                    if not isinstance(dataset, h5py.Dataset):
                        continue
                    with self.subTest(path=path.name, name=name):
                        column, there = recording[name], dataset[()]
                        self.assertEqual((column.dtype, column.shape), (there.dtype.newbyteorder("="), there.shape))
                        self.assertEqual(bits(column), bits(there))
                self.assertEqual(recording.header["uuid"], opened.attrs["uuid"].decode() if isinstance(opened.attrs["uuid"], bytes)
                                 else opened.attrs["uuid"])

    def test_name_columns_as_convert_does(self):
        for path in (self.punch, self.scissors, self.pose):
            table = self.folder / (path.stem + ".csv")
            run("convert", path, "-o", table)
            with table.open(encoding="utf-8") as lines:
                rows = csv.reader(lines)
                head = next(rows)
                first = next(rows)
            recording = kerf.Recording(path)
            self.assertEqual(["%s [%s]" % (name, recording.units[name]) for name in recording.columns], head)
            for name, text in zip(recording.columns, first):
                np.testing.assert_equal(float(recording[0:1][name][0]), float(np.dtype(recording[0:0][name].dtype).type(text)))

    def test_give_slices_of_their_rows(self):
        recording = kerf.Recording(self.pose)
        for rows in (slice(10, 20), slice(-5, None), slice(None, 0), slice(400, 300), slice(0, 10**9)):
            part = recording[rows]
            self.assertEqual(len(part), len(range(500)[rows]))
            for name in ("time", "position", "position.rx", "flags", "wake_latency"):
                self.assertEqual(bits(part[name]), bits(np.ascontiguousarray(recording[name][rows])))
        self.assertEqual(bits(recording[100:200][50:60]["tick"]), bits(recording["tick"][150:160]))
        with self.assertRaisesRegex(ValueError, "without a step"):
            recording[::2]

    def test_are_lazy(self):
        """What is about a file is read when it is opened; rows that are damaged are found by whoever asks for them."""
        def damage(samples):
            del samples["flags"]
            samples.create_dataset("flags", data=np.zeros(len(samples["time"]), np.uint32), chunks=(len(samples["time"]),), compression="gzip")
        file = self.altered("damaged.h5", damage)
        with h5py.File(file) as opened:
            chunk = opened["samples/flags"].id.get_chunk_info(0)
        with file.open("r+b") as raw:
            raw.seek(chunk.byte_offset)
            raw.write(b"\xff" * chunk.size)
        recording = kerf.Recording(file)
        self.assertEqual(len(recording["time"]), len(recording))
        with self.assertRaises(kerf.FormatError):
            recording["flags"]

    def test_become_frames_with_units(self):
        frame = kerf.Recording(self.scissors).frame()
        recording = kerf.Recording(self.scissors)
        self.assertEqual(list(frame.columns), list(recording.columns))
        for name in recording.columns:
            self.assertEqual(bits(frame[name].to_numpy()), bits(recording[name]))
        self.assertEqual(frame.attrs["units"]["position.theta"], "rad")
        self.assertEqual(frame.attrs["uuid"], recording.header["uuid"])
        few = recording[5:7].frame(["time", "position.x_s"])
        self.assertEqual((few.shape, list(few.columns)), ((2, 2), ["time", "position.x_s"]))

    def test_say_which_columns_they_have(self):
        recording = kerf.Recording(self.punch)
        for wrong in ("place", "channel", "position.z", "force_commanded", ""):
            self.assertNotIn(wrong, recording)
            with self.assertRaisesRegex(KeyError, "it has time, tick, position.position"):
                recording[wrong]
        self.assertIn("position", recording)
        for wrong in (0, None, 1.5):
            with self.assertRaises(TypeError):
                recording[wrong]
        with self.assertRaises(TypeError):
            iter(recording)
        with self.assertRaises(TypeError):
            recording.arrays("time")

    def test_have_no_rows_where_there_are_none(self):
        def empty(samples):
            for dataset in samples.values():
                dataset.resize(0, axis=0)
        recording = kerf.Recording(self.altered("empty.h5", empty))
        self.assertEqual((len(recording), recording.period), (0, 0.0))
        self.assertEqual((recording["time"].shape, recording["position"].shape), ((0,), (0, 2)))
        self.assertEqual(recording.frame().shape, (0, len(recording.columns)))
        self.assertTrue(math.isnan(recording["time"].sum() or math.nan))

    def test_keep_gaps_and_what_is_no_number(self):
        def holes(samples):
            samples["tick"][100:] = samples["tick"][100:] + 50
            samples["position"][7, 1] = math.nan
            samples["force_commanded"][8, 0] = -0.0
            samples["time"][9] = math.inf
        recording = kerf.Recording(self.altered("holes.h5", holes))
        self.assertEqual(int(np.diff(recording["tick"].astype(np.int64)).max()), 51)
        self.assertTrue(math.isnan(recording["position.x_s"][7]) and math.isinf(recording["time"][9]))
        self.assertTrue(np.signbit(recording["force_commanded"][8, 0]))
        with self.assertRaisesRegex(ValueError, "row 7"):
            kerf.Law("kelvin", {"parallel_stiffness": 3.0, "series_stiffness": 9.0, "damping": 2.0}, axis="theta", position_unit="rad",
                     force_unit="N·m").replay(self.folder / "holes.h5")

    def test_tell_their_axes_events_and_cycles(self):
        recording = kerf.Recording(self.scissors)
        self.assertEqual([(axis.name, axis.position_unit, axis.force_unit) for axis in recording.axes], [("theta", "rad", "N"), ("x_s", "m", "N")])
        self.assertEqual(recording.events[0].kind, "soft_start")
        self.assertIsNone(recording.cycles)
        cycles = kerf.Recording(self.punch).cycles
        self.assertEqual((cycles.axis, cycles.closing.shape), ("position", (7, len(cycles.grid))))
        self.assertEqual({phase.phase for phase in cycles.phases} - {"opening", "open_to_close", "closing", "close_to_open"}, set())
        self.assertTrue(kerf.Recording(self.punch).cycle_flags[0].reason)
        self.assertEqual(kerf.Recording(self.punch).cycle_edits, ())

    def test_tell_who_changed_their_cycles(self):
        edited = self.folder / "edited.h5"
        edited.write_bytes(self.punch.read_bytes())
        run("segment", edited, "--merge", 2, "--by", "Ada")
        before, after = kerf.Recording(self.punch), kerf.Recording(edited)
        self.assertEqual(len(after.cycles.closing), len(before.cycles.closing) - 1)
        (change,) = after.cycle_edits
        self.assertEqual((change.edit, change.cycle, change.kind), (1, 2, "merged"))
        self.assertTrue(change.author == "Ada" and change.text and change.time.endswith("Z"), change)
        third = [phase for phase in before.cycles.phases if phase.cycle == 3]
        self.assertEqual((change.row_before, change.row_after), (third[0].begin, None))

    def test_are_refused_in_one_line(self):
        text = self.folder / "text.h5"
        text.write_text("no recording")
        for path, kind, words in ((text, kerf.FormatError, "not an HDF5 file"), (self.folder / "none.h5", ValueError, "no such file"),
                                  (self.folder, ValueError, "not a file")):
            with self.assertRaisesRegex(kind, words) as refused:
                kerf.Recording(path)
            self.assertNotIn("\n", str(refused.exception))
        self.assertTrue(issubclass(kerf.FormatError, ValueError))

    def test_end_their_reader_when_they_are_closed(self):
        gc.collect()
        before = readers()
        with kerf.Recording(self.pose) as recording:
            part = recording[:5]
            self.assertEqual(readers(), before + 1)
        self.assertEqual(readers(), before)
        for closed in (recording, part):
            with self.assertRaisesRegex(ValueError, "closed"):
                closed["time"]
        del part
        kept = kerf.Recording(self.pose)[:5]
        self.assertEqual(readers(), before + 1)
        del kept
        gc.collect()
        self.assertEqual(readers(), before)

    def test_are_read_by_two_threads_at_once(self):
        recording = kerf.Recording(self.scissors)
        expected = {name: bits(recording[name]) for name in recording.columns}
        wrong = []

        def read():
            for _ in range(5):
                wrong.extend(name for name in recording.columns if bits(recording[name]) != expected[name])

        threads = [threading.Thread(target=read) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])

    def test_are_read_anew_by_a_process_that_is_forked_off(self):
        recording = kerf.Recording(self.pose)
        fork = multiprocessing.get_context("fork")
        answers = fork.Queue()
        child = fork.Process(target=read_in_a_fork, args=(recording, answers))
        child.start()
        self.assertEqual(answers.get(timeout=60), bits(recording["position"]))
        child.join()
        self.assertEqual(bits(recording["position"]), bits(kerf.Recording(self.pose)["position"]))

    def test_are_checked_against_the_schema(self):
        self.assertEqual(kerf.validate(self.pose), [])

        def drop(samples):
            del samples["velocity"]
        found = kerf.validate(self.altered("invalid.h5", drop))
        self.assertTrue(any("velocity" in one.where for one in found))


if __name__ == "__main__":
    unittest.main()
