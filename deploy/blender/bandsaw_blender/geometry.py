"""Meshes of Blender as numpy arrays, and as the bytes of GLB files."""

import json
import struct

import numpy as np


class Vertices:
    """Vertices of a mesh: `positions` (v, 3); `normals` (v, 3), or None if the mesh is flat everywhere."""

    def __init__(self, positions, normals):
        self.positions, self.normals = positions, normals

    def __getitem__(self, which):
        return Vertices(self.positions[which], None if self.normals is None else self.normals[which])


class Triangles:
    """The triangles of a mesh with one material slot, with v vertices and t triangles.

    `positions` (v, 3); `normals` (v, 3), or None if the mesh is flat everywhere. `uvs`: a list of
    arrays (v, 2), whose second coordinate is 0 at the bottom of an image; at most two of them are
    written to files. `indices` (t, 3). `undeformed` (v, 3): positions of the vertices without
    modifiers and shape keys; None: the same as `positions`. `ends`: None, or the Vertices when the
    shutter opens and when it closes; all other fields are those at the time of the frame."""

    def __init__(self, positions, normals, uvs, indices, undeformed=None, ends=None):
        self.positions, self.normals, self.uvs, self.indices, self.undeformed, self.ends = positions, normals, uvs, indices, undeformed, ends

    def _selected(self, which, indices):
        """Returns Triangles with the vertices `which` and the `indices` into them."""
        frame = Vertices(self.positions, self.normals)[which]
        ends = None if self.ends is None else tuple(end[which] for end in self.ends)
        undeformed = None if self.undeformed is None else self.undeformed[which]
        return Triangles(frame.positions, frame.normals, [uv[which] for uv in self.uvs], indices.astype(np.uint32).reshape(-1, 3), undeformed, ends)

    def box(self):
        """Returns the lowest and the highest coordinates, two arrays of 3."""
        return self.positions.min(axis=0), self.positions.max(axis=0)

    def corners(self):
        """Returns the same triangles, each with three vertices of its own."""
        flat = self.indices.reshape(-1)
        return self._selected(flat, np.arange(len(flat)))

    def compact(self):
        """Returns the same triangles without the vertices that no triangle uses."""
        return self._selected(*np.unique(self.indices.reshape(-1), return_inverse=True))

    def corner_normals(self):
        """Returns the shading normals of the corners (3 t, 3), in the order of `indices`."""
        if self.normals is not None:
            return self.normals[self.indices.reshape(-1)]
        a, b, c = (self.positions[self.indices[:, k]].astype(np.float64) for k in range(3))
        n = np.cross(b - a, c - a)
        n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-30)
        return np.repeat(n, 3, axis=0)


# Returns a property of all items of a Blender collection: (count, width), or (count) if the width is 1.
def _get(collection, name, count, width, dtype):
    array = np.empty(count * width, dtype=dtype)
    collection.foreach_get(name, array)
    return array.reshape(count, width) if width > 1 else array


def _corner_normals(mesh, loops):
    """Returns the normals of the corners (loops, 3). They depend on which faces are flat or smooth,
    and on the user's own normals."""
    if hasattr(mesh, "corner_normals"):  # Blender 4.1
        return _get(mesh.corner_normals, "vector", loops, 3, np.float32)
    mesh.calc_normals_split()
    found = _get(mesh.loops, "normal", loops, 3, np.float32)
    mesh.free_normals_split()
    return found


class Pose:
    """A mesh of Blender at one time. A loop is Blender's word for a corner of a face. `positions`
    and `undeformed` (vertices, 3): as in Triangles. `vertex_of_loop` (loops): the index of each
    loop's vertex. `normals` (loops, 3), or None if the mesh is flat everywhere."""

    def __init__(self, mesh):
        vertices, loops = len(mesh.vertices), len(mesh.loops)
        self.positions = _get(mesh.vertices, "co", vertices, 3, np.float32)
        undeformed = _get(mesh.vertices, "undeformed_co", vertices, 3, np.float32)
        self.undeformed = None if np.array_equal(undeformed, self.positions) else undeformed
        self.vertex_of_loop = _get(mesh.loops, "vertex_index", loops, 1, np.int32)
        smooth = _get(mesh.polygons, "use_smooth", len(mesh.polygons), 1, bool)
        custom = mesh.has_custom_normals
        split = custom or getattr(mesh, "use_auto_smooth", False) or _has_sharp(mesh)
        self.normals = None
        if smooth.all() and not split:
            self.normals = _get(mesh.vertices, "normal", vertices, 3, np.float32)[self.vertex_of_loop]
        elif smooth.any() or custom:
            self.normals = _corner_normals(mesh, loops)

    def fits(self, other):
        """Returns true if both are poses of the same mesh, which may differ in the places of vertices and in normals."""
        return (len(self.positions) == len(other.positions) and np.array_equal(self.vertex_of_loop, other.vertex_of_loop) and
                (self.normals is None) == (other.normals is None))

    def equals(self, other):
        """Returns true if both are poses of the same mesh with equal positions and normals."""
        return (self.fits(other) and np.array_equal(self.positions, other.positions) and
                (self.normals is None or np.array_equal(self.normals, other.normals)))


def triangles_of(mesh, uv_names, ends=None):
    """Returns a dictionary from the indices of the material slots that the mesh uses to their
    Triangles. `uv_names`: the names of the uv maps to keep, "" is the active one. `ends`: the Poses
    of the mesh when the shutter opens and when it closes, which must fit the mesh (Pose.fits);
    None: the mesh does not deform."""
    mesh.calc_loop_triangles()
    count, loops = len(mesh.loop_triangles), len(mesh.loops)
    if count == 0:
        return {}
    corners = _get(mesh.loop_triangles, "loops", count, 3, np.int32)
    of_corner = _get(mesh.loop_triangles, "vertices", count, 3, np.int32)
    slots = _get(mesh.loop_triangles, "material_index", count, 1, np.int32)
    uvs = [_get(layer.data, "uv", loops, 2, np.float32) for layer in uv_layers(mesh, uv_names)]
    pose = Pose(mesh)
    used = np.unique(slots)
    if len(used) == 1:
        return {int(used[0]): _indexed(pose, uvs, corners, of_corner, ends)}
    return {int(slot): _indexed(pose, uvs, corners[slots == slot], of_corner[slots == slot], ends).compact() for slot in used}


# Returns true if the mesh has marks for sharp edges.
def _has_sharp(mesh):
    attribute = mesh.attributes.get("sharp_edge") if hasattr(mesh, "attributes") else None
    return attribute is not None


def uv_layers(mesh, names):
    """Returns the uv maps of the mesh with these names, each map once. The active map is returned
    for "" and for a name that the mesh does not have."""
    if not len(mesh.uv_layers):
        return []
    active = next((layer for layer in mesh.uv_layers if layer.active_render), mesh.uv_layers[0])
    found = []
    for name in names:
        layer = mesh.uv_layers.get(name, active) if name else active
        if all(layer.name != other.name for other in found):
            found.append(layer)
    return found


def _indexed(pose, uvs, corners, of_corner, ends):
    """Returns Triangles in which corners share a vertex of the mesh if their normals and uvs are
    the same. `corners`, `of_corner` (t, 3): the indices of the triangles' loops and of their
    vertices.

    One corner of each vertex represents it. New vertices are made only for the corners that differ
    from the representative of their vertex, so a mesh without seams is converted as fast as
    one without uvs."""
    flat, vertex = corners.reshape(-1), of_corner.reshape(-1)
    poses = [pose, *(ends or ())]
    per_corner = [each.normals for each in poses if each.normals is not None] + uvs
    if not per_corner:
        flat_ends = None if ends is None else tuple(Vertices(end.positions, None) for end in ends)
        return Triangles(pose.positions, None, [], of_corner.astype(np.uint32), pose.undeformed, flat_ends)
    values = [a[flat] for a in per_corner]
    representative = np.zeros(len(pose.positions), dtype=np.int64)
    representative[vertex] = np.arange(len(flat))  # the last corner of each vertex
    other = np.zeros(len(flat), dtype=bool)  # corners that differ from their representative
    for a in values:
        other |= (a != a[representative[vertex]]).any(axis=1)
    index = vertex.astype(np.uint32)
    extra = np.flatnonzero(other)
    if len(extra):
        rows = np.concatenate([np.ascontiguousarray(a[extra]).view(np.uint8).reshape(len(extra), -1) for a in values] +
                              [vertex[extra].astype(np.int32).reshape(-1, 1).view(np.uint8)], axis=1)
        keys = np.ascontiguousarray(rows).view(np.dtype((np.void, rows.shape[1]))).reshape(-1)
        _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
        index[extra] = len(pose.positions) + inverse.reshape(-1).astype(np.uint32)
        added = extra[first]
    else:
        added = extra
    all_corners = np.concatenate([representative, added])
    result = [a[all_corners] for a in values]
    placed = [Vertices(np.concatenate([each.positions, each.positions[vertex[added]]]), result.pop(0) if each.normals is not None else None)
              for each in poses]
    undeformed = None if pose.undeformed is None else np.concatenate([pose.undeformed, pose.undeformed[vertex[added]]])
    return Triangles(placed[0].positions, placed[0].normals, result, index.reshape(-1, 3), undeformed, tuple(placed[1:]) or None)


def box(low, high):
    """Returns the Triangles of an axis-aligned box, whose normals point outwards. `low`, `high`: two opposite corners."""
    p = np.array([[(low, high)[k >> a & 1][a] for a in range(3)] for k in range(8)], dtype=np.float32)
    quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    return Triangles(p, None, [], np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], dtype=np.uint32))


DEFORMS = "deforms"  # the name of the animation of a mesh that deforms


def glb(triangles):
    """Returns the bytes of a GLB file with this one mesh. If the mesh deforms, the file has the
    vertices at the time when the shutter opens. A morph target leads to the vertices at the time
    when the shutter closes. The animation DEFORMS raises the weight of the morph target from 0 to 1
    in the time from 0 to 1."""
    parts, views, accessors, attributes = [], [], [], {}

    # Adds an array and returns the index of its accessor. `component` and `target`: constants of
    # glTF 2.0 (5125: uint32, 5126: float; 34962: vertex data, 34963: indices, None: other data).
    def add(array, kind, component, target, **more):
        data = memoryview(array).cast("B")  # not copied: meshes may be large
        views.append({"buffer": 0, "byteOffset": sum(map(len, parts)), "byteLength": len(data), **({"target": target} if target else {})})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(array), "type": kind, **more})
        parts.append(data)
        return len(accessors) - 1

    def add_vectors(attributes, vertices):
        positions = np.ascontiguousarray(vertices.positions, dtype="<f4")
        attributes["POSITION"] = add(positions, "VEC3", 5126, 34962, min=positions.min(axis=0).tolist(), max=positions.max(axis=0).tolist())
        if vertices.normals is not None:
            attributes["NORMAL"] = add(np.ascontiguousarray(vertices.normals, dtype="<f4"), "VEC3", 5126, 34962)

    first, last = triangles.ends or (Vertices(triangles.positions, triangles.normals), None)
    add_vectors(attributes, first)
    for number, uv in enumerate(triangles.uvs[:2]):
        flipped = np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1)
        attributes[f"TEXCOORD_{number}"] = add(np.ascontiguousarray(flipped, dtype="<f4"), "VEC2", 5126, 34962)
    indices = np.ascontiguousarray(triangles.indices.reshape(-1), dtype="<u4")
    primitive = {"attributes": attributes, "indices": add(indices, "SCALAR", 5125, 34963)}
    more = {}
    if last is not None:
        normals = None if first.normals is None else last.normals - first.normals
        target = {}
        add_vectors(target, Vertices(last.positions - first.positions, normals))
        primitive["targets"] = [target]
        ends = np.array([0, 1], dtype="<f4")
        more["animations"] = [{"name": DEFORMS, "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
                               "samplers": [{"input": add(ends, "SCALAR", 5126, None, min=[0], max=[1]),
                                             "output": add(ends, "SCALAR", 5126, None)}]}]
    size = sum(map(len, parts))
    text = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}], **more,
        "buffers": [{"byteLength": size}], "bufferViews": views, "accessors": accessors}).encode()
    text += b" " * (-len(text) % 4)
    parts.append(b"\0" * (-size % 4))
    size += -size % 4
    return b"".join([struct.pack("<III", 0x46546C67, 2, 28 + len(text) + size), struct.pack("<II", len(text), 0x4E4F534A), text,
                     struct.pack("<II", size, 0x004E4942), *parts])


# ---- an atlas: an image in which each triangle has texels of its own ----


class Atlas:
    """An atlas is a square image of `side` texels a side. It is divided into square cells of `cell`
    texels a side, one for each pair of triangles.

    `uvs` (3 t, 2): the places of the triangles' corners in the image. `triangle` (side * side): the
    index of the triangle at each texel, rows from the bottom; -1 for a texel without a triangle.
    `weights` (side * side, 3): the barycentric coordinates of each texel's centre in that triangle.
    The texels around a triangle belong to it too; some of their barycentric coordinates are
    negative."""

    def __init__(self, triangles, most_side=1024):
        pairs = (triangles + 1) // 2
        columns = int(np.ceil(np.sqrt(pairs)))
        self.cell = max(most_side // columns, 6)
        self.side = columns * self.cell
        if self.side > 2048:
            raise ValueError(f"{triangles:,} triangles are too many")
        number = np.arange(triangles)
        corner = np.stack([(number // 2) % columns, (number // 2) // columns], axis=1) * self.cell
        # The first triangle of a pair lies at the lower left, the second one at the upper right; both keep away from the diagonal and from
        # the cell's edges, so that a bilinear look-up in a triangle sees only texels that belong to this triangle.
        near, far = 1.0, self.cell - 2.0
        first = np.array([[near, near], [far - 1, near], [near, far - 1]])
        second = self.cell - first
        local = np.where((number % 2 == 0)[:, None, None], first[None], second[None])
        places = corner[:, None, :] + local
        self.uvs = (places.reshape(-1, 2) / self.side).astype(np.float32)
        y, x = np.divmod(np.arange(self.side * self.side), self.side)
        cx, cy = x // self.cell, y // self.cell
        lx, ly = x % self.cell + 0.5, y % self.cell + 0.5
        upper = lx + ly > self.cell
        pair = cy * columns + cx
        self.triangle = np.where(pair < pairs, 2 * pair + upper, -1)
        self.triangle = np.where(self.triangle < triangles, self.triangle, -1)
        # The place of each texel's centre in its cell. The upper triangle of a pair is rotated by 180 degrees to the place of the lower one.
        px, py = np.where(upper, self.cell - lx, lx), np.where(upper, self.cell - ly, ly)
        b, c = (px - near) / (far - 1 - near), (py - near) / (far - 1 - near)
        self.weights = np.stack([1 - b - c, b, c], axis=1)

    def spread(self, per_corner):
        """Interpolates values at the corners of the triangles (3 t, k); returns the values at the texels (side * side, k)."""
        by_triangle = per_corner.reshape(-1, 3, per_corner.shape[1])[np.maximum(self.triangle, 0)]
        return np.einsum("nk,nkd->nd", self.weights, by_triangle)
