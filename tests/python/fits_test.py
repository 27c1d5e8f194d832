"""Fits from Python are those of `kerf fit`, and results of the program are read back."""

import json
import math
import unittest

import kerf
from support import EXAMPLES, InFolder, run, run_json


def without_times(values):
    """Nothing else of a fit differs from run to run, but of which build it is."""
    if isinstance(values, dict):
        return {name: without_times(one) for name, one in values.items() if name not in ("seconds", "software")}
    return [without_times(one) for one in values] if isinstance(values, list) else values


class Fits(InFolder):
    @classmethod
    def make(cls):
        cls.punch = cls.import_punch()
        cls.by_program = run_json("fit", cls.punch, "--models", "kelvin,exponential", "-o", cls.folder / "fits")
        cls.fits = kerf.fit(cls.punch, ["kelvin", "exponential"])

    def test_have_the_numbers_of_the_program(self):
        self.assertEqual(json.dumps(without_times(self.fits.json)), json.dumps(without_times(self.by_program)))

    def test_take_the_options_of_the_program(self):
        by_program = run_json("fit", self.punch, "--models", "kelvin,piecewise", "--segments", "3", "--cycles", "2-4", "--rows", "all",
                              "--folds", "3", "--loss", "huber", "--confidence", "0.9", "--contact", "0.55", "--direction", "decreasing",
                              "--option", "integrator=semi_implicit", "--weber", "0.1", "--jnd-source", "nobody", "--noise", "0.02", "-o",
                              self.folder / "options")
        fits = kerf.fit(kerf.Recording(self.punch), ["kelvin", "piecewise"], segments=3, cycles="2-4", rows="all", folds=3, loss="huber",
                        confidence=0.9, contact=0.55, direction="decreasing", options={"integrator": "semi_implicit"}, weber=0.1,
                        jnd_source="nobody", noise=0.02)
        self.assertEqual(json.dumps(without_times(fits.json)), json.dumps(without_times(by_program)))

    def test_are_objects_with_units(self):
        kelvin = self.fits["kelvin"]
        damping = kelvin.parameters["damping"]
        there = self.by_program["fits"][0]["parameters"]["damping"]
        self.assertEqual((damping.value, damping.std_error, damping.lower, damping.upper), (there["value"], there["std_error"], *there["ci95"]))
        self.assertEqual((damping.unit, self.fits.force_unit), ("N·s/rad", "N"))
        self.assertEqual(list(self.fits), ["kelvin", "exponential"])
        self.assertEqual(self.fits.choice.why, self.by_program["choice"]["why"])
        self.assertEqual(self.fits.chosen.model, self.fits.choice.model)
        self.assertTrue(kelvin.converged and 0.0 < kelvin.r2 < 1.0 and kelvin.rmse > 0.0)

    def test_hold_the_laws_that_the_program_writes(self):
        for model in self.fits:
            by_program = kerf.Law.read(self.folder / "fits" / (model + ".law.toml"))
            law = self.fits[model].law
            self.assertEqual(law.parameters, by_program.parameters)
            self.assertEqual((law.options, law.contact, law.direction), (by_program.options, by_program.contact, by_program.direction))

    def test_write_what_the_program_writes(self):
        folder = self.folder / "written"
        self.fits.write(folder)
        self.assertEqual(sorted(file.name for file in folder.iterdir()), sorted(file.name for file in (self.folder / "fits").iterdir()))
        ours, theirs = ((one / "fit.csv").read_text() for one in (folder, self.folder / "fits"))
        self.assertEqual(ours, theirs)
        with self.assertRaisesRegex(ValueError, "exists; replace=True replaces it"):
            self.fits.write(folder)
        self.fits.write(folder, replace=True)

    def test_say_what_is_wrong_in_words_of_python(self):
        for words, options in (("folds: 1 is not from 2 to 100", {"folds": 1}), ("test_share: 2 is not", {"test_share": 2.0}),
                               ("loss_scale needs a robust loss", {"loss_scale": 1.0}), ("loss: 'l1' is none of", {"loss": "l1"}),
                               ("rows: 'some'", {"rows": "some"}), ("direction: 'up'", {"direction": "up"}),
                               ("segments: '0'", {"segments": 0}), ("noise: 2 values for 1 recordings", {"noise": [1.0, 2.0]}),
                               ("noise: -1 is not", {"noise": -1.0}), ("rate: nan", {"rate": math.nan}),
                               ("arms: 9 is not from 1 to 6", {"arms": 9}), ("weber: 3", {"weber": 3.0}),
                               ("there is no axis|has no axis|axis 'z'", {"axis": "z"}), ("per_recording needs", {"per_recording": ["damping"]})):
            with self.subTest(options=options), self.assertRaisesRegex(ValueError, words):
                kerf.fit(self.punch, "kelvin", **options)
        with self.assertRaisesRegex(ValueError, "kelvn"):
            kerf.fit(self.punch, "kelvn")
        with self.assertRaisesRegex(ValueError, "slice"):
            kerf.fit(kerf.Recording(self.punch)[:100])
        with self.assertRaisesRegex(ValueError, "expected a recording"):
            kerf.fit([])
        with self.assertRaises(kerf.FormatError):
            kerf.fit(EXAMPLES / "data/punch.txt")

    def test_are_loaded_with_their_laws(self):
        fits = kerf.load(self.folder / "fits" / "fit.json")
        self.assertEqual(fits["kelvin"].parameters, self.fits["kelvin"].parameters)
        self.assertEqual(fits["kelvin"].law.parameters["damping"].value, fits["kelvin"].parameters["damping"].value)
        with self.assertRaises(ValueError):
            fits.write(self.folder / "again")


class Results(InFolder):
    @classmethod
    def make(cls):
        cls.punch = cls.import_punch()

    def test_are_what_their_file_says(self):
        file = self.folder / "check.json"
        run("check", EXAMPLES / "kelvin.law.toml", "--device", "sim:scissors", "--virtual", "--seconds", "1", "-o", file)
        check = kerf.load(file)
        self.assertEqual((check, check.kind), (json.loads(file.read_text()), "check"))

    def test_know_units_by_names(self):
        result = kerf.Result({"worst_at_s": 1.0, "loop": {"rate_hz": 1000.0, "ticks": 3}, "value": 2.0, "unit": "N/m", "list": [{"d_m": 1}]}, "x.json")
        self.assertEqual([result.unit(key) for key in ("worst_at_s", "loop.rate_hz", "loop.ticks", "value", "list.0.d_m")],
                         ["s", "Hz", None, "N/m", "m"])
        with self.assertRaises(KeyError):
            result.unit("loop.size")

    def test_are_told_apart_by_their_names(self):
        self.assertIsInstance(kerf.load(EXAMPLES / "kelvin.law.toml"), kerf.Law)
        self.assertIsInstance(kerf.load(self.punch), kerf.Recording)
        wrong = self.folder / "wrong.json"
        wrong.write_text("{")
        with self.assertRaisesRegex(ValueError, "wrong.json: no JSON"):
            kerf.load(wrong)
        wrong.write_text("[1]")
        with self.assertRaisesRegex(ValueError, "expected an object"):
            kerf.load(wrong)
        with self.assertRaisesRegex(ValueError, "expected a law file"):
            kerf.load(self.folder / "page.html")
        with self.assertRaises(OSError):
            kerf.load(self.folder / "none.json")


if __name__ == "__main__":
    unittest.main()
