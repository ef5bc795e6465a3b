"""Converts Blender's materials to materials of a scene file.

The nodes between the textures and a shader are evaluated (evaluate.py). A value that is the same
everywhere becomes a number. An image whose values are used without change stays an image. All other
values are baked. A value that depends on uvs alone is baked into an image over the uvs. Every other
value is baked into an atlas (geometry.Atlas), in which each triangle has texels of its own; the uvs
of the atlas become the second uv set of the mesh."""

import numpy as np

from . import evaluate, files, geometry
from .evaluate import Unsupported, from_node, input_of

MOST_BAKED = 2048  # largest side of an image that is baked over the uvs, in texels


class Value:
    """A colour or a number. It has either `constant`, an array of 3, or `texture`, a message of a scene file. A texture that is a number is grey."""

    def __init__(self, constant=None, texture=None):
        self.constant = None if constant is None else np.broadcast_to(np.asarray(constant, dtype=float), (3,)).copy()
        self.texture = texture

    @property
    def number(self):
        """Returns the constant's luminance; 1 for a texture."""
        return 1.0 if self.constant is None else float(self.constant @ (0.2126, 0.7152, 0.0722))

    def is_constant(self, number):
        return self.constant is not None and bool(np.all(np.abs(self.constant - number) < 1e-6))

    def message(self):
        return self.texture if self.texture is not None else {"color": rgb(self.constant)}

    def times(self, other):
        """Returns the product of two Values."""
        if self.constant is not None and other.constant is not None:
            return Value(self.constant * other.constant)
        if self.is_constant(1):
            return other
        if other.is_constant(1):
            return self
        if self.is_constant(0) or other.is_constant(0):
            return Value(0)
        return Value(texture={"product": {"a": self.message(), "b": other.message()}})

    def inverse(self):
        """Returns 1 minus the value."""
        if self.constant is not None:
            return Value(1 - self.constant)
        return Value(texture={"mix": {"a": {"color": rgb((1, 1, 1))}, "b": {"color": rgb((0, 0, 0))}, "amount": self.texture}})


# Returns a reflectance, a share or a roughness as a scene file may have it: each component in [0, 1].
def limited(value):
    return np.clip(value, 0, 1)


# Returns the message Color.
def rgb(values):
    return {"rgb": [float(max(x, 0.0)) for x in values]}


class Surface:
    """A material in the making. `kind`: "" for a surface that does nothing except emit,
    "transparent", or the name of the field of the message Material that holds the material's
    parameters. `fields`: these parameters. `emission`: a Value or None; `opacity`: a Value;
    `normal`: the normal map, a Value or None, with `normal_scale`. A Surface of the kind "mix" also
    has `parts`, its two Surfaces."""

    def __init__(self, kind, **fields):
        self.kind, self.fields = kind, fields
        self.emission, self.opacity, self.normal, self.normal_scale = None, Value(1), None, 1.0


class Piece:
    """A piece of geometry with one material. `triangles`: a geometry.Triangles; `low`, `size`: the
    box of the whole mesh, for generated coordinates; `world`: the 4 x 4 matrix that places the
    piece; `uv_names`: the names of the uv sets. `atlas`: a geometry.Atlas, made when a texture
    needs it; `used`: the names of the coordinates that the textures need, as in evaluate.Points."""

    def __init__(self, triangles, low, size, world, uv_names):
        self.triangles, self.low, self.size, self.world, self.uv_names = triangles, low, size, world, uv_names
        self.atlas, self.used = None, set()

    def make_atlas(self):
        """Returns the atlas of the piece, and makes it at the first call."""
        if self.atlas is None:
            # The atlas takes the place of the second uv set. Look-ups in the second uv set are
            # baked too.
            self.atlas = geometry.Atlas(len(self.triangles.indices))
        return self.atlas

    def finished(self):
        """Returns the Triangles to send: with an atlas, its uvs are their second uv set."""
        if self.atlas is None:
            return self.triangles
        corners = self.triangles.corners()
        first = corners.uvs[0] if corners.uvs else self.atlas.uvs
        corners.uvs = [first, self.atlas.uvs]
        return corners

    def points(self, du=0.0, dv=0.0):
        """Returns the atlas's texels, moved by du and dv texels, as Points."""
        atlas = self.make_atlas()
        weights = atlas.weights
        if du or dv:
            # The legs of a triangle are atlas.cell - 4 texels long (geometry.Atlas). So a step of
            # one texel changes a barycentric coordinate by 1 / (atlas.cell - 4). The second
            # triangle of a pair is rotated by 180 degrees, so the sign is the opposite one.
            sign = np.where(atlas.triangle % 2 == 0, 1.0, -1.0) / (atlas.cell - 4.0)
            b, c = weights[:, 1] + du * sign, weights[:, 2] + dv * sign
            weights = np.stack([1 - b - c, b, c], axis=1)
        flat = self.triangles.indices.reshape(-1)

        def spread(per_corner):
            by_triangle = per_corner.reshape(-1, 3, per_corner.shape[1])[np.maximum(atlas.triangle, 0)]
            return np.einsum("nk,nkd->nd", weights, by_triangle)

        local = spread(self.triangles.positions.astype(np.float64)[flat])
        undeformed = local if self.triangles.undeformed is None else spread(self.triangles.undeformed.astype(np.float64)[flat])
        normal = evaluate.unit(spread(self.triangles.corner_normals().astype(np.float64)))
        uvs = [spread(uv.astype(np.float64)[flat]) for uv in self.triangles.uvs]
        world = np.array(self.world)
        return evaluate.Points(len(local), uv={"": uvs[0], **dict(zip(self.uv_names, uvs))} if uvs else {},
                               generated=(undeformed - self.low) / self.size, local=local, normal=normal,
                               position=local @ world[:3, :3].T + world[:3, 3],
                               world_normal=evaluate.unit(normal @ np.linalg.pinv(world[:3, :3])), used=self.used)


class Images:
    """Images of a scene: their pixels for evaluation, and their files. `store(name, bytes)` returns the name under which a file is sent."""

    READABLE = {"PNG": ".png", "JPEG": ".jpg", "WEBP": ".webp", "TARGA": ".tga", "TARGA_RAW": ".tga", "BMP": ".bmp", "HDR": ".hdr", "OPEN_EXR": ".exr",
                "OPEN_EXR_MULTILAYER": None}

    def __init__(self, store, warn):
        self.store, self.warn, self._pixels, self._files = store, warn, {}, {}

    def pixels(self, image):
        key = image.name_full
        if key not in self._pixels:
            if image.source not in ("FILE", "GENERATED"):
                raise Unsupported(f'the image "{image.name}" ({image.source.lower()})')
            self._pixels[key] = evaluate.linear_pixels(image)
        return self._pixels[key]

    # Returns the name that the encoding of the image's colours has in scene files.
    def encoding(self, image):
        if image.colorspace_settings.name in ("Non-Color", "Raw", "Linear", "Linear Rec.709"):
            return "ENCODING_LINEAR"
        if image.colorspace_settings.name != "sRGB":
            self.warn(f'the image "{image.name}" has the colour space {image.colorspace_settings.name}, which is read as sRGB')
        return "ENCODING_SRGB"

    def file(self, image, unlimited=True, covered=False):
        """Returns the name of the image's file in the scene. `unlimited`: values may exceed 1;
        otherwise larger values become 1. `covered`: the colours are multiplied by alpha. Raises
        Unsupported if the image has no file."""
        # lower: the file needs limited values; darker: it needs colours multiplied by alpha.
        lower = not unlimited and image.is_float and bool(self.pixels(image)[:, :, :3].max() > 1)
        darker = covered and bool(self.pixels(image)[:, :, 3].min() < 1)
        key = image.name_full, lower, darker
        if key not in self._files:
            if lower:
                self._files[key] = self._encoded(image, limited(self.pixels(image)))
            else:
                self._files[key] = self._encoded(image, evaluate.multiplied(self.pixels(image))) if darker else self._stored(image)
        return self._files[key]

    # Stores the image's own file if Bandsaw reads its format and the image was not changed in
    # Blender. Otherwise encodes the pixels. Returns the file's name.
    def _stored(self, image):
        suffix = self.READABLE.get(image.file_format)
        if image.source == "FILE" and not image.is_dirty and suffix is not None:
            if image.packed_file is not None:
                return self.store("image" + suffix, bytes(image.packed_file.data))
            path = image.filepath_from_user()
            try:
                with open(path, "rb") as file:
                    return self.store("image" + suffix, file.read())
            except OSError:
                raise Unsupported(f'the image "{image.name}", whose file is missing ({path})')
        return self._encoded(image, self.pixels(image))

    # Stores `pixels` as an OpenEXR file if the image has floats, otherwise as a PNG file. Returns
    # the file's name.
    def _encoded(self, image, pixels):
        pixels = pixels[::-1, :, :3]
        if image.is_float:
            return self.store("image.exr", files.exr(pixels))
        codes = files.srgb_codes(pixels) if image.colorspace_settings.name == "sRGB" else (np.clip(pixels, 0, 1) * 255 + 0.5).astype(np.uint8)
        return self.store("image.png", files.png(codes))


class Shader:
    """Converts one Blender material on one piece of geometry. `out`: the scene in the making, with `images`, `material(message)` and
    `warn(text)`."""

    def __init__(self, out, material, piece):
        self.out, self.blender, self.piece = out, material, piece
        self.groups = []
        self.version = out.version

    def warn(self, text):
        self.out.warn(f'material "{self.blender.name}": {text}')

    # ---- values ----

    def evaluator(self, points):
        made = evaluate.Evaluator(points, self.out.images.pixels, self.warn)
        made.groups = list(self.groups)
        return made

    def constant(self, socket):
        """Returns the value of an input, an array of 3, if it is the same everywhere; otherwise
        None. Raises Unsupported."""
        try:
            value = self.evaluator(evaluate.Points(1)).socket(socket)
        except evaluate.NeedsCoordinates:
            return None
        return value[0] if value.ndim == 2 else np.repeat(value[:1], 3)

    def value(self, socket, is_number=False, default=0.0, unlimited=False):
        """Returns the Value of an input, or of `default` if the shader has no such input.
        `unlimited`: the value may exceed 1, as emission does; otherwise it is limited to [0, 1]. If
        the input cannot be evaluated, warns and returns the input's own value."""
        if socket is None:
            return Value(default)
        limit = (lambda value: value) if unlimited else limited
        try:
            constant = self.constant(socket)
            if constant is not None:
                return Value(limit(evaluate.number(constant[None])[0] if is_number else constant))
            direct = self.direct_image(socket, unlimited)
            return direct if direct is not None else self.baked(socket, is_number, unlimited)
        except Unsupported as error:
            self.warn(f"{error} cannot be shown; {socket.name} is constant there")
            own = np.atleast_1d(np.array(socket.default_value, dtype=float))
            return Value(limit(own[0] if own.size == 1 else own[:3]))

    def number(self, node, *names, default=0.0, unlimited=False):
        return self.value(input_of(node, *names), True, default, unlimited)

    def plain(self, node, *names, default=0.0):
        """Returns a number for a field that takes no texture. If the input has a texture, warns. Then
        returns the mean of the texture if it was baked, otherwise the input's own value."""
        socket = input_of(node, *names)
        value = self.value(socket, True, default, unlimited=True)
        if value.constant is None:
            self.warn(f"a texture at {socket.name} cannot be shown; one value is used instead of it")
            return float(value.mean) if hasattr(value, "mean") else float(socket.default_value)
        return value.number

    def direct_image(self, socket, unlimited=False):
        """Returns the Value of an input that is an image without any change; None if the input has
        to be baked. `unlimited`: values may exceed 1."""
        output = from_node(socket)
        if output is None or output.node.type != "TEX_IMAGE" or output.name != "Color" or self.in_group(output):
            return None
        node = output.node
        if node.image is None or node.projection != "FLAT" or node.extension not in ("REPEAT", "EXTEND", "MIRROR") or node.image.source != "FILE":
            return None
        placed = self.placement(node)
        if placed is None:
            return None
        wrap = {"REPEAT": "WRAP_REPEAT", "EXTEND": "WRAP_CLAMP", "MIRROR": "WRAP_MIRROR"}[node.extension]
        nearest = "FILTER_NEAREST" if node.interpolation == "Closest" else "FILTER_BILINEAR"
        file = self.out.images.file(node.image, unlimited, evaluate.covered(node))
        image = {"file": file, "wrap": wrap, "filter": nearest, "encoding": self.out.images.encoding(node.image), **placed}
        return Value(texture={"image": image})

    # Returns true if the node of `output` is in another node tree than the shader that is converted.
    def in_group(self, output):
        return output.node.id_data != self.tree

    def placement(self, node):
        """Returns the fields of ImageTexture that place the image of a node on the first uv set;
        None if the image is placed in another way."""
        output = from_node(input_of(node, "Vector"))
        fields = {}
        if output is not None and output.node.type == "MAPPING" and output.node.vector_type == "POINT" and not self.in_group(output):
            mapping = output.node
            parts = []
            for name in ("Location", "Rotation", "Scale"):
                socket = input_of(mapping, name)
                if from_node(socket) is not None:
                    return None
                parts.append(tuple(socket.default_value))
            place, turn, scale = parts
            if abs(turn[0]) > 1e-6 or abs(turn[1]) > 1e-6:
                return None
            fields = {"uv_offset": [place[0], place[1]], "uv_rotate": float(np.degrees(turn[2])), "uv_scale": [scale[0], scale[1]]}
            output = from_node(input_of(mapping, "Vector"))
            if output is None:
                return None
        if output is None:
            return fields if self.piece.triangles.uvs else None
        name = output.node.uv_map if output.node.type == "UVMAP" else "" if output.node.type == "TEX_COORD" and output.name == "UV" else None
        if name is None or not self.piece.triangles.uvs:
            return None
        return fields if name in ("", self.piece.uv_names[0]) else None

    # Returns the Value of an input as a baked image. The image lies over the uvs if the uvs are in
    # [0, 1] and the input depends on nothing else; otherwise it is an atlas. `unlimited`: values
    # may exceed 1.
    def baked(self, socket, is_number, unlimited=False):
        uvs = self.piece.triangles.uvs
        if uvs and uvs[0].min() >= -1e-6 and uvs[0].max() <= 1 + 1e-6:
            size = self.bake_size(socket)
            y, x = np.divmod(np.arange(size[0] * size[1]), size[0])
            grid = np.stack([(x + 0.5) / size[0], (y + 0.5) / size[1]], axis=1)
            try:
                known = {**dict.fromkeys(self.piece.uv_names), "": grid, self.piece.uv_names[0]: grid}
                value = self.evaluator(evaluate.Points(len(grid), uv=known)).socket(socket)
                return self.stored(value, size, is_number, unlimited, {})
            except evaluate.NeedsCoordinates:
                pass
        points = self.piece.points()
        value = self.evaluator(points).socket(socket)
        side = self.piece.atlas.side
        return self.stored(value, (side, side), is_number, unlimited, {"uv_set": "UV_SET_SECOND", "wrap": "WRAP_CLAMP"})

    def bake_size(self, socket):
        """Returns the width and the height for baking an input: the largest width and the largest height
        of the images in the nodes that lead to the input. Both are at least 256 and at most MOST_BAKED.
        If one of these nodes is a procedural texture or a group, both are at least 1,024."""
        width, height, seen, waiting = 256, 256, set(), [from_node(socket)]
        while waiting:
            output = waiting.pop()
            if output is None or output.node.as_pointer() in seen:
                continue
            seen.add(output.node.as_pointer())
            node = output.node
            if node.type == "TEX_IMAGE" and node.image is not None:
                width, height = max(width, node.image.size[0]), max(height, node.image.size[1])
            elif node.type.startswith("TEX_") or node.type == "GROUP":
                width, height = max(width, 1024), max(height, 1024)
            waiting.extend(from_node(s) for s in node.inputs)
        return min(width, MOST_BAKED), min(height, MOST_BAKED)

    # Stores baked values, rows from the bottom, as an image of `size` (width, height). Returns its
    # Value, whose `mean` is set; a single value becomes a constant. `unlimited`: values may exceed
    # 1; otherwise they are limited to [0, 1]. `fields`: further fields of ImageTexture.
    def stored(self, value, size, is_number, unlimited, fields):
        width, height = size
        value = np.nan_to_num(evaluate.number(value) if is_number else evaluate.color(value))
        value = value if unlimited else limited(value)
        if len(value) == 1:
            return Value(value[0])
        mean = value.mean(axis=0)
        picture = (value.reshape(height, width) if is_number else value.reshape(height, width, 3))[::-1]
        if is_number and value.max() <= 1:
            name, encoding = self.out.images.store("baked.png", files.png((np.clip(picture, 0, 1) * 255 + 0.5).astype(np.uint8))), "ENCODING_LINEAR"
        elif value.max() <= 1:
            name, encoding = self.out.images.store("baked.png", files.png(files.srgb_codes(picture))), "ENCODING_SRGB"
        else:
            picture = np.repeat(picture[:, :, None], 3, axis=2) if is_number else picture
            name, encoding = self.out.images.store("baked.exr", files.exr(np.maximum(picture, 0))), "ENCODING_LINEAR"
        made = Value(texture={"image": {"file": name, "encoding": encoding, **fields}})
        made.mean = mean
        return made

    # ---- normals ----

    def set_normal(self, surface, node, *names):
        """Sets the normal map of a surface from the shader's Normal input."""
        socket = input_of(node, *(names or ("Normal",)))
        output = from_node(socket) if socket is not None else None
        if output is None:
            return
        try:
            surface.normal, surface.normal_scale = self.normal_of(output)
        except (Unsupported, ValueError) as error:
            self.warn(f"{error} cannot be shown; the surface keeps its own normal")

    # Returns the normal map of a node, a Value, and its scale. Raises Unsupported.
    def normal_of(self, output):
        node = output.node
        if node.type == "NORMAL_MAP" and node.space == "TANGENT":
            strength = self.constant(input_of(node, "Strength"))
            image = self.direct_image(input_of(node, "Color"))
            if image is None or strength is None:
                image = self.baked(input_of(node, "Color"), False)
                if image.texture is None:
                    raise Unsupported("a normal map of one colour")
            return image, 1.0 if strength is None else float(strength[0])
        if node.type == "BUMP" and not self.in_group(output):
            return self.bump(node), 1.0
        raise Unsupported(f'the node "{node.name}" ({node.bl_label}) as a normal')

    def bump(self, node):
        """Returns a normal map in the atlas, a Value. It follows from the slope of the height at
        each texel. The slope is the difference between the heights half a texel to both sides."""
        height = input_of(node, "Height")
        if from_node(height) is None:
            raise Unsupported("a bump without height")
        if from_node(input_of(node, "Normal")) is not None:
            self.warn("where several bump or normal maps follow each other, only the last one is shown")
        strength = float(np.clip(self.constant(input_of(node, "Strength"))[0], 0, 1)) if self.constant(input_of(node, "Strength")) is not None else 1.0
        distance = self.constant(input_of(node, "Distance"))
        distance = 1.0 if distance is None else float(distance[0])
        distance *= -1.0 if node.invert else 1.0
        # The gradient of the height on the surface follows from the slopes along u and v, and from
        # the vectors in the world that belong to one texel (along_u, along_v). The normal n is bent
        # against the gradient.
        atlas = self.piece.make_atlas()

        def at(du, dv):
            value = evaluate.number(self.evaluator(self.piece.points(du, dv)).socket(height))
            return np.broadcast_to(value, atlas.triangle.shape)

        slope_u, slope_v = at(0.5, 0) - at(-0.5, 0), at(0, 0.5) - at(0, -0.5)  # for one texel
        corners = self.piece.triangles.positions.astype(np.float64)[self.piece.triangles.indices]
        linear = np.array(self.piece.world)[:3, :3]
        corners = corners @ linear.T
        sign = np.where(np.arange(len(corners)) % 2 == 0, 1.0, -1.0)[:, None] / (atlas.cell - 4.0)
        along_u, along_v = (corners[:, 1] - corners[:, 0]) * sign, (corners[:, 2] - corners[:, 0]) * sign  # per texel
        which = np.maximum(atlas.triangle, 0)
        pu, pv = along_u[which], along_v[which]
        n = self.piece.points().world_normal
        # Mikkelsen 2010, "Bump mapping unparametrized surfaces on the GPU".
        ru, rv = np.cross(pv, n), np.cross(n, pu)
        determinant = (pu * ru).sum(axis=1, keepdims=True)
        safe = np.where(np.abs(determinant) < 1e-30, 1e-30, determinant)
        gradient = (slope_u[:, None] * ru + slope_v[:, None] * rv) / safe
        bent = n - distance * gradient
        bent /= np.maximum(np.linalg.norm(bent, axis=1, keepdims=True), 1e-30)
        bent = strength * bent + (1 - strength) * n
        bent /= np.maximum(np.linalg.norm(bent, axis=1, keepdims=True), 1e-30)
        # Converts the bent normal to the tangent frame (x, y, n) of the atlas's uvs.
        x = pu - n * (pu * n).sum(axis=1, keepdims=True)
        x /= np.maximum(np.linalg.norm(x, axis=1, keepdims=True), 1e-30)
        y = np.cross(n, x)
        y *= np.where((y * pv).sum(axis=1, keepdims=True) < 0, -1, 1)
        local = np.stack([(bent * x).sum(axis=1), (bent * y).sum(axis=1), np.maximum((bent * n).sum(axis=1), 1e-3)], axis=1)
        local[atlas.triangle < 0] = (0, 0, 1)
        picture = (0.5 + 0.5 * local).reshape(atlas.side, atlas.side, 3)[::-1]
        name = self.out.images.store("bump.exr", files.exr(picture))
        return Value(texture={"image": {"file": name, "encoding": "ENCODING_LINEAR", "uv_set": "UV_SET_SECOND", "wrap": "WRAP_CLAMP"}})

    # ---- shaders ----

    def surface(self):
        """Returns the Surface of the material; None if the material is a volume alone."""
        if not self.blender.use_nodes or self.blender.node_tree is None:
            self.tree = None
            return self.plain_surface()
        self.tree = self.blender.node_tree
        end = output_node(self.tree)
        if end is None:
            return Surface("")
        displacement = input_of(end, "Displacement")
        if displacement is not None and from_node(displacement) is not None:
            self.warn("displacement cannot be shown")
        output = from_node(end.inputs["Surface"])
        if output is not None:
            return self.shader(output)
        return None if from_node(end.inputs["Volume"]) is not None else Surface("")  # black, as in Cycles

    def plain_surface(self):
        """Returns a diffuse Surface of the material's colour in the viewport."""
        return Surface("diffuse", texture=Value(limited(list(self.blender.diffuse_color)[:3])).message())

    # Returns the Surface of a shader node; one of type T is converted by the method shader_T(node, output). Raises Unsupported.
    def shader(self, output):
        node = output.node
        function = getattr(self, "shader_" + node.type.lower(), None)
        if function is None:
            raise Unsupported(f'the shader "{node.name}" ({node.bl_label})')
        return function(node, output)

    def linked(self, socket):
        """Returns the Surface of a shader input; black if nothing is linked."""
        try:
            output = from_node(socket)
            return Surface("") if output is None else self.shader(output)
        except Unsupported as error:
            self.warn(f"{error} cannot be shown; it is black there")
            return Surface("")

    def shader_group(self, node, output):
        ends = [] if node.node_tree is None else [n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output]
        if not ends:
            raise Unsupported(f'the group "{node.name}" without an output')
        outer, self.tree = self.tree, node.node_tree
        self.groups.append(node)
        try:
            inner = from_node(next(s for s in ends[0].inputs if s.identifier == output.identifier))
            return Surface("") if inner is None else self.shader(inner)
        finally:
            self.groups.pop()
            self.tree = outer

    def shader_bsdf_diffuse(self, node, output):
        made = Surface("diffuse", texture=self.value(input_of(node, "Color")).message())
        if not self.number(node, "Roughness").is_constant(0):
            self.warn("the roughness of a Diffuse BSDF is not shown")
        self.set_normal(made, node)
        return made

    def shader_bsdf_glossy(self, node, output):
        made = Surface("conductor", specular_texture=self.value(input_of(node, "Color")).message(), surface=self.microfacets(node))
        if not self.number(node, "Anisotropy").is_constant(0):
            self.warn("anisotropic reflection is shown isotropic")
        self.set_normal(made, node)
        return made

    shader_bsdf_anisotropic = shader_bsdf_glossy

    # Returns the message for the microfacets of a node's rough reflection.
    def microfacets(self, node):
        if getattr(node, "distribution", "GGX") == "SHARP":
            return {"alpha": 0.0}
        kind = "DISTRIBUTION_BECKMANN" if getattr(node, "distribution", "") == "BECKMANN" else "DISTRIBUTION_GGX"
        roughness = self.number(node, "Roughness", default=0.5)
        if roughness.constant is not None:
            return {"distribution": kind, "alpha": min(max(roughness.number, 0.0), 1.0) ** 2}
        return {"distribution": kind, "alpha": 1.0, "alpha_texture": roughness.times(roughness).message()}

    def shader_bsdf_glass(self, node, output):
        return self.glass(node, self.value(input_of(node, "Color")), node.distribution == "SHARP")

    def shader_bsdf_refraction(self, node, output):
        self.warn("the Refraction BSDF is shown as glass, which reflects too")
        return self.glass(node, self.value(input_of(node, "Color")), node.distribution == "SHARP")

    # Returns the Surface of glass. `tint`: the colour of the glass, a Value; `sharp`: the glass is smooth.
    def glass(self, node, tint, sharp=False):
        index = self.plain(node, "IOR", default=1.45)
        roughness = Value(0) if sharp else self.number(node, "Roughness")
        if index < 1:
            self.warn(f"the index of refraction {index:.3g} is below 1; 1 is used")
        index = min(max(index, 1.0), 5.0)
        if tint.is_constant(1) and roughness.constant is not None:
            made = Surface("dielectric", index_of_refraction=index, roughness=min(max(roughness.number, 0.0), 1.0))
        elif tint.is_constant(1):
            made = Surface("dielectric", index_of_refraction=index, roughness_texture=roughness.message())
        else:
            # A principled surface tints each passage of light by the square root of its base colour.
            # So the base colour is the square of the tint.
            made = Surface("principled", base_color_texture=tint.times(tint).message(), spec_trans={"value": 1.0},
                           roughness=parameter(roughness), index_of_refraction=max(index, 1.0001))
        self.set_normal(made, node)
        return made

    def shader_bsdf_translucent(self, node, output):
        made = Surface("diffuse_transmission", reflectance=rgb((0, 0, 0)), transmittance_texture=self.value(input_of(node, "Color")).message())
        self.set_normal(made, node)
        return made

    def shader_bsdf_transparent(self, node, output):
        tint = self.value(input_of(node, "Color"))
        made = Surface("transparent")
        if tint.is_constant(0):
            return Surface("")
        if not tint.is_constant(1):
            self.warn("a coloured Transparent BSDF is shown as a grey one of the same brightness")
            made = Surface("")
            made.opacity = Value(evaluate.number(1 - np.clip(tint.constant, 0, 1)[None])[0]) if tint.constant is not None else tint.inverse()
        return made

    def shader_subsurface_scattering(self, node, output):
        self.warn("subsurface scattering is shown as a diffuse surface")
        return Surface("diffuse", texture=self.value(input_of(node, "Color")).message())

    def shader_emission(self, node, output):
        made = Surface("")
        made.emission = self.emission(node, ("Color",), ("Strength",))
        return made

    shader_background = shader_emission

    # Returns the emission of a node, a Value; None if it is 0. `color`, `strength`: names of the inputs.
    def emission(self, node, color, strength):
        emitted = self.value(input_of(node, *color), default=1.0, unlimited=True).times(self.number(node, *strength, default=1.0, unlimited=True))
        return None if emitted.is_constant(0) else emitted

    def shader_holdout(self, node, output):
        raise Unsupported("a holdout")

    def shader_add_shader(self, node, output):
        a, b = self.linked(node.inputs[0]), self.linked(node.inputs[1])
        if a.kind == "" and a.opacity.is_constant(1):
            a, b = b, a
        if b.kind == "" and b.opacity.is_constant(1) and a.kind != "transparent":
            a.emission = b.emission if a.emission is None else a.emission if b.emission is None else added(a.emission, b.emission)
            return a
        if a.kind == "diffuse" == b.kind and a.normal is None and b.normal is None and "color" in a.fields["texture"] and "color" in b.fields["texture"]:
            both = np.array(a.fields["texture"]["color"]["rgb"]) + np.array(b.fields["texture"]["color"]["rgb"])
            a.fields["texture"] = Value(np.minimum(both, 1)).message()
            return a
        self.warn("an Add Shader of two surfaces is shown as a mixture of them")
        return self.mixture(a, b, Value(0.5))

    def shader_mix_shader(self, node, output):
        factor = self.factor(node)
        if factor.is_constant(0):
            return self.linked(node.inputs[1])
        if factor.is_constant(1):
            return self.linked(node.inputs[2])
        a, b = self.linked(node.inputs[1]), self.linked(node.inputs[2])
        fresnel = self.fresnel_index(node)
        if fresnel is not None and a.kind == "diffuse" and b.kind == "conductor" and "alpha_texture" not in b.fields["surface"]:
            coated = Surface("gltf", base_color_texture=a.fields["texture"], metallic=0.0, index_of_refraction=fresnel,
                             roughness=float(np.sqrt(b.fields["surface"].get("alpha", 0.0))))
            coated.normal, coated.normal_scale = a.normal, a.normal_scale
            return coated
        return self.mixture(a, b, factor)

    def fresnel_index(self, node):
        """Returns the index of refraction of the Fresnel node that controls a mixture, or of the
        Fresnel output of a Layer Weight node. Returns None for every other control."""
        output = from_node(node.inputs[0])
        try:
            if output is not None and output.node.type == "FRESNEL":
                return min(max(float(self.constant(input_of(output.node, "IOR"))[0]), 1.0), 5.0)
            if output is not None and output.node.type == "LAYER_WEIGHT" and output.name == "Fresnel":
                blend = float(self.constant(input_of(output.node, "Blend"))[0])
                return min(1 / max(1 - blend, 0.2), 5.0)
        except (Unsupported, TypeError):
            pass
        return None

    # Returns the Value of a Mix Shader's factor. A factor that depends on the view becomes its
    # mean.
    def factor(self, node):
        output = from_node(node.inputs[0])
        if output is not None and output.node.type in ("FRESNEL", "LAYER_WEIGHT"):
            index = self.fresnel_index(node) or 1.5
            f0 = ((index - 1) / (index + 1)) ** 2
            if output.name == "Facing" or self.kinds(node) != ("BSDF_DIFFUSE", "BSDF_GLOSSY"):
                self.warn(f'the node "{output.node.name}" depends on the view; its mean is used')
            return Value(f0 + (1 - f0) / 21 if output.name != "Facing" else 0.5)  # the cosine-weighted mean of Schlick's Fresnel
        return self.value(node.inputs[0], True)

    # Returns the types of the two shader nodes that a Mix Shader mixes; "" for an input without a
    # link.
    def kinds(self, node):
        found = []
        for socket in list(node.inputs)[1:3]:
            output = from_node(socket)
            found.append({"BSDF_ANISOTROPIC": "BSDF_GLOSSY"}.get(output.node.type, output.node.type) if output is not None else "")
        return tuple(found)

    def mixture(self, a, b, factor):
        """Returns the Surface that is `a` where `factor` is 0, and `b` where `factor` is 1."""
        if a.kind == "transparent" and b.kind == "transparent":
            return a
        if a.kind == "transparent":
            b.opacity = b.opacity.times(factor)
            return b
        if b.kind == "transparent":
            a.opacity = a.opacity.times(factor.inverse())
            return a
        if a.kind == b.kind == "" and a.opacity.is_constant(1) and b.opacity.is_constant(1):
            parts = [s.emission.times(share) for s, share in ((a, factor.inverse()), (b, factor)) if s.emission is not None]
            made = Surface("")
            made.emission = None if not parts else parts[0] if len(parts) == 1 else added(*parts)
            return made
        mixed = Surface("mix", amount=factor.message())
        mixed.parts = (a, b)
        return mixed

    def shader_bsdf_principled(self, node, output):
        metallic = self.number(node, "Metallic")
        transmission = self.number(node, "Transmission", "Transmission Weight")
        base = self.value(input_of(node, "Base Color"))
        roughness = self.number(node, "Roughness", default=0.5)
        self.name_omitted(node)
        emission = self.emission(node, ("Emission", "Emission Color"), ("Emission Strength",))
        opacity = self.number(node, "Alpha", default=1.0)
        opaque = Surface("gltf", base_color_texture=base.message(), metallic_texture=metallic.message(), roughness_texture=roughness.message(),
                         index_of_refraction=self.index(node))
        for field, value in (("metallic", metallic), ("roughness", roughness)):
            if value.constant is not None:
                del opaque.fields[field + "_texture"]
                opaque.fields[field] = min(max(value.number, 0.0), 1.0)
        if base.constant is not None:
            del opaque.fields["base_color_texture"]
            opaque.fields["base_color"] = rgb(np.minimum(base.constant * self.old_diffuse(metallic, roughness, opaque.fields["index_of_refraction"]), 1))
        self.add_coat(opaque, node)
        self.set_normal(opaque, node)
        made = opaque
        if not transmission.is_constant(0):
            glass = self.glass(node, base)
            share = transmission.times(metallic.inverse())
            made = glass if share.is_constant(1) else self.mixture(opaque, glass, share)
        made.emission = emission
        made.opacity = opacity
        return made

    def old_diffuse(self, metallic, roughness, index):
        """Returns a factor for the base colour. With it, a surface is as bright as in Blender before
        version 4. The old Principled BSDF adds its reflection to its diffuse part, but in Bandsaw
        the diffuse part gets only the light that is not reflected. The old diffuse part (Burley
        2012) also depends on the roughness. The formula is fitted to the values in
        deploy/blender/README.md."""
        if self.version >= (4, 0, 0) or metallic.constant is None or roughness.constant is None:
            return 1.0
        r, f0 = roughness.number, ((index - 1) / (index + 1)) ** 2
        factor = (0.98 + 0.06 * (r - 0.1)) / (1 - 1.1 * f0 * (1 - 0.5 * r ** 4))
        return 1 + (factor - 1) * (1 - min(max(metallic.number, 0.0), 1.0))

    def index(self, node):
        """Returns the index of refraction that reflects as much at normal incidence as Blender's
        inputs say."""
        level = input_of(node, "Specular IOR Level")
        if level is not None:
            index = self.plain(node, "IOR", default=1.5)
            f0 = ((index - 1) / (index + 1)) ** 2 * 2 * self.plain(node, "Specular IOR Level", default=0.5)
        else:
            f0 = 0.08 * self.plain(node, "Specular", default=0.5)
        root = np.sqrt(min(max(f0, 0.0), 0.44))
        return float((1 + root) / (1 - root))

    # Adds the coat of a Principled BSDF to the Surface `made`.
    def add_coat(self, made, node):
        coat = self.number(node, "Clearcoat", "Coat Weight")
        if coat.is_constant(0):
            return
        if input_of(node, "Clearcoat") is not None:
            coat = coat.times(Value(0.25))  # Disney's clear coat has a quarter of the reflection of a coat
        roughness = self.number(node, "Clearcoat Roughness", "Coat Roughness", default=0.03)
        for field, value in (("clearcoat", coat), ("clearcoat_roughness", roughness)):
            if value.constant is not None:
                made.fields[field] = min(max(value.number, 0.0), 1.0)
            else:
                made.fields[field + "_texture"] = value.message()
        tint = input_of(node, "Coat Tint")
        if tint is not None and not self.value(tint).is_constant(1):
            self.warn("the tint of a coat is not shown")

    # Warns of the features of a Principled BSDF that the node uses and that are not shown.
    def name_omitted(self, node):
        for names, what in ((("Subsurface", "Subsurface Weight"), "subsurface scattering is shown as a diffuse surface"), (("Sheen", "Sheen Weight"), "sheen is not shown"),
                            (("Anisotropic",), "anisotropic reflection is shown isotropic"), (("Thin Film Thickness",), "a thin film is not shown"),
                            (("Diffuse Roughness",), "the roughness of the diffuse part is not shown")):
            if not self.number(node, *names).is_constant(0):
                self.warn(what)
        tint = input_of(node, "Specular Tint")
        if tint is not None and not self.value(tint).is_constant(0 if tint.type == "VALUE" else 1):
            self.warn("a specular tint is not shown")


# Returns the message Parameter.
def parameter(value):
    return {"value": min(max(value.number, 0.0), 1.0)} if value.constant is not None else {"texture": value.message()}


def added(a, b):
    """Returns the sum of two emissions. Textures can be mixed but not added, so the sum is twice
    their mean."""
    if a.constant is not None and b.constant is not None:
        return Value(a.constant + b.constant)
    mean = Value(texture={"mix": {"a": a.message(), "b": b.message()}})
    return Value(texture={"product": {"a": mean.message(), "b": {"color": rgb((2, 2, 2))}}})


def output_node(tree):
    """Returns the active output node that applies to Cycles; None: there is none."""
    ends = [n for n in tree.nodes if n.type in ("OUTPUT_MATERIAL", "OUTPUT_WORLD", "OUTPUT_LIGHT") and getattr(n, "target", "ALL") in ("ALL", "CYCLES")]
    return next((n for n in ends if n.is_active_output), ends[0] if ends else None)


def message(surface, out):
    """Returns the message Material of a Surface, without a name. If the Surface is a mixture, the
    materials of its parts are added to `out`."""
    fields, emission, opacity = dict(surface.fields), surface.emission, surface.opacity
    if surface.kind == "mix":
        for part in surface.parts:  # both parts get the emission and the opacity of the mixture
            if emission is not None:
                part.emission = emission if part.emission is None else added(part.emission, emission)
            part.opacity = part.opacity.times(opacity)
        a, b = (out.material(message(part, out)) for part in surface.parts)
        return {"mix": {"a": a, "b": b, **fields}}
    if surface.kind == "" and opacity.is_constant(1) and emission is not None:
        return {"emissive": {"radiance": rgb(emission.constant)} if emission.constant is not None else {"texture": emission.message()}}
    plain = opacity.is_constant(1) and emission is None and surface.normal is None
    if surface.kind in ("", "diffuse", "transparent"):
        color = fields.get("texture", {"color": rgb((0, 0, 0))})
        if plain and surface.kind != "transparent":
            return {"diffuse": {"texture": color}}
        if surface.kind == "diffuse" and surface.normal is not None and out.version >= (4, 0, 0):
            # In Blender 4, Cycles keeps a normal that faces away from the viewer. Before Blender 4,
            # and in glTF's material, such a normal is turned towards the viewer.
            return with_properties("diffuse", {"texture": color}, surface, emission, opacity)
        # glTF's material without reflection is a diffuse surface, with fields for alpha, emission and normals.
        fields = {"base_color_texture": color, "metallic": 0.0, "roughness": 1.0, "index_of_refraction": 1.0}
        opacity = Value(0) if surface.kind == "transparent" else opacity
    if surface.kind in ("", "diffuse", "transparent", "gltf"):
        if emission is not None:
            fields["double_sided"] = True
            if emission.constant is not None:
                fields["emissive"] = rgb(emission.constant)
            else:
                fields["emissive_texture"] = emission.message()
        if not opacity.is_constant(1):
            fields["alpha_mode"] = "ALPHA_MODE_BLEND"
            if opacity.constant is not None:
                fields["alpha"] = min(max(opacity.number, 0.0), 1.0)
            else:
                fields["alpha_texture"] = opacity.message()
        if surface.normal is not None:
            fields["normal_texture"], fields["normal_scale"] = surface.normal.message(), surface.normal_scale
        return {"gltf": fields}
    return with_properties(surface.kind, fields, surface, emission, opacity)


def with_properties(kind, fields, surface, emission, opacity):
    """Returns a message Material of a kind that has no fields of its own for emission, opacity and normals."""
    made = {kind: fields}
    if emission is not None:
        if emission.constant is not None:
            made["emission"] = rgb(emission.constant)
        else:
            made["emission_texture"] = emission.message()
    if opacity.constant is None:
        made["opacity_texture"] = opacity.message()
    elif not opacity.is_constant(1):
        made["opacity"] = min(max(opacity.number, 0.0), 1.0)
    if surface.normal is not None:
        made["normal_texture"], made["normal_scale"] = surface.normal.message(), surface.normal_scale
    return made
