"""Makes the volumes and scenes of renderlib/medium/NOTES.md, with python3-openvdb and python3-numpy.

/usr/bin/python3 volumes.py FOLDER

Writes volumes.vdb (256^3 voxels of smoke, flames and temperatures) and three scenes: smoke.textproto,
fire.textproto, and plain.textproto, homogeneous smoke in a ball for comparison. Prints for each grid
the number of active voxels, the number of leaves (blocks of 8^3 voxels), and the size of the numbers in
the leaves in bytes.
"""

import os
import sys

import numpy
import pyopenvdb

SIDE = 256
HEAD = """image { width: 320  height: 320  tone: TONE_FILMIC }
integrator { max_depth: 64 }
material { name: "ground"  diffuse { color { rgb: [0.35, 0.32, 0.3] } } }
shape { quad { corner: [-30, 0, -30]  u: [0, 0, 60]  v: [60, 0, 0] }  material: "ground" }
"""
DAY = """camera { position: [0, 1.05, 5.2]  look_at: [0, 0.98, 0]  vertical_fov: 26 }
background { gradient { bottom { rgb: [0.25, 0.3, 0.38] }  top { rgb: [0.12, 0.2, 0.4] } } }
light { directional { direction: [-0.8, -1, -0.5]  irradiance { rgb: [3.2, 3.0, 2.6] } } }
"""
NIGHT = """camera { position: [0, 0.95, 4.6]  look_at: [0, 0.78, 0]  vertical_fov: 26 }
background { gradient { bottom { rgb: [0.01, 0.012, 0.016] }  top { rgb: [0.02, 0.03, 0.06] } } }
material { name: "ball"  diffuse { color { rgb: [0.6, 0.6, 0.6] } } }
shape { sphere { center: [0.75, 0.2, 0.6]  radius: 0.2 }  material: "ball" }
"""
PLACED = 'file: "volumes.vdb"  matrix: [1, 0, 0, -1,  0, 1, 0, 0,  0, 0, 1, -1]'
BOX = "shape { box { min: [-1, 0, -1]  max: [1, 2, 1] }  interior: \"smoke\" }\n"
SCENES = {
    "plain": DAY + """medium { name: "smoke"  albedo { rgb: [0.9, 0.9, 0.91] }  density: 5  anisotropy: 0.25 }
shape { sphere { center: [0, 1.1, 0]  radius: 0.6 }  interior: "smoke" }
""",
    "smoke": DAY + f"""medium {{ name: "smoke"  albedo {{ rgb: [0.9, 0.9, 0.91] }}  density: 14  anisotropy: 0.25
  density_grid {{ {PLACED} }} }}
""" + BOX,
    "fire": NIGHT + f"""medium {{ name: "smoke"  albedo {{ rgb: [0.7, 0.7, 0.72] }}  density: 8
  emission {{ rgb: [60, 60, 60] }}  density_grid {{ {PLACED} }}
  emission_grid {{ grid: "flame"  {PLACED} }}  temperature_grid {{ {PLACED} }} }}
""" + BOX,
}


def noise(rng, octaves, cells):
    """Returns value noise on the grid. The first octave has `cells` cells a side; each further one has twice as many, and 0.55 times the amplitude."""
    total = numpy.zeros((SIDE, SIDE, SIDE), numpy.float32)
    for octave in range(octaves):
        count = cells << octave
        lattice = rng.random((count + 1,) * 3, dtype=numpy.float32) * 2 - 1
        at = numpy.linspace(0, count, SIDE, endpoint=False)
        low = at.astype(int)
        share = (at - low).astype(numpy.float32)
        share = share * share * (3 - 2 * share)
        for axis in range(3):
            along = share.reshape([-1 if k == axis else 1 for k in range(3)])
            lattice = (numpy.take(lattice, low, axis) * (1 - along) +
                       numpy.take(lattice, low + 1, axis) * along)
        total += 0.55**octave * lattice
    return total


def volumes():
    """Returns the density of the smoke, the strength of the flames, and their temperatures in kelvin.

    The shapes and their constants were chosen by eye: a column of smoke over a flame."""
    rng = numpy.random.default_rng(5)
    x, y, z = numpy.meshgrid(*[numpy.linspace(-1, 1, SIDE, dtype=numpy.float32)] * 3, indexing="ij")
    detail, bend_x, bend_z = noise(rng, 6, 4), noise(rng, 3, 3), noise(rng, 3, 3)
    height = (y + 1) / 2
    clip = lambda a: numpy.clip(a, 0, 1)
    r = numpy.hypot(x + 0.35 * bend_x * height, z + 0.35 * bend_z * height) / (0.16 + 0.42 * height)
    density = clip(1.3 * (1 - r) + 0.75 * detail * clip(1.6 - r))
    density *= clip((height - 0.06) / 0.06) * clip((0.98 - height) / 0.2)
    density[density < 0.02] = 0
    width = 0.34 * numpy.sqrt(clip(1 - height / (0.55 + 0.25 * detail))) + 1e-3
    flame = clip(1.4 * (1 - numpy.hypot(x + 0.12 * bend_x, z + 0.12 * bend_z) / width))**0.6
    flame *= clip(height / 0.03)
    flame[flame < 0.02] = 0
    return {"density": density, "flame": flame, "temperature": (900 + 1100 * flame) * (flame > 0)}


def main(folder):
    os.makedirs(folder, exist_ok=True)
    grids = []
    for name, values in volumes().items():
        grid = pyopenvdb.FloatGrid()
        grid.copyFromArray(values.astype(numpy.float32))
        grid.prune()
        grid.name = name
        grid.gridClass = pyopenvdb.GridClass.FOG_VOLUME
        grid.transform = pyopenvdb.createLinearTransform(voxelSize=2 / SIDE)
        grids.append(grid)
        print(f"{name}: {grid.activeVoxelCount()} voxels, {grid.leafCount()} leaves, "
              f"{grid.leafCount() * 512 * 4} bytes")
    pyopenvdb.write(os.path.join(folder, "volumes.vdb"), grids=grids)
    for name, text in SCENES.items():
        with open(os.path.join(folder, name + ".textproto"), "w") as out:
            out.write(HEAD + text)


main(sys.argv[1])
