# peers: python3-numpy python3-scipy python3-lmfit python3-h5py r-base-core r-cran-segmented
# targets: kerf
"""Every law on measured data of other labs against SciPy, lmfit and R's segmented: sums of squares, intervals and times.

    scripts/benchmark fits [--data FOLDER] [WORD...]    with words, prints the data sets whose names have one of them
"""

import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import fits_data
import fits_laws
import fits_peers
from sections import replace_section

TURNS = 3
LONG_S = 4.0  # what takes longer is run once
SAME = 1e-9  # relative, by which Kerf may be worse
SEGMENTS = 3

# Law, options of the program, the peer, the parameter whose interval is shown. What has no equation of its own is R's.
RELAXES = [
    ("kelvin", ["--models", "kelvin"], lambda s, o: fits_laws.Maxwell(s, o, 1), "parallel_stiffness"),
    ("maxwell, 1 arm", ["--models", "maxwell", "--arms", "1"], lambda s, o: fits_laws.Maxwell(s, o, 1), "parallel_stiffness"),
    ("maxwell, 2 arms", ["--models", "maxwell", "--arms", "2"], lambda s, o: fits_laws.Maxwell(s, o, 2), "parallel_stiffness"),
    ("maxwell, 3 arms", ["--models", "maxwell", "--arms", "3"], lambda s, o: fits_laws.Maxwell(s, o, 3), "parallel_stiffness"),
    ("springpot", ["--models", "springpot"], fits_laws.Springpot, "order"),
]
EXACT = [("springpot, exact kernel", ["--models", "springpot"], fits_laws.ExactSpringpot, "order")]
GROWS = [
    ("exponential", ["--models", "exponential"], fits_laws.Exponential, "exponent"),
    ("hunt_crossley", ["--models", "hunt_crossley"], fits_laws.HuntCrossley, "exponent"),
    ("friction", ["--models", "friction"], fits_laws.Friction, "coulomb"),
]
CUTS = [
    ("precontact", ["--models", "precontact"], fits_laws.Precontact, "width"),
    ("scissors_analytic", ["--models", "scissors_analytic"], fits_laws.ScissorsAnalytic, "pivot_torque"),
]
PIECEWISE = [("piecewise, %d segments" % SEGMENTS,
              ["--models", "piecewise", "--segments", str(SEGMENTS), "--points-per-segment", "1", "--option", "loop=false"],
              None, "knot[1]")]
ON_LIVER = ["--models", "exponential", "--option", "viscous=false", "--option", "offset=true", "--thickness", "0.001"]


def laws_of(name):
    if "relaxation" in name:
        return RELAXES + EXACT * ("tendon" in name) + GROWS[:1]
    if "grasper" in name:
        return RELAXES[:1] + RELAXES[2:3] + RELAXES[4:] + GROWS[2:] + PIECEWISE
    return [RELAXES[i] for i in (0, 2, 4)] + GROWS + CUTS * ("punch" in name) + PIECEWISE


def kerf_fit(program, recording, options, folder):
    """The fit of fit.json and the seconds of the whole program."""
    begin = time.perf_counter()
    done = subprocess.run([program, "fit", str(recording), *options, "--rows", "all", "--no-folds", "-o", str(folder), "--force"],
                          capture_output=True, text=True)
    seconds = time.perf_counter() - begin
    if done.returncode not in (0, 1) or not (folder / "fit.json").exists():
        raise RuntimeError((done.stderr.strip().splitlines() or ["no word"])[-1].split(": ")[-1])
    result = json.loads((folder / "fit.json").read_text())
    return result["fits"][0], result["recordings"][0]["contact"], seconds


def squares_of(fit):
    return fit["rmse"] ** 2 * fit["samples"]


def with_r(series, folder):
    path = folder / "points.csv"
    path.write_text("position,force\n" + "".join("%.17g,%.17g\n" % pair for pair in zip(series.x, series.force)))
    script = str(pathlib.Path(__file__).with_name("fits_segmented.R"))
    words = subprocess.run(["Rscript", script, str(SEGMENTS - 1), str(path)], check=True, capture_output=True,
                           text=True).stdout.split()
    squares, seconds, lower, upper = (float(word.replace("NA", "nan")) for word in words)
    return {"squares": squares, "seconds": seconds, "interval": (lower, upper) if lower == lower else None,
            "whose": "segmented", "by": "R"}


def compare(program, recording, contact, entry, folder):
    """Kerf and the peer by turns; what one row of the table says."""
    _, options, make, shown = entry
    ours, theirs = [], []
    for _ in range(TURNS):
        fit, place, seconds = kerf_fit(program, recording, options + contact, folder / "fit")
        ours.append((fit["seconds"], seconds))
        series = fits_data.Series(recording, place)
        law = make(series, fit["options"]) if make else None
        peer = fits_peers.searched(law) if law else with_r(series, folder)
        theirs.append(peer["seconds"])
        if peer["seconds"] > LONG_S:
            break
    if law:
        peer = fits_peers.with_interval(law, peer, shown)
    return {"n": fit["samples"], "kerf": squares_of(fit), "peer": peer["squares"], "shown": shown,
            "ends": fit["parameters"][shown]["ci95"], "value": fit["parameters"][shown]["value"],
            "their_ends": peer["interval"], "whose": peer["whose"], "by": peer["by"], "converged": fit["converged"],
            "search_s": statistics.median(s for s, _ in ours), "program_s": statistics.median(s for _, s in ours),
            "peer_s": statistics.median(theirs)}


def on_liver(program, source, folder):
    """All sites in one batch; the row is their sum, the difference that of the worst site."""
    sites = fits_data.liver_sites(source, folder)
    for site in sites:
        fits_data.imported(program, site, "time=1[s],position=2[mm],force=3[N]", folder / (site.stem + ".h5"))
    begin = time.perf_counter()
    subprocess.run([program, "fit", "--batch", str(folder), "--jobs", "1", *ON_LIVER, "--rows", "all", "--no-folds",
                    "--contact", "-%g" % fits_data.TOUCHING_M, "--direction", "increasing", "-o", str(folder / "fits"), "--force"],
                   check=True, capture_output=True)
    row = {"n": 0, "kerf": 0.0, "peer": 0.0, "search_s": 0.0, "peer_s": 0.0, "program_s": time.perf_counter() - begin,
           "shown": "exponent", "ends": None, "their_ends": None, "whose": "", "by": "SciPy", "converged": True, "worst": -1.0}
    for site in sites:
        result = json.loads((folder / "fits" / site.stem / "fit.json").read_text())
        fit = result["fits"][0]
        series = fits_data.Series(folder / (site.stem + ".h5"), result["recordings"][0]["contact"])
        law = fits_laws.Exponential(series, fit["options"])
        peer = fits_peers.with_interval(law, fits_peers.searched(law), "exponent")
        row["n"] += fit["samples"]
        row["kerf"] += squares_of(fit)
        row["peer"] += peer["squares"]
        row["search_s"] += fit["seconds"]
        row["peer_s"] += peer["seconds"]
        row["converged"] = row["converged"] and fit["converged"]
        difference = squares_of(fit) / peer["squares"] - 1.0
        if difference > row["worst"]:
            row.update(worst=difference, ends=fit["parameters"]["exponent"]["ci95"], their_ends=peer["interval"],
                       whose=peer["whose"])
    return len(sites), row


def interval_text(ends):
    if not ends or None in ends:
        return "none"
    return "%.5g to %.5g" % tuple(ends)


def line_of(name, law, row):
    difference = row.get("worst", row["kerf"] / row["peer"] - 1.0)
    return "| %s | %s | %d | %.12g | %.12g, %s | %+.0e | %s | %s | %s%s | %.3f | %.3f | %.2f | %.1f |" % (
        name, law, row["n"], row["kerf"], row["peer"], row["by"], difference, row["shown"], interval_text(row["ends"]),
        interval_text(row["their_ends"]), " (%s)" % row["whose"] if row["their_ends"] else "", row["search_s"], row["program_s"],
        row["peer_s"], row["peer_s"] / row["program_s"])


def arguments_of(words):
    folder = None
    if "--data" in words:
        place = words.index("--data")
        folder = pathlib.Path(words[place + 1])
        words = words[:place] + words[place + 2:]
    return folder, words


HEAD = """Each law on each data set (`scripts/fetch-data` names where they come from), all rows, nothing held out. Peers: the law written
anew in NumPy, searched by SciPy's `least_squares` (variable projection, a scan or %d starts, a polish at tolerances of 1e-15), then
lmfit's `leastsq` from a fifth beside that; the smaller sum of squares counts. R's `segmented` with 20 bootstrap restarts for
piecewise. The difference is Kerf's sum over the peer's less one: above %.0e Kerf would be worse. Kerf's intervals allow for
residuals with a memory, the peers' take them for white noise. Times are medians of %d turns (one where a peer took over %.0f s)
on a machine that others used too: read the ratios. Kerf's search is what `fit.json` says, its program all of `kerf fit` with
reading, intervals and files; the ratio is SciPy's search over the latter. pwlf is not packaged: a sine of 100 points took it 2.3 to
3.0 s with 6 segments and 78 to 90 s with 11."""


def main():
    house = pathlib.Path(sys.argv[1])
    folder, words = arguments_of(sys.argv[2:])
    program = str(house / "build/release/bin/kerf")
    wanted = lambda name: not words or any(word in name for word in words)
    lines = [HEAD % (fits_peers.STARTS, SAME, TURNS, LONG_S), "",
             "| data | law | n | Kerf: sum of squares | least of the peers | difference | of | Kerf: 95 % interval | peer's | "
             "Kerf, search [s] | program [s] | SciPy or R [s] | times as fast |", "|" + "---|" * 13]
    print("\n".join(lines), flush=True)
    worse, left_out = [], []

    def add(name, law, row):
        lines.append(line_of(name, law, row))
        print(lines[-1], flush=True)
        difference = row.get("worst", row["kerf"] / row["peer"] - 1.0)
        if difference > SAME:
            worse.append("%s, %s by %.1e%s" % (name, law, difference, "" if row["converged"] else " (did not converge)"))

    with tempfile.TemporaryDirectory() as place:
        place = pathlib.Path(place)
        for number, (name, file, columns, contact) in enumerate(fits_data.RECORDINGS):
            source = fits_data.find(house, file, folder)
            if not wanted(name) or source is None:
                left_out += [file] if source is None else []
                continue
            recording = fits_data.imported(program, source, columns, place / ("%d.h5" % number))
            for entry in laws_of(name):
                try:
                    add(name, entry[0], compare(program, recording, contact, entry, place))
                except RuntimeError as error:
                    lines.append("| %s | %s | | %s |%s" % (name, entry[0], error, " |" * 9))
                    print(lines[-1], flush=True)
        source = fits_data.find(house, fits_data.LIVER, folder)
        if source and wanted("liver"):
            (place / "liver").mkdir()
            count, row = on_liver(program, source, place / "liver")
            add("liver, %d sites" % count, "exponential, offset", row)
    lines += ["", "Kerf worse by more than %.0e: %s." % (SAME, "; ".join(worse) or "nowhere")]
    if left_out:
        lines.append("Left out, since scripts/fetch-data did not bring them: %s." % ", ".join(left_out))
    print("\n".join(lines[-2:]))
    if not words:
        replace_section(house / "docs/benchmarks.md", "fits", "Fits of measured data, law by law, against SciPy, lmfit and R",
                        "\n".join(lines))


main()
