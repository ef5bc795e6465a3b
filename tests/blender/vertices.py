"""Writes the positions that the vertices of an animated glTF file have in Blender at each frame.
vertices_check.py compares them with the positions that bandsaw-import computes.

    blender -b --factory-startup --python vertices.py -- FILE.glb OUT.npy FIRST LAST

OUT.npy is an array of float32 with the shape (frames, vertices, 3). The y axis is up. The vertices are
in the order of FILE.glb."""

import sys

import bpy
import numpy as np

if not hasattr(np, "bool"):
    np.bool = bool  # Blender 3.4's importer uses this name, which numpy 1.24 has dropped

path, out, first, last = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.context.scene.render.fps = 24
bpy.ops.import_scene.gltf(filepath=path, merge_vertices=False)
thing = next(one for one in bpy.data.objects if one.type == "MESH" and one.find_armature() is not None)
frames = []
for frame in range(int(first), int(last) + 1):
    bpy.context.scene.frame_set(frame)
    shown = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = shown.to_mesh()
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", flat)
    place = np.array(shown.matrix_world)
    world = flat.reshape(-1, 3) @ place[:3, :3].T + place[:3, 3]
    frames.append(np.stack([world[:, 0], world[:, 2], -world[:, 1]], -1))
    shown.to_mesh_clear()
np.save(out, np.array(frames, np.float32))
