"""Uses the module liver.py of the folder given as users do, well and badly. Ends with 77 where there is no NumPy."""

import math
import os
import subprocess
import sys
import threading

folder = sys.argv[1]
sys.path.insert(0, folder)
os.environ["XDG_CACHE_HOME"] = os.path.join(folder, "cache")

import liver

count = 500
position = [0.4 + 0.1 * math.sin(i / 30) for i in range(count)]
velocity = [math.cos(i / 30) / 3 for i in range(count)]
expected = liver.Law().render(position, velocity, 0.001)
assert type(expected) is list and len(expected) == count and max(expected) > 1.0

law = liver.Law()
assert [law.step(x, v, 0.001) for x, v in zip(position, velocity)] == expected
law.reset()
assert law.render(position, velocity, [0.001] * count) == expected

law.reset()
law.render(position[:200], velocity[:200], 0.001)
saved = law.save()
assert law.render(position[200:], velocity[200:], 0.001) == expected[200:]
another = liver.Law()
another.restore(saved)
assert another.render(position[200:], velocity[200:], 0.001) == expected[200:]
assert law.render([], [], 0.001) == []


def refused(kind, why, call):
    law.restore(saved)
    try:
        call()
    except kind as error:
        assert why in str(error), "%r does not say %r" % (str(error), why)
        assert law.save() == saved, "after '%s' the law is elsewhere" % why
        return
    raise AssertionError("not refused: " + why)


nan = float("nan")
refused(TypeError, "position is of type str; expected a number", lambda: law.step("0.4", 0, 0.001))
refused(TypeError, "velocity is of type complex; expected a number", lambda: law.step(0.4, 1j, 0.001))
refused(TypeError, "position is of type list; expected a number", lambda: law.step([0.4], 0, 0.001))
refused(ValueError, "position is nan; expected a finite number", lambda: law.step(nan, 0, 0.001))
refused(ValueError, "elapsed_s is 0.0; expected seconds, more than zero", lambda: law.step(0.4, 0, 0))
refused(ArithmeticError, "the force at position -1e+308 and velocity 0.0 is not finite",
        lambda: law.step(-1e308, 0, 0.001))
refused(ValueError, "velocity of tick 1 is nan; expected a finite number",
        lambda: law.render([0.4, 0.4], [0.0, nan], 0.001))
refused(ValueError, "elapsed_s of tick 1 is -1.0; expected seconds, more than zero",
        lambda: law.render([0.4, 0.4], [0.0, 0.0], [0.001, -1.0]))
refused(ArithmeticError, "the force of tick 1, at position -1e+308 and velocity 0.0, is not finite",
        lambda: law.render([0.4, -1e308], [0.0, 0.0], 0.001))
refused(ValueError, "2 positions, 1 velocities and 1 elapsed times; expected as many of each",
        lambda: law.render([0.4, 0.4], [0.0], 0.001))
refused(ValueError, "2 positions, 2 velocities and 1 elapsed times", lambda: law.render([1, 2], [1, 2], [0.001]))
refused(TypeError, "position is of type bytes; expected a sequence of numbers",
        lambda: law.render(b"12345678", [0.0], 0.001))
refused(TypeError, "position: ", lambda: law.render([[0.4]], [0.0], 0.001))
refused(TypeError, "position: ", lambda: law.render(0.4, 0.0, 0.001))
refused(ValueError, "no state of this law; expected what save() gave", lambda: law.restore(saved[1:]))
refused(ValueError, "no state of this law", lambda: law.restore(b"\0" * len(saved)))

about = liver.describe()
assert about["model"] == "kelvin" and about["parameters"][0]["unit"] == "N·s/rad" and '"""' in about["equation"]
assert liver.SHA256.startswith("0123456789abcdef")

# Threads, each with a law of its own.
results = {}


def render(name):
    results[name] = liver.Law().render(position, velocity, 0.001)


threads = [threading.Thread(target=render, args=(name,)) for name in range(8)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
assert all(results[name] == expected for name in range(8))

# Compiled once: another process needs no compiler, one with an empty cache says that there is none.
kept = os.listdir(os.path.join(folder, "cache", "kerf", "laws"))
assert len(kept) == 1 and kept[0].startswith("liver-"), kept
script = "import sys; sys.path.insert(0, sys.argv[1]); import liver; print(liver.Law().step(0.4, 0.0, 0.001))"
done = subprocess.run([sys.executable, "-B", "-c", script, folder], stdout=subprocess.PIPE,
                      env={"XDG_CACHE_HOME": os.environ["XDG_CACHE_HOME"], "PATH": "/nowhere"})
assert done.returncode == 0 and float(done.stdout) == liver.Law().step(0.4, 0.0, 0.001)
os.environ["CC"] = "no-such-compiler"
refused(OSError, "no-such-compiler, a C compiler (CC names another)", lambda: liver.Law())
del os.environ["CC"]
assert not liver.__dict__.get("numpy") and "numpy" not in sys.modules

try:
    import numpy
except ImportError:
    print("no NumPy for " + sys.executable)
    sys.exit(77)

law.reset()
forces = law.render(numpy.array(position), numpy.array(velocity), 0.001)
assert isinstance(forces, numpy.ndarray) and forces.dtype == numpy.float64 and forces.tolist() == expected
law.reset()
stride = law.render(numpy.repeat(position, 2)[::2], velocity, numpy.full(count, 0.001))
assert stride.tolist() == expected
law.reset()
assert law.step(numpy.float64(position[0]), velocity[0], numpy.float32(0.5)) == liver.Law().step(
    position[0], velocity[0], 0.5)
assert law.render(numpy.array([0, 1], dtype=numpy.int32), [0, 0], 0.001).dtype == numpy.float64
refused(ValueError, "position has the shape (2, 1); expected one dimension",
        lambda: law.render(numpy.zeros((2, 1)), [0.0, 0.0], 0.001))
refused(TypeError, "velocity holds complex128; expected real numbers",
        lambda: law.render([0.4], numpy.zeros(1, dtype=complex), 0.001))
refused(TypeError, "position holds <U3; expected real numbers", lambda: law.render(numpy.array(["0.4"]), [0.0], 0.001))
refused(TypeError, "position is of type complex128; expected a number",
        lambda: law.step(numpy.complex128(1), 0, 0.001))
refused(TypeError, "position is of type ndarray; expected a number", lambda: law.step(numpy.zeros(1), 0, 0.001))
