"""The notebook of the examples runs: its cells, one after the other, as a user would run them."""

import ast
import contextlib
import io
import json
import os
import unittest
from pathlib import Path

try:
    import matplotlib.pyplot as plt
except ImportError:
    plt = None

NOTEBOOK = Path(os.environ["FELDSPAR_SOURCE_DIR"], "examples/python/first-rock.ipynb")


@unittest.skipIf(plt is None, "matplotlib is not installed")
class Notebook(unittest.TestCase):
    def test_runs(self):
        cells = [cell for cell in json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == "code"]
        names = {"__name__": "__main__"}
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            for number, cell in enumerate(cells):
                text = "".join(cell["source"])
                with self.subTest(cell=number):
                    exec(compile(ast.parse(text, f"cell {number}"), f"cell {number}", "exec"), names)
        self.assertEqual(names["led"].stop_reason, "three cycles are enough")
        self.assertEqual(len(names["found"]), 6)
        self.assertIn("specimen.width", printed.getvalue())
        self.assertGreaterEqual(len(plt.get_fignums()), 4)
        plt.close("all")

    def test_has_its_pictures_and_is_small(self):
        outputs = [o for cell in json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == "code" for o in cell["outputs"]]
        pictures = [o for o in outputs if "image/png" in o.get("data", {})]
        self.assertGreaterEqual(len(pictures), 5)
        self.assertFalse([o for o in outputs if o["output_type"] == "error"])
        self.assertLess(NOTEBOOK.stat().st_size, 500_000)


if __name__ == "__main__":
    unittest.main()
