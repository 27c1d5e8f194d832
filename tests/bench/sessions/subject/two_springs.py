"""Protocols of two laws on simulated scissors, short enough for a browser to answer them by the wall clock."""

SAMPLES = """
device = "sim:scissors"
ramp = {{ value = 20, unit = "ms" }}
[[sample]]
name = "kelvin"
law = "{examples}/kelvin.law.toml"
[[sample]]
name = "exponential"
law = "{examples}/exponential.law.toml"
"""


def protocol(examples, top, more=""):
    return top + SAMPLES.format(examples=examples) + more
