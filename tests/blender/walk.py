"""Writes a skinned glTF file of a leg that walks for two seconds, with a camera:

    walk.py FILE.glb

A leg of 24 rings is bound to two bones, hip and knee, which turn; the hip moves forwards. Each of
the 48 frames (24 a second) has a key of its own, so two programs that read the file at a frame get
the same pose and need not interpolate in the same way. bandsaw-import converts the file to a package
of arrays. There are no normals, so the positions are the only array of the package with 12 bytes for
each vertex, and a test can find them by that size.
"""

import json
import struct
import sys

import numpy as np

RINGS, SIDES, FRAMES, FPS = 24, 12, 48, 24


def leg():
    """Returns positions, indices, and the weights of hip and knee. The leg bends at y = -1."""
    height = np.linspace(0, -2, RINGS)
    angle = np.arange(SIDES) * 2 * np.pi / SIDES
    radius = 0.3 + 0.1 * np.cos(3 * height)[:, None]
    x, z = radius * np.cos(angle), radius * np.sin(angle)
    positions = np.stack([x, np.repeat(height[:, None], SIDES, 1), z], -1).reshape(-1, 3)
    ring = np.arange(RINGS - 1)[:, None] * SIDES
    side = np.arange(SIDES)
    a, b = ring + side, ring + (side + 1) % SIDES
    triangles = np.stack([a, b, a + SIDES, b, b + SIDES, a + SIDES], -1).reshape(-1)
    knee = np.clip((-0.8 - positions[:, 1]) / 0.4, 0, 1)
    return positions.astype("<f4"), triangles.astype("<u4"), np.stack([1 - knee, knee, 0 * knee, 0 * knee], -1).astype("<f4")


def turns(angles):
    """Rotations about z as quaternions x, y, z, w."""
    zero = np.zeros_like(angles)
    return np.stack([zero, zero, np.sin(angles / 2), np.cos(angles / 2)], -1).astype("<f4")


# Collects the binary buffer of a glTF file with its views and accessors. `add` appends an array and returns its accessor's number;
# 5126, 5125 and 5121 are glTF's codes of float32, uint32 and uint8.
class Writer:
    def __init__(self):
        self.binary, self.views, self.accessors = b"", [], []

    def add(self, array, kind, component=5126, **more):
        self.views.append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": array.nbytes})
        self.binary += array.tobytes() + b"\0" * (-array.nbytes % 4)
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": component, "type": kind,
                               "count": array.size // {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[kind], **more})
        return len(self.accessors) - 1


def bind(y):
    """The inverse bind matrix of a joint at height y, in columns."""
    return [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -y, 0, 1]


def main(path):
    positions, triangles, weights = leg()
    times = (np.arange(FRAMES + 2) / FPS).astype("<f4")
    phase = times * 2 * np.pi
    out = Writer()
    joints = np.tile(np.array([0, 1, 0, 0], "u1"), (len(positions), 1))
    attributes = {"POSITION": out.add(positions, "VEC3", min=positions.min(0).tolist(), max=positions.max(0).tolist()),
                  "JOINTS_0": out.add(joints, "VEC4", 5121), "WEIGHTS_0": out.add(weights, "VEC4")}
    indices = out.add(triangles, "SCALAR", 5125)
    binds = out.add(np.array(bind(0) + bind(-1), "<f4"), "MAT4")
    keys = out.add(times, "SCALAR", min=[0], max=[float(times[-1])])
    hip = np.stack([times * 0.4, 0.05 * np.cos(2 * phase), 0 * times], -1).astype("<f4")
    samplers = [{"input": keys, "output": out.add(values, kind)} for values, kind in (
        (hip, "VEC3"), (turns(0.5 * np.sin(phase)), "VEC4"), (turns(-0.5 + 0.4 * np.cos(phase)), "VEC4"))]
    channels = [{"sampler": i, "target": {"node": node, "path": name}}
                for i, (node, name) in enumerate(((1, "translation"), (1, "rotation"), (2, "rotation")))]
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 3]}],
        "nodes": [{"name": "leg", "mesh": 0, "skin": 0}, {"name": "hip", "children": [2]}, {"name": "knee", "translation": [0, -1, 0]},
                  {"name": "eye", "camera": 0, "translation": [0.4, -1, 5]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1, "aspectRatio": 4 / 3}}],
        "materials": [{"name": "cloth", "doubleSided": True, "pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.3, 0.2, 1], "metallicFactor": 0}}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}],
        "skins": [{"joints": [1, 2], "inverseBindMatrices": binds}],
        "animations": [{"name": "walk", "channels": channels, "samplers": samplers}],
        "accessors": out.accessors, "bufferViews": out.views, "buffers": [{"byteLength": len(out.binary)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(out.binary)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(out.binary), b"BIN\0") + out.binary)


if __name__ == "__main__":
    main(sys.argv[1])
