#!/usr/bin/env python3
"""The numbers of docs/sweeps-walls.md: walls_numbers.py walls.merged/sweep.h5 walls-longer.merged/sweep.h5"""

import sys

import h5py
import numpy


def columns(file):
    walls = h5py.File(file)["walls"]
    return {name: walls[name][:] for name in walls}


def percent(share):
    return f"{100 * share:.1f} %"


def limits(walls, works):
    """The stiffest wall up to which all softer ones do, at the damping that is best, of each mass, encoder and delay."""
    names = ["mass", "resolution", "delay", "damping", "stiffness"]
    values = [numpy.unique(walls[name]) for name in names]
    places = [numpy.searchsorted(of, walls[name]) for of, name in zip(values, names)]
    grid = numpy.zeros([len(of) for of in values], bool)
    grid[tuple(places)] = works
    good = numpy.cumprod(grid, axis=-1).sum(axis=-1)
    stiffest = numpy.where(good > 0, values[-1][numpy.maximum(good - 1, 0)], 0.0)
    return values, stiffest.max(axis=-1)


def main(file, longer):
    walls = columns(file)
    rest, stable = walls["comes_to_rest"] > 0, walls["spectral_radius"] < 1
    print(f"{len(rest)} walls: {percent(rest.mean())} come to rest, {percent(stable.mean())} have stable eigenvalues")
    print(f"both say the same of {percent((rest == stable).mean())}")
    print("encoder: stable that do not rest, unstable that do")
    for step in numpy.unique(walls["resolution"]):
        of = walls["resolution"] == step
        print(f"  {step:g} m: {percent((~rest)[of & stable].mean())}, {percent(rest[of & ~stable].mean())}")
    passive = walls["stiffness"] <= walls["passive_stiffness"]
    print(f"passive: {passive.sum()}, of which rest:")
    for step in numpy.unique(walls["resolution"]):
        of = passive & (walls["resolution"] == step)
        print(f"  {step:g} m: {rest[of].sum()} of {of.sum()}")
    values, stiffest = limits(walls, rest)
    _, linear = limits(walls, stable)
    print("stiffest wall [N/m], median over masses; delays", values[2])
    for i, step in enumerate(values[1]):
        print(f"  {step:g} m:", numpy.median(stiffest[:, i], axis=0).round())
    print("  eigenvalues:", numpy.median(linear[:, 0], axis=0).round())
    print("by mass, encoder of 1 um:")
    for i, mass in enumerate(values[0]):
        print(f"  {mass:.3f} kg:", stiffest[i, 1].round(), "eigenvalues", linear[i, 0].round())
    walls = columns(longer)
    rest, stable = walls["comes_to_rest"] > 0, walls["spectral_radius"] < 1
    print("unstable walls that rest, by the time of the trial; stable ones that do")
    for seconds in numpy.unique(walls["seconds"]):
        of = walls["seconds"] == seconds
        print(f"  {seconds:g} s: {percent(rest[of & ~stable].mean())} of {(of & ~stable).sum()}; {percent(rest[of & stable].mean())}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
