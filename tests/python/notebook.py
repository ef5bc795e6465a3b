"""Runs deploy/python/first_render.ipynb on a farm of one worker on loopback: notebook.py BIN-FOLDER. Exit 77: nbconvert is not installed."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

if shutil.which("jupyter-nbconvert") is None:
    print("skipped: there is no program jupyter-nbconvert (deploy/install.sh blender)")
    sys.exit(77)
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import farm_test  # noqa: E402  (takes BIN-FOLDER out of sys.argv)


class Notebook(unittest.TestCase):
    def test_all_cells_run_and_show_pictures(self):
        with tempfile.TemporaryDirectory() as folder:
            loopback = farm_test.LoopbackFarm(folder)
            try:
                python = os.path.join(farm_test.SOURCE, "deploy", "python")
                done = os.path.join(folder, "done.ipynb")
                environment = dict(os.environ, BANDSAW_FARM=os.path.join(loopback.data, "farm"), PYTHONPATH=python, HOME=folder)
                subprocess.run(["jupyter-nbconvert", "--to", "notebook", "--execute", os.path.join(python, "first_render.ipynb"), "--output", done],
                               check=True, env=environment)
            finally:
                loopback.stop()
            with open(done, encoding="utf-8") as file:
                cells = [cell for cell in json.load(file)["cells"] if cell["cell_type"] == "code"]
            kinds = [sorted(kind for output in cell["outputs"] for kind in output.get("data", {})) for cell in cells]
            self.assertIn("image/png", kinds[1])  # job.show()
            self.assertIn("image/png", kinds[3])  # an image as the value of a cell
            self.assertIn("rmse", str(cells[2]["outputs"]))


if __name__ == "__main__":
    unittest.main()
