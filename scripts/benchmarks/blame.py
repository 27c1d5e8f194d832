# peers:
# targets: kerf_blame_benchmark
"""Whether the cause of a missed deadline is named right: known causes injected into a running loop.

scripts/benchmark blame
"""

import json
import pathlib
import subprocess
import sys

from sections import replace_section

house = pathlib.Path(sys.argv[1])
program = house / "build/release/bin/kerf_blame_benchmark"
results = json.loads(subprocess.run([str(program)], check=True, capture_output=True, text=True).stdout)
lines = ["| injected, in each fiftieth tick | cause | late ticks | named right | blamed on the law |", "|---|---|---|---|---|"]
for row in results:
    lines.append("| {injected} | {cause} | {late_ticks} | {named_right} | {blamed_on_the_law} |".format(**row))
    for wrong in row["wrong"]:
        print("%s: %s" % (row["injected"], wrong), file=sys.stderr)
late = sum(row["late_ticks"] for row in results)
right = sum(row["named_right"] for row in results)
lines += ["", "%d of %d late ticks named right, by the wall clock at 1 kHz. Who is more urgent than the loop, and so can make it "
          "wait, needs the rights of docs/real-time.md." % (right, late)]
replace_section(house / "docs/benchmarks.md", "blame", "Who is to blame for a missed deadline", "\n".join(lines))
