"""Compares the positions that bandsaw-import and Blender (vertices.py) compute for the vertices of
a model at each frame.

    vertices_check.py BANDSAW-IMPORT FILE.glb BLENDER.npy FIRST FOLDER

FIRST: number of the first frame. bandsaw-import writes the scene of each frame to FOLDER as a
package, a folder of files. In a package, the file of positions is recognised by its size."""

import os
import subprocess
import sys

import numpy as np

importer, path, oracle, first, folder = sys.argv[1:]
wanted = np.load(oracle)
worst = moved = 0
for number, positions in enumerate(wanted, int(first)):
    package = os.path.join(folder, str(number))
    os.makedirs(package)
    # "100" and "8000000000" are limits: CPU seconds and bytes of memory.
    subprocess.run([importer, "scene", path, package, "100", "8000000000", f"frame={number}", "fps=24", "shutter=0"], check=True)
    (blob,) = [name for name in os.listdir(package) if os.path.getsize(os.path.join(package, name)) == positions.nbytes]
    got = np.fromfile(os.path.join(package, blob), "<f4").reshape(positions.shape)
    worst = max(worst, np.abs(got - positions).max())
    moved = max(moved, np.abs(positions - wanted[0]).max())
print(f"{len(wanted)} frames of {len(wanted[0])} vertices, which move by up to {moved:.3g}: the largest difference to Blender is {worst:.2g}")
assert moved > 0.5  # otherwise the model does not walk, and the comparison says nothing
assert worst < 1e-5
