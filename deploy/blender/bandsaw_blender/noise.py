"""Blender's procedural textures as numpy functions of points: Perlin noise and its fractal, Voronoi
cells, checker, gradients and waves. Points are arrays of shape (n, 3); results have n rows. The
functions follow Blender's definitions, including its hash, so that the patterns are the same."""

import numpy as np

_MASK = np.uint32(0xFFFFFFFF)


# Returns the uint32 array x with the bits rotated by k places to the left.
def _rotate(x, k):
    return ((x << np.uint32(k)) | (x >> np.uint32(32 - k))).astype(np.uint32)


# The constants of _hash, _hash4, _gradient, signed and checker are Blender's.
def _hash(*keys):
    """Returns the hash of one to three uint32 arrays, row by row: the final mix of Jenkins' lookup3."""
    start = np.uint32((0xDEADBEEF + (len(keys) << 2) + 13) & 0xFFFFFFFF)
    a, b, c = (np.broadcast_to(start, keys[0].shape).astype(np.uint32) for _ in range(3))
    with np.errstate(over="ignore"):
        a = a + keys[0]
        if len(keys) > 1:
            b = b + keys[1]
        if len(keys) > 2:
            c = c + keys[2]
        c = (c ^ b) - _rotate(b, 14)
        a = (a ^ c) - _rotate(c, 11)
        b = (b ^ a) - _rotate(a, 25)
        c = (c ^ b) - _rotate(b, 16)
        a = (a ^ c) - _rotate(c, 4)
        b = (b ^ a) - _rotate(a, 14)
        c = (c ^ b) - _rotate(b, 24)
    return c


# Returns the bits of 32-bit floats as uint32.
def _bits(x):
    return np.asarray(x, dtype=np.float32).view(np.uint32)


def _hash_floats(*keys):
    """Returns a number in [0, 1] for each row of keys, which are float arrays."""
    return _hash(*(_bits(key) for key in keys)).astype(np.float64) / 0xFFFFFFFF


def _offset(seed):
    """Returns a vector, an array of shape (3,), that the hash of the number `seed` determines. Blender
    adds this vector to the points, so that noises with different seeds are independent."""
    one = np.full(1, seed, dtype=np.float32)
    return 100 + 100 * np.array([_hash_floats(one, np.full(1, k, dtype=np.float32))[0] for k in (0, 1, 2)])


# Returns the dot product of (x, y, z) with one of the gradients of Perlin noise, which the hash `h` selects.
def _gradient(h, x, y, z):
    h = h & np.uint32(15)
    u = np.where(h < 8, x, y)
    v = np.where(h < 4, y, np.where((h == 12) | (h == 14), x, z))
    return np.where(h & 1, -u, u) + np.where(h & 2, -v, v)


def signed(p):
    """Returns Perlin noise in about [-1, 1], (n)."""
    cell = np.floor(p)
    f = p - cell
    i = cell.astype(np.int64).astype(np.uint32)
    w = f * f * f * (f * (f * 6 - 15) + 10)
    total = 0
    for corner in range(8):
        d = np.array([corner & 1, corner >> 1 & 1, corner >> 2 & 1])
        with np.errstate(over="ignore"):
            h = _hash(*(i[:, k] + np.uint32(d[k]) for k in range(3)))
        value = _gradient(h, *(f[:, k] - d[k] for k in range(3)))
        total = total + value * np.prod(np.where(d == 1, w, 1 - w), axis=1)
    return 0.982 * total


def fractal(p, detail, roughness, lacunarity=2.0):
    """Returns Blender's fractal noise in [0, 1]: a sum of octaves of noise, divided by the sum of
    their amplitudes. `detail`: number of octaves after the first one, not always whole.
    `roughness`: the amplitude of an octave divided by the amplitude of the octave before.
    `lacunarity`: the frequency of an octave divided by the frequency of the octave before."""
    detail = min(max(float(detail), 0.0), 15.0)
    whole = int(detail)
    scale = amplitude = 1.0
    amplitudes = total = 0.0
    for _ in range(whole + 1):
        total = total + amplitude * (0.5 * signed(scale * p) + 0.5)
        amplitudes += amplitude
        amplitude *= min(max(roughness, 0.0), 1.0)
        scale *= lacunarity
    # If `detail` is not whole, interpolates between the sums without and with one more octave.
    rest = detail - whole
    if rest == 0:
        return total / amplitudes
    more = total + amplitude * (0.5 * signed(scale * p) + 0.5)
    return (1 - rest) * total / amplitudes + rest * more / (amplitudes + amplitude)


def texture(p, detail, roughness, distortion, lacunarity=2.0):
    """Returns the Noise Texture: its value (n) and its colour (n, 3)."""
    if distortion != 0:
        p = p + distortion * np.stack([signed(p + _offset(k)) for k in (0, 1, 2)], axis=1)
    parts = [fractal(q, detail, roughness, lacunarity) for q in (p, p + _offset(3), p + _offset(4))]
    return parts[0], np.stack(parts, axis=1)


def voronoi(p, randomness):
    """Returns the Voronoi Texture of Blender's kind F1, which finds the nearest point by Euclidean
    distance. Returns the distance (n), the colour (n, 3) and the position (n, 3) of this point."""
    cell = np.floor(p)
    best, chosen, place = np.full(len(p), 1e30), np.zeros_like(p), np.zeros_like(p)
    for x in (-1, 0, 1):
        for y in (-1, 0, 1):
            for z in (-1, 0, 1):
                neighbour = cell + (x, y, z)
                point = neighbour + randomness * _hash_point(neighbour)
                distance = np.linalg.norm(point - p, axis=1)
                closer = distance < best
                best = np.where(closer, distance, best)
                chosen[closer], place[closer] = neighbour[closer], point[closer]
    return best, _hash_point(chosen), place


def _hash_point(k):
    """Returns three numbers in [0, 1] for each cell."""
    x, y, z = (_bits(k[:, i]) for i in range(3))
    four = [_bits(np.full(len(k), w, dtype=np.float32)) for w in (1, 2)]
    return np.stack([_hash(x, y, z).astype(np.float64) / 0xFFFFFFFF, _hash4(x, y, z, four[0]), _hash4(x, y, z, four[1])], axis=1)


# Returns numbers in [0, 1] for four uint32 arrays, row by row. It uses lookup3, like _hash().
def _hash4(kx, ky, kz, kw):
    start = np.uint32((0xDEADBEEF + (4 << 2) + 13) & 0xFFFFFFFF)
    with np.errstate(over="ignore"):
        a, b, c = start + kx, start + ky, start + kz
        a = a - c; a = a ^ _rotate(c, 4); c = c + b
        b = b - a; b = b ^ _rotate(a, 6); a = a + c
        c = c - b; c = c ^ _rotate(b, 8); b = b + a
        a = a - c; a = a ^ _rotate(c, 16); c = c + b
        b = b - a; b = b ^ _rotate(a, 19); a = a + c
        c = c - b; c = c ^ _rotate(b, 4); b = b + a
        a = a + kw
        c = (c ^ b) - _rotate(b, 14)
        a = (a ^ c) - _rotate(c, 11)
        b = (b ^ a) - _rotate(a, 25)
        c = (c ^ b) - _rotate(b, 16)
        a = (a ^ c) - _rotate(c, 4)
        b = (b ^ a) - _rotate(a, 14)
        c = (c ^ b) - _rotate(b, 24)
    return c.astype(np.float64) / 0xFFFFFFFF


def checker(p):
    """Returns 1 where the Checker Texture shows its first colour, else 0."""
    q = (p + 0.000001) * 0.999999
    i = np.abs(np.floor(q).astype(np.int64))
    return ((i[:, 0] % 2 == i[:, 1] % 2) == (i[:, 2] % 2 != 0)).astype(float)


def gradient(p, kind):
    """Returns the Gradient Texture in [0, 1]. `kind`: Blender's gradient_type."""
    x, y = p[:, 0], p[:, 1]
    if kind == "LINEAR":
        value = x
    elif kind == "QUADRATIC":
        value = np.maximum(x, 0) ** 2
    elif kind == "EASING":
        r = np.clip(x, 0, 1)
        value = 3 * r * r - 2 * r * r * r
    elif kind == "DIAGONAL":
        value = (x + y) / 2
    elif kind == "RADIAL":
        value = np.arctan2(y, x) / (2 * np.pi) + 0.5
    else:
        r = np.maximum(0.999999 - np.linalg.norm(p, axis=1), 0)
        value = r * r if kind == "QUADRATIC_SPHERE" else r
    return np.clip(value, 0, 1)


def wave(p, node, distortion, detail, detail_scale, roughness, phase):
    """Returns the Wave Texture in [0, 1]. `node`: the node, which has the kind, the direction and
    the profile of the waves."""
    q = (p + 0.000001) * 0.999999
    if node.wave_type == "BANDS":
        axis = {"X": q[:, 0], "Y": q[:, 1], "Z": q[:, 2]}.get(node.bands_direction)
        n = 20 * axis if axis is not None else 10 * q.sum(axis=1)
    else:
        r = q * {"X": (0, 1, 1), "Y": (1, 0, 1), "Z": (1, 1, 0)}.get(node.rings_direction, (1, 1, 1))
        n = 20 * np.linalg.norm(r, axis=1)
    n = n + phase
    if distortion != 0:
        n = n + distortion * (fractal(q * detail_scale, detail, roughness) * 2 - 1)
    if node.wave_profile == "SIN":
        return 0.5 + 0.5 * np.sin(n - np.pi / 2)
    n = n / (2 * np.pi)
    saw = n - np.floor(n)
    return saw if node.wave_profile == "SAW" else 2 * np.abs(n - np.floor(n + 0.5))
