"""docs/python.md runs as it stands."""

import contextlib
import io
import os
import re
import unittest

import numpy as np

from support import HOUSE, InFolder, bits


class Tutorial(InFolder):
    @classmethod
    def make(cls):
        cls.import_punch()

    def test_runs_as_it_stands(self):
        page = (HOUSE / "docs/python.md").read_text(encoding="utf-8")
        blocks = list(re.finditer(r"```python\n(.*?)```", page, re.S))
        self.assertGreater(len(blocks), 8)
        before = os.getcwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, before)
        names = {}
        with contextlib.redirect_stdout(io.StringIO()) as said:
            for block in blocks:
                # Lines of the page in what is told of an error.
                code = "\n" * page[:block.start(1)].count("\n") + block.group(1)
                exec(compile(code, "docs/python.md", "exec"), names)  # pylint: disable=exec-used
        self.assertIn("rad", said.getvalue())
        self.assertEqual(bits(names["plain_time"]), bits(names["time"]))
        self.assertTrue(np.all(np.abs(names["tissue"]) == np.abs(names["force"])))
        self.assertGreater(names["tissue"].max(), 0.1)


if __name__ == "__main__":
    unittest.main()
