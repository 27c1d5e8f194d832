"""Laws rendered in Python are those that the program renders."""

import math
import pickle
import threading
import unittest

import numpy as np

import kerf
from support import EXAMPLES, InFolder, bits, run

KELVIN = {"parallel_stiffness": 300.0, "series_stiffness": 900.0, "damping": 20.0}
LAWS = sorted(EXAMPLES.glob("*.law.toml"))


def strokes(rows, seed=1):
    """Positions and velocities that go in and out of tissue [m, m/s]."""
    time = 1e-3 * np.arange(1, rows + 1)
    depth = 0.004 * np.sin(7.0 * time) + 0.001 * np.sin(31.0 * time + seed)
    return time, depth, 0.028 * np.cos(7.0 * time) + 0.031 * np.cos(31.0 * time + seed)


class Replay(InFolder):
    @classmethod
    def make(cls):
        cls.recordings = [cls.record("scissors.h5", "sim:scissors"), cls.record("pose.h5", "sim:pose6"),
                          cls.record("axis.h5", "sim:axis")]

    def laws_for(self, recording):
        """Those of the examples whose axes it has: a law along one axis goes on the first of its units."""
        for file in LAWS:
            law = kerf.Law.read(file)
            places = [[place for place, axis in enumerate(recording.axes)
                       if (axis.position_unit, axis.force_unit) == own[1:] and (axis.name == own.name or not law.is_spatial)]
                      for own in law.axes]
            named = [[place for place in some if recording.axes[place].name == own.name] or some for own, some in zip(law.axes, places)]
            if all(named):
                yield file, law, [some[0] for some in named]

    def test_gives_the_bits_of_the_program(self):
        seen = set()
        for path in self.recordings:
            recording = kerf.Recording(path)
            laws = list(self.laws_for(recording))
            out = self.folder / (path.stem + "-replay")
            run("replay", path, "-o", out, *[word for file, _, _ in laws for word in ("--through", file)])
            position, velocity = recording["position"], recording["velocity"]
            for file, law, places in laws:
                by_program = kerf.Recording(out / (file.name.split(".")[0] + ".h5"))["force_commanded"]
                with self.subTest(law=file.name, recording=path.name):
                    replayed = law.replay(recording)
                    self.assertEqual(bits(replayed.force), bits(by_program))
                    columns = places if law.is_spatial else places[0]
                    rendered = law.render(position[:, columns], velocity[:, columns], elapsed=1e-3, on_fault="zero")
                    self.assertEqual(bits(rendered), bits(np.ascontiguousarray(by_program[:, columns])))
                    self.assertTrue(np.any(rendered != 0.0) or law.model in seen or path != self.recordings[-1])
                seen.add(law.model)
        self.assertGreaterEqual(len(seen), 12)

    def test_says_of_a_recording_without_the_axes_of_a_law_which_lack(self):
        law = kerf.Law.read(EXAMPLES / "scissors.law.toml")
        with self.assertRaisesRegex(ValueError, "axis"):
            law.replay(self.recordings[2])


class Rendering(unittest.TestCase):
    def setUp(self):
        self.law = kerf.Law("kelvin", KELVIN)
        self.time, self.depth, self.speed = strokes(500)

    def render(self, depth, speed=None, **options):
        return self.law.render(depth, self.speed if speed is None else speed, elapsed=1e-3, **options)

    def test_is_the_recurrence_of_the_law(self):
        """f' = a f + (b/T)(1 - a) dx, F = max(0, k1 x + f) where nothing touches the arm's floor."""
        law = kerf.Law("kelvin", KELVIN, {"bilateral": True})
        tau, arm, last, expected = 20.0 / 900.0, 0.0, self.depth[0], []
        for x in self.depth:
            arm = math.exp(-1e-3 / tau) * arm + 20.0 / 1e-3 * (1 - math.exp(-1e-3 / tau)) * (x - last)
            last = x
            expected.append(300.0 * x + arm)
        np.testing.assert_allclose(law.render(self.depth, self.speed, elapsed=1e-3, resisting=True), expected, rtol=1e-9, atol=1e-12)

    def test_pushes_back_along_the_axis(self):
        self.assertEqual(bits(self.render(self.depth)), bits(-self.render(self.depth, resisting=True)))
        opening = kerf.Law("kelvin", KELVIN, contact=0.01, direction="decreasing")
        self.assertEqual(bits(opening.render(0.01 - self.depth, -self.speed, elapsed=1e-3)),
                         bits(self.law.render(0.01 - (0.01 - self.depth), self.speed, elapsed=1e-3, resisting=True)))

    def test_is_the_same_in_pieces_and_in_steps(self):
        whole = self.render(self.depth)
        state = self.law.state()
        parts = [self.law.render(self.depth[part], self.speed[part], elapsed=1e-3, state=state)
                 for part in (slice(0, 3), slice(3, 3), slice(3, 500))]
        self.assertEqual(bits(np.concatenate(parts)), bits(whole))
        state = self.law.state()
        steps = np.array([self.law.step(state, x, v, 1e-3) for x, v in zip(self.depth, self.speed)])
        self.assertEqual(bits(steps), bits(whole))

    def test_goes_on_from_a_copy_of_a_state_by_itself(self):
        state = self.law.state()
        self.render(self.depth, state=state)
        copy = state.copy()
        self.assertEqual(copy.stored_energy, state.stored_energy)
        self.law.step(state, 0.01, 1.0, 1e-3)
        self.assertNotEqual(copy.stored_energy, state.stored_energy)

    def test_takes_times_as_elapsed_ones(self):
        by_time = self.law.render(self.depth, self.speed, time=self.time)
        elapsed = np.diff(self.time, prepend=np.nan)
        elapsed[0] = elapsed[1]
        self.assertEqual(bits(by_time), bits(self.law.render(self.depth, self.speed, elapsed=elapsed)))

    def test_takes_any_layout_of_real_numbers(self):
        expected = bits(self.render(self.depth))
        two = np.column_stack([self.depth, self.speed])
        self.assertEqual(bits(self.law.render(two[:, 0], two[:, 1], elapsed=1e-3)), expected)
        fortran = np.asfortranarray(two)
        self.assertEqual(bits(self.law.render(fortran[:, :1], fortran[:, 1:], elapsed=1e-3)), expected)
        self.assertEqual(bits(self.render(self.depth[::-1].copy()[::-1])), expected)
        self.assertEqual(bits(self.render(self.depth.astype(">f8"))), expected)
        self.assertEqual(bits(self.render(list(self.depth))), expected)
        single = self.depth.astype(np.float32)
        self.assertEqual(bits(self.render(single)), bits(self.render(single.astype(np.float64))))
        self.assertEqual(bits(self.render(np.arange(500))), bits(self.render(np.arange(500.0))))

    def test_orders_the_axes_of_a_law_in_space(self):
        law = kerf.Law.read(EXAMPLES / "fuzzy_kelvin_3d.law.toml")
        path = np.stack([strokes(200, seed)[1] for seed in (1, 2, 3)], axis=1)
        expected = law.render(path, np.gradient(path, 1e-3, axis=0), elapsed=1e-3)
        fortran = np.asfortranarray(path)
        self.assertEqual(bits(law.render(fortran, np.asfortranarray(np.gradient(path, 1e-3, axis=0)), elapsed=1e-3)), bits(expected))

    def test_takes_no_row_at_all(self):
        for empty in (np.empty(0), np.empty((0, 1))):
            self.assertEqual(self.law.render(empty, empty, elapsed=1e-3).shape, empty.shape)
            self.assertEqual(self.law.render(empty, empty, time=np.empty(0)).shape, empty.shape)

    def test_gives_no_number_where_there_was_none(self):
        depth = self.depth.copy()
        depth[[7, 20]] = math.nan, math.inf
        force = self.render(depth)
        self.assertEqual(list(np.flatnonzero(np.isnan(force))), [7, 20])
        np.testing.assert_array_equal(self.render(depth, on_fault="zero"), np.nan_to_num(force))
        with self.assertRaisesRegex(ValueError, "position: row 7 is nan"):
            self.render(depth, on_fault="raise")

    def test_derives_velocities_that_are_not_there(self):
        law = kerf.Law.read(EXAMPLES / "hunt_crossley.law.toml")
        into = 0.005 if law.direction == "increasing" else -0.005
        force = law.render(np.linspace(law.contact, law.contact + into, 100), elapsed=1e-3)
        self.assertTrue(np.isfinite(force).all())
        self.assertGreater(np.abs(force).max(), 0.0)


class BadArguments(unittest.TestCase):
    def setUp(self):
        self.law = kerf.Law("kelvin", KELVIN)

    def refuse(self, kind, words, *arguments, **options):
        with self.assertRaisesRegex(kind, words):
            self.law.render(*arguments, **{"elapsed": 1e-3, **options})

    def test_are_refused_by_their_shape(self):
        self.refuse(ValueError, r"position: its shape is \(4, 2\)", np.zeros((4, 2)))
        self.refuse(ValueError, r"position: its shape is \(\)", 0.0)
        self.refuse(ValueError, r"velocity: its shape is \(3,\); expected that of position, \(4,\)", np.zeros(4), np.zeros(3))
        self.refuse(ValueError, r"velocity: its shape is \(4, 1\)", np.zeros(4), np.zeros((4, 1)))
        self.refuse(ValueError, r"elapsed: its shape is \(3,\)", np.zeros(4), elapsed=np.full(3, 1e-3))
        self.refuse(ValueError, r"time: its shape is \(2, 2\)", np.zeros(4), elapsed=None, time=np.zeros((2, 2)))
        space = kerf.Law.read(EXAMPLES / "fuzzy_kelvin_3d.law.toml")
        with self.assertRaisesRegex(ValueError, r"expected \(N, 3\), a column for each of x, y, z"):
            space.render(np.zeros((3, 4)), elapsed=1e-3)

    def test_are_refused_by_their_type(self):
        for wrong in (np.zeros(4, object), np.zeros(4, bool), np.zeros(4, complex), np.array(["1"] * 4), None, "text",
                      np.zeros(4, "M8[s]"), np.ma.masked_array(np.zeros(4), [1, 0, 0, 0]), [[1.0], [1.0, 2.0]]):
            with self.subTest(wrong=repr(wrong)), np.testing.suppress_warnings() as quiet:
                quiet.filter(np.VisibleDeprecationWarning)
                self.refuse(TypeError, "position: ", wrong)

    def test_are_refused_where_float64_would_round_them(self):
        self.refuse(ValueError, "int64 that float64 does not hold exactly", np.array([2**53 + 1]))
        self.refuse(ValueError, "does not hold exactly", np.array([np.longdouble(1) / 3]))

    def test_are_refused_where_time_does_not_pass(self):
        self.refuse(ValueError, "time: the time that passes before row 2 is 0 s", np.zeros(3), elapsed=None, time=[0.0, 0.1, 0.1])
        self.refuse(ValueError, "elapsed: the time that passes before row 1 is nan s", np.zeros(2), elapsed=[1e-3, math.nan])
        self.refuse(ValueError, "elapsed: .* row 0 is -0.001 s", np.zeros(2), elapsed=-1e-3)
        self.refuse(ValueError, "give either time or elapsed", np.zeros(2), time=[0.0, 1.0])
        self.refuse(ValueError, "give either time or elapsed", np.zeros(2), elapsed=None)

    def test_are_refused_in_words(self):
        self.refuse(ValueError, "on_fault: 'stop' is none of nan, zero, raise", np.zeros(2), on_fault="stop")
        with self.assertRaisesRegex(ValueError, "another law"):
            self.law.step(kerf.Law("kelvin", KELVIN).state(), 0.0, 0.0, 1e-3)
        with self.assertRaisesRegex(ValueError, "no direction"):
            kerf.Law.read(EXAMPLES / "fuzzy_kelvin_3d.law.toml").render(np.zeros((2, 3)), elapsed=1e-3, resisting=True)


class Threads(unittest.TestCase):
    def test_render_one_law_at_once(self):
        law = kerf.Law("kelvin", KELVIN)
        motions = [strokes(200_000, seed) for seed in range(4)]
        expected = [bits(law.render(depth, speed, elapsed=1e-3)) for _, depth, speed in motions]
        found = [None] * len(motions)

        def render(place):
            _, depth, speed = motions[place]
            found[place] = bits(law.render(depth, speed, elapsed=1e-3))

        threads = [threading.Thread(target=render, args=(place,)) for place in range(len(motions))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, expected)

    def test_are_refused_a_state_that_another_is_stepping(self):
        law = kerf.Law("kelvin", KELVIN)
        state = law.state()
        _, depth, speed = strokes(3_000_000)
        refusals = []
        begun = threading.Barrier(2)

        def render():
            begun.wait()
            try:
                law.render(depth, speed, elapsed=1e-3, state=state)
            except ValueError as refused:
                refusals.append(str(refused))

        threads = [threading.Thread(target=render) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        # Which of them came first is the scheduler's; a third one finds the state whole.
        self.assertLessEqual(len(refusals), 1)
        for refusal in refusals:
            self.assertIn("another thread", refusal)
        self.assertTrue(math.isfinite(law.step(state, 0.001, 0.0, 1e-3)))


class Making(InFolder):
    def test_says_what_is_wrong(self):
        with self.assertRaisesRegex(ValueError, "unknown law 'kelvn'"):
            kerf.Law("kelvn", {})
        with self.assertRaisesRegex(ValueError, "1 of 3 parameters are missing"):
            kerf.Law("kelvin", {"parallel_stiffness": 1.0, "damping": 1.0})
        with self.assertRaisesRegex(ValueError, "unknown parameter 'mass'"):
            kerf.Law("kelvin", {**KELVIN, "mass": 1.0})
        with self.assertRaisesRegex(ValueError, "'damping' is -1"):
            kerf.Law("kelvin", {**KELVIN, "damping": -1.0})
        with self.assertRaisesRegex(ValueError, "option"):
            kerf.Law("kelvin", KELVIN, {"colour": "red"})
        with self.assertRaisesRegex(ValueError, "direction"):
            kerf.Law("kelvin", KELVIN, direction="up")
        with self.assertRaisesRegex(ValueError, '"inch"'):
            kerf.Law("kelvin", KELVIN, position_unit="inch")

    def test_says_of_a_file_where_it_is_wrong(self):
        file = self.folder / "wrong.law.toml"
        file.write_text((EXAMPLES / "kelvin.law.toml").read_text().replace("[parameters]", "[parameter]"))
        with self.assertRaisesRegex(ValueError, r"wrong\.law\.toml:\d+: "):
            kerf.Law.read(file)
        with self.assertRaisesRegex(ValueError, "no such file"):
            kerf.Law.read(self.folder / "none.law.toml")

    def test_reads_back_what_it_writes(self):
        for path in LAWS:
            law = kerf.Law.read(path)
            file = self.folder / path.name
            law.write(file)
            again = kerf.Law.read(file)
            for copy in (again, pickle.loads(pickle.dumps(law))):
                self.assertEqual(copy.parameters.keys(), law.parameters.keys())
                self.assertEqual([one.value for one in copy.parameters.values()], [one.value for one in law.parameters.values()])
                self.assertEqual((copy.options, copy.contact, copy.direction, copy.axes), (law.options, law.contact, law.direction, law.axes))
            with self.assertRaises(OSError):
                law.write(file)
            law.write(file, replace=True)

    def test_tells_units(self):
        law = kerf.Law("kelvin", KELVIN, axis="theta", position_unit="rad", force_unit="N·m")
        self.assertEqual(law.parameters["damping"].unit, "N·m·s/rad")
        self.assertEqual(law.axes, (kerf.LawAxis("theta", "rad", "N·m"),))
        self.assertTrue(math.isnan(law.parameters["damping"].std_error))


if __name__ == "__main__":
    unittest.main()
