"""Search in a site that no server gives: a page from the disk may neither fetch the index nor start a worker of another file."""

import json
from pathlib import Path


def let_search_without_a_server(site):
    """Writes search/from_disk.js, which the theme's main.html loads where a page is opened as a file."""
    site = Path(site)
    worker, = site.glob("assets/javascripts/workers/search.*.min.js")
    index = json.loads((site / "search/search_index.json").read_text(encoding="utf-8"))
    source = worker.read_text(encoding="utf-8").partition("//# sourceMappingURL")[0]
    (site / "search/from_disk.js").write_text(
        f"__search = {{\n  index: Promise.resolve({json.dumps(index)}),\n"
        f"  worker: URL.createObjectURL(new Blob([{json.dumps(source)}], {{type: 'text/javascript'}}))\n}};\n", encoding="utf-8")
