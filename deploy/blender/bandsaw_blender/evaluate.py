"""Evaluates Blender's shader nodes that compute numbers, colours and vectors, at many points at once, with numpy.

A value is an array: (n) for a number, (n, 3) for a colour or vector; n is the number of points, or 1 where the value is the
same everywhere. A `Points` has the coordinates that coordinate nodes return."""

import numpy as np

from . import files, noise


class Unsupported(Exception):
    """Something, most often a node, cannot be evaluated; the text names it."""


class NeedsCoordinates(Unsupported):
    """A value depends on coordinates which the points do not have."""


class Points:
    """The points at which nodes are evaluated. Their number is n = `count`.

    Each coordinate is an array (n, 3), or None if the points do not have it. `generated`, `object`
    (the parameter `local`) and `normal` are in the object's space, `position` and `world_normal` in
    the world's. `uv` is a dictionary from the names of uv maps to arrays (n, 2). The key "" stands
    for the active map. The value None means that the mesh has a map of this name, but the points
    have no coordinates in it.
    `used`: a set that gets the names of the coordinates that nodes need, except for uvs."""

    def __init__(self, count, uv=None, generated=None, local=None, normal=None, position=None, world_normal=None, used=None):
        self.count, self.uv, self.generated = count, uv or {}, generated
        self.object, self.normal, self.position, self.world_normal = local, normal, position, world_normal
        self.used = set() if used is None else used


def source(socket):
    """Returns the socket that gives an input its value: an output socket, or an input whose own
    value is used because nothing is linked to it. Passes through reroutes and muted nodes."""
    own = socket
    while socket.is_linked and socket.links and socket.links[0].is_valid and not socket.links[0].is_muted:
        output = socket.links[0].from_socket
        if output.node.type == "REROUTE":
            socket = output.node.inputs[0]
        elif output.node.mute:
            passed = [link.from_socket for link in output.node.internal_links if link.to_socket == output]
            if not passed:
                break
            socket = own = passed[0]
        else:
            return output
    return own


def from_node(socket):
    """Returns the output socket that feeds an input, through reroutes and muted nodes; None if the
    input is not linked."""
    found = source(socket)
    return found if found.is_output else None


def input_of(node, *names):
    """Returns the first of these inputs, by identifier or name, that the node has; None if the node
    has none of them."""
    for name in names:
        for socket in node.inputs:
            if socket.identifier == name or socket.name == name:
                return socket
    return None


def number(value):
    """Returns a value as a number: the luminance of a colour, or the number itself. A vector
    is not converted here but in Evaluator.socket."""
    return value if value.ndim == 1 else value @ np.array([0.2126, 0.7152, 0.0722])


# Returns a value as a colour or vector (n, 3): a number becomes grey.
def color(value):
    return value if value.ndim == 2 else np.repeat(value[:, None], 3, axis=1)


class Evaluator:
    """Evaluates nodes at `points` (a Points). A node of type T is evaluated by the method
    node_T(node, output), which returns the value of that output.

    `images`: a function from a Blender image to its pixels (height, width, 4) as linear floats,
    rows from the bottom. `warn`: a function that gets a text about something that is not shown as
    in Blender. `light`: true for the nodes of a light or of the world, which are evaluated as
    diffuse rays see them; all other nodes are evaluated as rays of the camera see them. `groups`:
    the group nodes around the node that is evaluated, the innermost last. `memory`: values that
    were computed before."""

    def __init__(self, points, images, warn, light=False):
        self.points, self.images, self.warn, self.light = points, images, warn, light
        self.groups, self.memory = [], {}

    def socket(self, socket):
        """Returns the value of an input socket: the value that is linked to it, or its own value. A
        vector at an input for a number becomes the mean of its components, as in Blender. A colour
        stays a colour; number() converts it."""
        found = source(socket)
        if found.is_output:
            value = self.output(found)
        elif hasattr(found, "default_value"):
            own = np.atleast_1d(np.array(found.default_value, dtype=float))
            value = own if own.size == 1 else own[None, :3]
        else:
            raise Unsupported(f'the input "{found.name}"')
        return value.mean(axis=1) if (found.type, socket.type, value.ndim) == ("VECTOR", "VALUE", 2) else value

    # Returns the value of the first of these inputs that the node has; `default` if it has none.
    def of(self, node, *names, default=0.0):
        socket = input_of(node, *names)
        return self.socket(socket) if socket is not None else np.array([default])

    def one(self, node, *names, default=0.0):
        """Returns an input as a number that is the same at all points. Raises Unsupported if the
        number differs between points."""
        value = number(self.of(node, *names, default=default))
        if value.size > 1 and np.ptp(value) > 1e-6:
            raise Unsupported(f'a texture at "{names[0]}" of the node "{node.name}"')
        return float(value.flat[0])

    # Returns the value of an output socket, and keeps it in `memory`. Raises Unsupported.
    def output(self, output):
        key = (output.node.as_pointer(), output.identifier, tuple(id(group) for group in self.groups))
        if key not in self.memory:
            node = output.node
            function = getattr(self, "node_" + node.type.lower(), None)
            if function is None:
                raise Unsupported(f'the node "{node.name}" ({node.bl_label})')
            self.memory[key] = function(node, output)
        return self.memory[key]

    def coordinates(self, node):
        """Returns the Vector input of a texture node: the linked one, or the texture's default coordinate."""
        socket = input_of(node, "Vector")
        if from_node(socket) is not None:
            return color(self.socket(socket))
        if node.type == "TEX_IMAGE":
            return self.uv("")
        return self.need("generated", "generated coordinates")

    # Returns the coordinate `name` of the points. If the points do not have it, raises
    # NeedsCoordinates with the text `what`, which names the coordinate.
    def need(self, name, what):
        array = getattr(self.points, name)
        if array is None:
            raise NeedsCoordinates(what)
        self.points.used.add(name)
        return array

    # Returns the uv map `name` as vectors (n, 3) whose third component is 0. If the points do not
    # know this name, returns their active map. Raises NeedsCoordinates if the points have no
    # coordinates in the map.
    def uv(self, name):
        uv = self.points.uv.get(name, self.points.uv.get(""))
        if uv is None:
            raise NeedsCoordinates("uv coordinates")
        return np.concatenate([uv, np.zeros((len(uv), 1))], axis=1)

    # ---- groups ----

    def node_group(self, node, output):
        if node.node_tree is None:
            raise Unsupported(f'the group "{node.name}" without a tree')
        ends = [n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output]
        if not ends:
            raise Unsupported(f'the group "{node.name}" without an output')
        self.groups.append(node)
        try:
            return self.socket(next(s for s in ends[0].inputs if s.identifier == output.identifier))
        finally:
            self.groups.pop()

    def node_group_input(self, node, output):
        if not self.groups:
            raise Unsupported("a group's input outside of its group")
        group = self.groups.pop()
        try:
            return self.socket(next(s for s in group.inputs if s.identifier == output.identifier))
        finally:
            self.groups.append(group)

    # ---- coordinates ----

    def node_tex_coord(self, node, output):
        name = output.name
        if name == "UV":
            return self.uv("")
        if name == "Generated":
            return self.need("generated", "generated coordinates")
        if name == "Object" and node.object is None:
            return self.need("object", "object coordinates")
        if name == "Normal":
            return self.need("normal", "normals")
        raise Unsupported(f'"{name}" of the node "{node.name}"')

    def node_uvmap(self, node, output):
        return self.uv(node.uv_map)

    def node_new_geometry(self, node, output):
        if output.name == "Position":
            return self.need("position", "positions")
        if output.name in ("Normal", "True Normal"):
            return self.need("world_normal", "normals")
        if output.name == "Backfacing":
            self.warn(f'"Backfacing" of the node "{node.name}" is not shown; both sides are shaded as the front')
            return np.zeros(1)
        raise Unsupported(f'"{output.name}" of the node "{node.name}"')

    def node_light_path(self, node, output):
        ray = "Diffuse" if self.light else "Camera"
        self.warn(f'the node "{node.name}" depends on the ray; all rays get what it gives to {ray.lower()} rays')
        return np.array([1.0 if output.name == f"Is {ray} Ray" else 0.0])

    def node_mapping(self, node, output):
        from mathutils import Euler, Vector
        vector = color(self.of(node, "Vector"))
        place, turn, scale = (color(self.of(node, name))[0] for name in ("Location", "Rotation", "Scale"))
        turned = np.array(Euler(turn).to_matrix())
        if node.vector_type == "TEXTURE":
            return ((vector - place) @ turned) / np.where(scale == 0, 1, scale)
        if node.vector_type == "NORMAL":
            turned_vector = (vector / np.where(scale == 0, 1, scale)) @ turned.T
            return turned_vector / np.maximum(np.linalg.norm(turned_vector, axis=1, keepdims=True), 1e-20)
        moved = place if node.vector_type == "POINT" else 0
        return (vector * scale) @ turned.T + moved

    # ---- constants ----

    def node_rgb(self, node, output):
        return np.array(node.outputs[0].default_value, dtype=float)[None, :3]

    def node_value(self, node, output):
        return np.array([float(node.outputs[0].default_value)])

    def node_blackbody(self, node, output):
        return blackbody(number(self.of(node, "Temperature")))

    # ---- textures ----

    def node_tex_image(self, node, output):
        if node.image is None:
            return np.array([[1.0, 0.0, 1.0]]) if output.name == "Color" else np.ones(1)
        if node.projection != "FLAT":
            raise Unsupported(f'the projection of the image node "{node.name}"')
        pixels = self.images(node.image)
        if covered(node):
            pixels = multiplied(pixels)
        found = look_up(pixels, self.coordinates(node)[:, :2], node.extension, node.interpolation == "Closest")
        return found[:, 3] if output.name == "Alpha" else found[:, :3]

    def node_tex_environment(self, node, output):
        if node.image is None:
            return np.array([[1.0, 0.0, 1.0]])
        d = self.coordinates(node)
        d = d / np.maximum(np.linalg.norm(d, axis=1, keepdims=True), 1e-20)
        if node.projection != "EQUIRECTANGULAR":
            raise Unsupported(f'the mirror ball of the node "{node.name}"')
        uv = np.stack([-np.arctan2(d[:, 1], d[:, 0]) / (2 * np.pi) + 0.5, np.arcsin(np.clip(d[:, 2], -1, 1)) / np.pi + 0.5], axis=1)
        return look_up(self.images(node.image), uv, "REPEAT", node.interpolation == "Closest")[:, :3]

    def node_tex_noise(self, node, output):
        if getattr(node, "noise_dimensions", "3D") != "3D":
            raise Unsupported(f'{node.noise_dimensions} noise of the node "{node.name}"')
        if getattr(node, "noise_type", "FBM") != "FBM" or not getattr(node, "normalize", True):
            raise Unsupported(f'the kind of noise of the node "{node.name}"')
        scale = number(self.of(node, "Scale"))
        value, colors = noise.texture(self.coordinates(node) * scale[:, None], self.one(node, "Detail"), self.one(node, "Roughness"),
                                      self.one(node, "Distortion"), self.one(node, "Lacunarity", default=2.0))
        return colors if output.name == "Color" else value

    def node_tex_voronoi(self, node, output):
        plain = node.feature == "F1" and node.distance == "EUCLIDEAN" and node.voronoi_dimensions == "3D"
        if not plain or self.one(node, "Detail") != 0:
            raise Unsupported(f'the kind of Voronoi texture of the node "{node.name}"')
        scale = number(self.of(node, "Scale"))
        distance, colors, place = noise.voronoi(self.coordinates(node) * scale[:, None], self.one(node, "Randomness"))
        return {"Color": colors, "Position": place / np.maximum(scale[:, None], 1e-20)}.get(output.name, distance)

    def node_tex_checker(self, node, output):
        first = noise.checker(self.coordinates(node) * number(self.of(node, "Scale"))[:, None])
        if output.name == "Color":
            return color(self.of(node, "Color1")) * first[:, None] + color(self.of(node, "Color2")) * (1 - first[:, None])
        return first

    def node_tex_gradient(self, node, output):
        value = noise.gradient(self.coordinates(node), node.gradient_type)
        return color(value) if output.name == "Color" else value

    def node_tex_wave(self, node, output):
        p = self.coordinates(node) * number(self.of(node, "Scale"))[:, None]
        value = noise.wave(p, node, self.one(node, "Distortion"), self.one(node, "Detail"), self.one(node, "Detail Scale"),
                           self.one(node, "Detail Roughness", default=0.5), self.one(node, "Phase Offset"))
        return color(value) if output.name == "Color" else value

    # ---- colours ----

    def node_valtorgb(self, node, output):
        value = np.clip(number(self.of(node, "Fac")), 0, 1)
        table = np.array([tuple(node.color_ramp.evaluate(i / 1023)) for i in range(1024)])
        if node.color_ramp.interpolation == "CONSTANT":
            found = table[np.floor(value * 1023 + 1e-9).astype(int)]
        else:
            at = value * 1023
            low = np.minimum(at.astype(int), 1022)
            found = table[low] + (at - low)[:, None] * (table[low + 1] - table[low])
        return found[:, 3] if output.name == "Alpha" else found[:, :3]

    def node_mix_rgb(self, node, output):
        factor = number(self.of(node, "Fac"))
        return blended(node, node.blend_type, factor, color(self.of(node, "Color1")), color(self.of(node, "Color2")), node.use_clamp)

    def node_mix(self, node, output):
        vector = node.data_type == "VECTOR" and getattr(node, "factor_mode", "UNIFORM") == "NON_UNIFORM"
        factor = color(self.of(node, "Factor_Vector")) if vector else number(self.of(node, "Factor_Float"))
        if node.clamp_factor:
            factor = np.clip(factor, 0, 1)
        kind = {"RGBA": "Color", "VECTOR": "Vector", "FLOAT": "Float"}.get(node.data_type)
        if kind is None:
            raise Unsupported(f'the node "{node.name}" ({node.data_type})')
        a, b = self.of(node, "A_" + kind), self.of(node, "B_" + kind)
        if node.data_type == "RGBA":
            return blended(node, node.blend_type, factor, color(a), color(b), node.clamp_result)
        if node.data_type == "VECTOR":
            share = factor if vector else factor[:, None]
            return color(a) * (1 - share) + color(b) * share
        return number(a) * (1 - factor) + number(b) * factor

    def node_invert(self, node, output):
        c, share = color(self.of(node, "Color")), number(self.of(node, "Fac"))[:, None]
        return (1 - share) * c + share * (1 - c)

    def node_gamma(self, node, output):
        c = color(self.of(node, "Color"))
        return np.where(c > 0, np.power(np.maximum(c, 1e-30), number(self.of(node, "Gamma"))[:, None]), c)

    def node_brightcontrast(self, node, output):
        bright, contrast = (number(self.of(node, name))[:, None] for name in ("Bright", "Contrast"))
        return np.maximum((1 + contrast) * color(self.of(node, "Color")) + bright - contrast / 2, 0)

    def node_hue_sat(self, node, output):
        c, share = color(self.of(node, "Color")), number(self.of(node, "Fac"))[:, None]
        hue, saturation, value = (number(self.of(node, name)) for name in ("Hue", "Saturation", "Value"))
        hsv = to_hsv(c)
        hsv = np.stack(np.broadcast_arrays((hsv[:, 0] + hue + 0.5) % 1.0, np.clip(hsv[:, 1] * saturation, 0, 1), hsv[:, 2] * value), axis=1)
        return np.maximum((1 - share) * c + share * from_hsv(hsv), 0)

    def node_curve_rgb(self, node, output):
        mapping, c, share = node.mapping, color(self.of(node, "Color")), number(self.of(node, "Fac"))[:, None]
        mapping.initialize()
        at = np.linspace(0, 1, 257)
        every = np.array([mapping.evaluate(mapping.curves[3], x) for x in at])
        channels = []
        for k in range(3):
            own = np.array([mapping.evaluate(mapping.curves[k], x) for x in at])
            channels.append(np.interp(np.interp(c[:, k], at, every), at, own))
        return (1 - share) * c + share * np.stack(channels, axis=1)

    def node_rgbtobw(self, node, output):
        return number(color(self.of(node, "Color")))

    # Returns one channel of the node's input. `mode`: "HSV" converts the input to hue, saturation
    # and value; "RGB" and "XYZ" do not.
    def _separate(self, node, output, mode):
        value = color(self.of(node, "Color", "Image", "Vector"))
        if mode == "HSV":
            value = to_hsv(value)
        elif mode not in ("RGB", "XYZ"):
            raise Unsupported(f'the mode of the node "{node.name}"')
        return value[:, list(node.outputs).index(output)]

    # Returns the colour or vector of the node's three inputs. `mode`: as for _separate().
    def _combine(self, node, mode):
        parts = np.stack(np.broadcast_arrays(*(number(self.socket(socket)) for socket in list(node.inputs)[:3])), axis=1)
        if mode not in ("RGB", "XYZ", "HSV"):
            raise Unsupported(f'the mode of the node "{node.name}"')
        return from_hsv(parts) if mode == "HSV" else parts

    def node_seprgb(self, node, output):
        return self._separate(node, output, "RGB")

    def node_sephsv(self, node, output):
        return self._separate(node, output, "HSV")

    def node_sepxyz(self, node, output):
        return self._separate(node, output, "XYZ")

    def node_separate_color(self, node, output):
        return self._separate(node, output, node.mode)

    def node_combrgb(self, node, output):
        return self._combine(node, "RGB")

    def node_combhsv(self, node, output):
        return self._combine(node, "HSV")

    def node_combxyz(self, node, output):
        return self._combine(node, "XYZ")

    def node_combine_color(self, node, output):
        return self._combine(node, node.mode)

    # ---- numbers ----

    def node_clamp(self, node, output):
        low, high = number(self.of(node, "Min")), number(self.of(node, "Max"))
        if node.clamp_type == "RANGE":
            low, high = np.minimum(low, high), np.maximum(low, high)
        return np.minimum(np.maximum(number(self.of(node, "Value")), low), high)

    def node_map_range(self, node, output):
        if getattr(node, "data_type", "FLOAT") != "FLOAT":
            raise Unsupported(f'the node "{node.name}" (vectors)')
        value, a, b, c, d = (number(self.of(node, name)) for name in ("Value", "From Min", "From Max", "To Min", "To Max"))
        t = (value - a) / np.where(b == a, 1, b - a)
        if node.interpolation_type == "STEPPED":
            steps = number(self.of(node, "Steps"))
            t = np.floor(t * (steps + 1)) / np.maximum(steps, 1e-20)
        elif node.interpolation_type == "SMOOTHSTEP":
            t = np.clip(t, 0, 1)
            t = t * t * (3 - 2 * t)
        elif node.interpolation_type == "SMOOTHERSTEP":
            t = np.clip(t, 0, 1)
            t = t * t * t * (t * (t * 6 - 15) + 10)
        result = c + t * (d - c)
        if getattr(node, "clamp", False) and node.interpolation_type in ("LINEAR", "STEPPED"):
            result = np.clip(result, np.minimum(c, d), np.maximum(c, d))
        return result

    def node_math(self, node, output):
        x, y, z = ([number(self.socket(s)) for s in node.inputs] + [np.zeros(1)] * 2)[:3]
        function = MATH.get(node.operation)
        if function is None:
            raise Unsupported(f'the operation {node.operation} of the node "{node.name}"')
        with np.errstate(all="ignore"):
            result = np.nan_to_num(np.asarray(function(x, y, z), dtype=float))
        return np.clip(result, 0, 1) if node.use_clamp else result

    def node_vect_math(self, node, output):
        a, b = color(self.socket(node.inputs[0])), color(self.socket(node.inputs[1]))
        scale = number(self.of(node, "Scale", default=1.0))
        function = VECTOR_MATH.get(node.operation)
        if function is None:
            raise Unsupported(f'the operation {node.operation} of the node "{node.name}"')
        with np.errstate(all="ignore"):
            return np.nan_to_num(np.asarray(function(a, b, scale), dtype=float))


# The operations of Blender's node Math. Each has the parameters x, y and z, the node's three
# inputs.
MATH = {
    "ADD": lambda x, y, z: x + y, "SUBTRACT": lambda x, y, z: x - y, "MULTIPLY": lambda x, y, z: x * y,
    "DIVIDE": lambda x, y, z: np.where(y == 0, 0, x / y), "MULTIPLY_ADD": lambda x, y, z: x * y + z,
    "POWER": lambda x, y, z: np.power(x, y), "LOGARITHM": lambda x, y, z: np.log(x) / np.log(y),
    "SQRT": lambda x, y, z: np.sqrt(np.maximum(x, 0)), "INVERSE_SQRT": lambda x, y, z: 1 / np.sqrt(x), "ABSOLUTE": lambda x, y, z: np.abs(x),
    "EXPONENT": lambda x, y, z: np.exp(x), "MINIMUM": lambda x, y, z: np.minimum(x, y), "MAXIMUM": lambda x, y, z: np.maximum(x, y),
    "LESS_THAN": lambda x, y, z: (x < y) * 1.0, "GREATER_THAN": lambda x, y, z: (x > y) * 1.0, "SIGN": lambda x, y, z: np.sign(x),
    "COMPARE": lambda x, y, z: (np.abs(x - y) <= np.maximum(z, 1e-5)) * 1.0, "ROUND": lambda x, y, z: np.floor(x + 0.5),
    "FLOOR": lambda x, y, z: np.floor(x), "CEIL": lambda x, y, z: np.ceil(x), "TRUNC": lambda x, y, z: np.trunc(x),
    "FRACT": lambda x, y, z: x - np.floor(x), "MODULO": lambda x, y, z: np.fmod(x, y), "SINE": lambda x, y, z: np.sin(x),
    "COSINE": lambda x, y, z: np.cos(x), "TANGENT": lambda x, y, z: np.tan(x), "ARCSINE": lambda x, y, z: np.arcsin(x),
    "ARCCOSINE": lambda x, y, z: np.arccos(x), "ARCTANGENT": lambda x, y, z: np.arctan(x), "ARCTAN2": lambda x, y, z: np.arctan2(x, y),
    "RADIANS": lambda x, y, z: np.radians(x), "DEGREES": lambda x, y, z: np.degrees(x),
    "PINGPONG": lambda x, y, z: np.where(y == 0, 0, np.abs(((x - y) / (2 * y) - np.floor((x - y) / (2 * y))) * 2 * y - y)),
    "SNAP": lambda x, y, z: np.where(y == 0, 0, np.floor(x / y) * y), "WRAP": lambda x, y, z: np.where(y == z, z, x - (y - z) * np.floor((x - z) / (y - z))),
}


# Returns vectors (n, 3) with the length 1.
def unit(a):
    return a / np.maximum(np.linalg.norm(a, axis=1, keepdims=True), 1e-30)


# The operations of Blender's node Vector Math. `a` and `b` are vectors, `s` is the node's input
# Scale.
VECTOR_MATH = {
    "ADD": lambda a, b, s: a + b, "SUBTRACT": lambda a, b, s: a - b, "MULTIPLY": lambda a, b, s: a * b,
    "DIVIDE": lambda a, b, s: np.where(b == 0, 0, a / b), "SCALE": lambda a, b, s: a * s[:, None], "NORMALIZE": lambda a, b, s: unit(a),
    "LENGTH": lambda a, b, s: np.linalg.norm(a, axis=1), "DISTANCE": lambda a, b, s: np.linalg.norm(a - b, axis=1),
    "DOT_PRODUCT": lambda a, b, s: (a * b).sum(axis=1), "CROSS_PRODUCT": lambda a, b, s: np.cross(a, b), "ABSOLUTE": lambda a, b, s: np.abs(a),
    "MINIMUM": lambda a, b, s: np.minimum(a, b), "MAXIMUM": lambda a, b, s: np.maximum(a, b), "FLOOR": lambda a, b, s: np.floor(a),
    "CEIL": lambda a, b, s: np.ceil(a), "FRACTION": lambda a, b, s: a - np.floor(a), "MODULO": lambda a, b, s: np.fmod(a, b),
    "SINE": lambda a, b, s: np.sin(a), "COSINE": lambda a, b, s: np.cos(a), "TANGENT": lambda a, b, s: np.tan(a),
    "SNAP": lambda a, b, s: np.where(b == 0, 0, np.floor(a / b) * b),
}


def blended(node, kind, factor, a, b, clamp):
    """Returns two colours blended by Blender's blend mode `kind`. `factor`: (n) or (n, 3); `clamp`: the result is limited to [0, 1]."""
    t = np.clip(factor, 0, 1)
    t = t[:, None] if t.ndim == 1 else t
    a, b = np.broadcast_arrays(a, b)
    with np.errstate(all="ignore"):
        modes = {
            "MIX": lambda: b, "ADD": lambda: a + b, "MULTIPLY": lambda: a * b, "SUBTRACT": lambda: a - b, "SCREEN": lambda: 1 - (1 - a) * (1 - b),
            "DIVIDE": lambda: np.where(b == 0, a, a / b), "DIFFERENCE": lambda: np.abs(a - b), "DARKEN": lambda: np.minimum(a, b),
            "LIGHTEN": lambda: np.maximum(a, b), "OVERLAY": lambda: np.where(a < 0.5, 2 * a * b, 1 - 2 * (1 - a) * (1 - b)),
            "LINEAR_LIGHT": lambda: a + 2 * b - 1, "SOFT_LIGHT": lambda: (1 - a) * b * a + a * (1 - (1 - b) * (1 - a)),
            "DODGE": lambda: np.where(b >= 1, 1, np.minimum(a / np.maximum(1 - b, 1e-20), 1)),
            "BURN": lambda: np.where(b <= 0, 0, np.clip(1 - (1 - a) / np.maximum(b, 1e-20), 0, 1)),
        }
        if kind not in modes:
            raise Unsupported(f'the blend mode {kind} of the node "{node.name}"')
        result = (1 - t) * a + t * modes[kind]()
    return np.clip(result, 0, 1) if clamp else result


# Returns the hue, the saturation and the value (n, 3) of colours (n, 3).
def to_hsv(c):
    high, low = c.max(axis=1), c.min(axis=1)
    span = high - low
    safe = np.where(span == 0, 1, span)
    r, g, b = ((high - c[:, k]) / safe for k in range(3))
    hue = np.where(c[:, 0] == high, b - g, np.where(c[:, 1] == high, 2 + r - b, 4 + g - r)) / 6 % 1.0
    return np.stack([np.where(span == 0, 0, hue), np.where(high == 0, 0, span / np.where(high == 0, 1, high)), high], axis=1)


# Returns the colours (n, 3) of hues, saturations and values (n, 3): the inverse of to_hsv().
def from_hsv(hsv):
    h, s, v = hsv[:, 0] * 6, hsv[:, 1], hsv[:, 2]
    parts = [np.clip(np.abs(h - 3) - 1, 0, 1), np.clip(2 - np.abs(h - 2), 0, 1), np.clip(2 - np.abs(h - 4), 0, 1)]
    return np.stack([((p - 1) * s + 1) * v for p in parts], axis=1)


def blackbody(temperature):
    """Returns the colours (n, 3) of black bodies of these temperatures (kelvin), scaled to the
    luminance 1. They follow from Planck's law and the CIE's observer (fit of Wyman et al. 2013).
    The matrix converts from XYZ to linear sRGB."""
    wave = np.arange(380.0, 781.0, 5.0)

    def bell(mean, left, right):
        return np.exp(-0.5 * ((wave - mean) * np.where(wave < mean, left, right)) ** 2)

    xyz = np.stack([1.056 * bell(599.8, 1 / 37.9, 1 / 31.0) + 0.362 * bell(442.0, 1 / 16.0, 1 / 26.7) - 0.065 * bell(501.1, 1 / 20.4, 1 / 26.2),
                    0.821 * bell(568.8, 1 / 46.9, 1 / 40.5) + 0.286 * bell(530.9, 1 / 16.3, 1 / 31.1),
                    1.217 * bell(437.0, 1 / 11.8, 1 / 36.0) + 0.681 * bell(459.0, 1 / 26.0, 1 / 13.8)], axis=1)
    t = np.maximum(np.atleast_1d(temperature), 800.0)[:, None]
    power = wave ** -5.0 / np.expm1(1.4387769e7 / (wave * t))
    found = power @ xyz
    found /= found[:, 1:2]
    to_rgb = np.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]])
    return np.maximum(found @ to_rgb.T, 0)


def covered(node):
    """Returns true if the colours of an image node must be multiplied by their alpha. Cycles
    multiplies them if the node's output Alpha is not used. Pixels of float images are multiplied by
    alpha already."""
    image = node.image
    return (image.depth == 32 and not image.is_float and image.colorspace_settings.name == "sRGB" and
            image.alpha_mode not in ("CHANNEL_PACKED", "NONE") and not node.outputs["Alpha"].is_linked)


# Returns linear pixels (height, width, 4) whose colours are multiplied by alpha. As in Cycles, the
# sRGB-encoded values are multiplied, not the linear ones.
def multiplied(pixels):
    alpha = pixels[:, :, 3:]
    return np.concatenate([files.linear(files.srgb_codes(pixels[:, :, :3]) / 255 * alpha), alpha], axis=2)


def look_up(pixels, uv, extension, nearest):
    """Returns the values (n, 4) of an image at uv (n, 2). `pixels`: (height, width, 4), rows from
    the bottom. `extension`: Blender's name of the rule for points beyond the image's edges:
    "REPEAT", "MIRROR", "EXTEND" or "CLIP". `nearest`: without interpolation."""
    height, width = pixels.shape[:2]
    size = np.array([width, height])

    def texels(index):
        if extension == "REPEAT":
            index = index % size
        elif extension == "MIRROR":
            index = index % (2 * size)
            index = np.where(index >= size, 2 * size - 1 - index, index)
        else:
            index = np.clip(index, 0, size - 1)
        return pixels[index[:, 1], index[:, 0]]

    at = uv * size
    if nearest:
        found = texels(np.floor(at).astype(int))
    else:
        at = at - 0.5
        low = np.floor(at).astype(int)
        f = at - low
        found = 0
        for dx in (0, 1):
            for dy in (0, 1):
                weight = (f[:, 0] if dx else 1 - f[:, 0]) * (f[:, 1] if dy else 1 - f[:, 1])
                found = found + texels(low + (dx, dy)) * weight[:, None]
    if extension == "CLIP":
        found = np.where(((uv < 0) | (uv > 1)).any(axis=1)[:, None], 0, found)
    return found


def linear_pixels(image):
    """Returns the pixels of a Blender image as linear floats (height, width, 4), rows from the
    bottom. Raises Unsupported if the image has no pixels."""
    width, height = image.size
    if width == 0 or height == 0:
        raise Unsupported(f'the image "{image.name}", whose file is missing or cannot be read')
    channels = image.channels
    flat = np.empty(width * height * channels, dtype=np.float32)
    image.pixels.foreach_get(flat)
    found = flat.reshape(height, width, channels).astype(np.float64)
    if channels < 3:
        found = np.concatenate([np.repeat(found[:, :, :1], 3, axis=2), found[:, :, 1:] if channels == 2 else np.ones((height, width, 1))], axis=2)
    elif channels == 3:
        found = np.concatenate([found, np.ones((height, width, 1))], axis=2)
    if not image.is_float and image.colorspace_settings.name == "sRGB":
        found[:, :, :3] = files.linear(found[:, :, :3])
    return found
