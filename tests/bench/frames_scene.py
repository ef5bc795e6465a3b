#!/usr/bin/env python3
"""Writes a glTF file (.glb) for frames.sh: a rippled plane of N x N squares under a camera that moves for 400 seconds.

Usage: frames_scene.py FILE N
A vertex has 32 bytes (position, normal and uv), and a square has 24 bytes of indices. With N = 4300 the file has 1 GB.
"""

import json
import struct
import sys

import numpy as np


def grid(n):
    """Returns positions, normals, uvs (float32) and indices (uint32) of the plane."""
    at = np.linspace(-1, 1, n + 1, dtype=np.float32)
    x, z = np.meshgrid(at, at)
    y = 0.05 * np.sin(20 * x) * np.cos(15 * z)
    positions = np.stack([x, y, z], -1).reshape(-1, 3).astype("<f4")
    slope_x = np.cos(20 * x) * np.cos(15 * z)
    slope_z = -0.75 * np.sin(20 * x) * np.sin(15 * z)
    normals = np.stack([-slope_x, np.ones_like(x), -slope_z], -1).reshape(-1, 3)
    normals = (normals / np.linalg.norm(normals, axis=1, keepdims=True)).astype("<f4")
    uvs = (np.stack([x, z], -1).reshape(-1, 2) * 0.5 + 0.5).astype("<f4")
    first = (np.arange(n, dtype=np.uint32)[:, None] * (n + 1) + np.arange(n, dtype=np.uint32)).reshape(-1)
    corners = np.stack([first, first + n + 1, first + 1, first + 1, first + n + 1, first + n + 2], -1)
    return positions, normals, uvs, corners.reshape(-1).astype("<u4")


# Writes the plane of n x n squares to the file `path`. The numbers 5126 and 5125 are glTF's codes of float32 and
# uint32.
def main(path, n):
    positions, normals, uvs, indices = grid(n)
    times = np.array([0, 400], "<f4")
    moves = np.array([[0, 1.2, 2], [1.5, 1.2, 2]], "<f4")
    arrays = [positions, normals, uvs, indices, times, moves]
    views, offset = [], 0
    for array in arrays:
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": array.nbytes})
        offset += array.nbytes

    def accessor(view, component, count, kind, **more):
        return {"bufferView": view, "componentType": component, "count": count, "type": kind, **more}

    vertices = len(positions)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "name": "plane"},
                  {"camera": 0, "name": "eye", "translation": [0, 1.2, 2], "rotation": [-0.2588, 0, 0, 0.9659]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3}]}],
        "animations": [{"name": "fly", "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
                        "samplers": [{"input": 4, "output": 5}]}],
        "accessors": [
            accessor(0, 5126, vertices, "VEC3", min=positions.min(0).tolist(), max=positions.max(0).tolist()),
            accessor(1, 5126, vertices, "VEC3"), accessor(2, 5126, vertices, "VEC2"),
            accessor(3, 5125, len(indices), "SCALAR"),
            accessor(4, 5126, 2, "SCALAR", min=[0], max=[400]), accessor(5, 5126, 2, "VEC3")],
        "bufferViews": views, "buffers": [{"byteLength": offset}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + offset))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", offset, b"BIN\0"))
        for array in arrays:
            file.write(array.tobytes())


main(sys.argv[1], int(sys.argv[2]))
