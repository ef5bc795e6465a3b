"""Converts Blender's lights, world and volumes to those of a scene file. Powers become radiances, intensities and irradiances. Blender's manual,
"Light Objects", and deploy/blender/README.md define the units. `out` is the scene.Scene in the making.

In add_sun(), add_point(), add_spot() and add_area(), `thing` is the light's object in Blender. The light's matrix `placed`, its position `place`
and the direction `toward`, in which the light shines, are in the axes of scene files. `tint` is the light's colour times its power."""

import math

import bpy
import numpy as np
from mathutils import Matrix, Vector

from . import evaluate, files, shading
from .evaluate import Unsupported, from_node, input_of
from .shading import rgb

# From Blender's axes (z up) to those of scene files (y up).
TO_SCENE = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))


# Returns a vector of Blender as a list of numbers.
def vector(v):
    return [float(x) for x in v]


def add_light(out, thing, matrix):
    """Adds a light object. `matrix`: its placement in Blender's axes."""
    light = thing.data
    if light.type == "AREA" and getattr(getattr(light, "cycles", light), "is_portal", False):
        return  # a portal emits nothing; Bandsaw finds openings itself
    tint = np.array(light.color) * light.energy * node_factor(out, light)
    if not tint.any():
        return
    placed = TO_SCENE @ matrix
    place, toward = vector(placed.translation), vector(-(placed.to_3x3() @ Vector((0, 0, 1))))
    {"SUN": add_sun, "POINT": add_point, "SPOT": add_spot, "AREA": add_area}[light.type](out, thing, placed, place, toward, tint)
    if not getattr(getattr(light, "cycles", light), "cast_shadow", True) or not getattr(light, "use_shadow", True):
        out.warn(f'the light "{thing.name}" casts shadows, although its setting says that it does not')


def node_factor(out, light):
    """Returns the colour by which the light's nodes multiply its power."""
    if not light.use_nodes or light.node_tree is None:
        return np.ones(3)
    end = shading.output_node(light.node_tree)
    output = from_node(end.inputs["Surface"]) if end is not None else None
    if output is None:
        return np.zeros(3)
    try:
        if output.node.type != "EMISSION":
            raise Unsupported(f'the node "{output.node.name}"')
        values = evaluator(out, f'the light "{light.name}"', evaluate.Points(1), light=True)
        return evaluate.color(values.of(output.node, "Color"))[0] * evaluate.number(values.of(output.node, "Strength"))[0]
    except Unsupported as error:
        out.warn(f'the light "{light.name}": {error} cannot be shown; the light has its plain colour')
        return np.ones(3)


def evaluator(out, where, points, light=False):
    """Returns an Evaluator. `where`: the owner of the nodes, a text for warnings. `light`: as in
    Evaluator."""
    return evaluate.Evaluator(points, out.images.pixels, lambda text: out.warn(f"{where}: {text}"), light)


def add_sun(out, thing, placed, place, toward, tint):
    angle = min(thing.data.angle, math.pi)
    if angle < math.radians(0.01):
        out.scene.setdefault("light", []).append({"directional": {"direction": toward, "irradiance": rgb(tint)}})
        return
    out.suns.append((Vector(toward).normalized(), angle, tint))


def finish_suns(out, center, radius):
    """Adds the suns that have a size, as disks far outside the scene. `center` and `radius` are
    those of a sphere around the scene."""
    for toward, angle, tint in out.suns:
        # The disk is so far away that, seen from any point of the scene, the direction to its
        # centre differs from the disk's axis by at most about 1 / 4,096 radian.
        distance = 4096 * max(radius, 1e-3)
        half = angle / 2
        radiance = tint / (math.pi * math.sin(half) ** 2)
        # True: the camera does not see the disk.
        out.lamp({"disk": {"center": vector(center - toward * distance), "normal": vector(toward), "radius": distance * math.tan(half)}}, radiance, True)


def add_point(out, thing, placed, place, toward, tint):
    radius = thing.data.shadow_soft_size
    if radius > 1e-6:
        out.lamp({"sphere": {"center": place, "radius": radius}}, tint / (4 * math.pi ** 2 * radius ** 2), not thing.visible_camera)
    else:
        out.scene.setdefault("light", []).append({"point": {"position": place, "intensity": rgb(tint / (4 * math.pi))}})


def add_spot(out, thing, placed, place, toward, tint):
    light = thing.data
    outer = light.spot_size / 2
    if outer > math.pi / 2:
        out.warn(f'the light "{thing.name}" has a cone of more than 180 degrees; 180 is shown')
        outer = math.pi / 2
    if light.shadow_soft_size > 1e-6:
        out.warn(f'the shadows of the spot light "{thing.name}" are hard; its radius is not shown')
    if getattr(light, "use_square", False):
        out.warn(f'the cone of the spot light "{thing.name}" is round, not square')
    # Blender's cone has its full intensity up to the angle `inner` from the axis.
    inner = math.acos(min(math.cos(outer) + (1 - math.cos(outer)) * light.spot_blend, 1.0))
    spot = {"position": place, "direction": toward, "intensity": rgb(tint / (4 * math.pi)), "inner_angle": math.degrees(inner),
            "outer_angle": math.degrees(outer), "falloff": "FALLOFF_SMOOTH"}
    out.scene.setdefault("light", []).append({"spot": spot})


def add_area(out, thing, placed, place, toward, tint):
    light = thing.data
    across, along = placed.to_3x3().col[0] * light.size, placed.to_3x3().col[1] * (light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size)
    round_one = light.shape in ("DISK", "ELLIPSE")
    area = across.length * along.length * (math.pi / 4 if round_one else 1)
    if area < 1e-12:
        return
    if getattr(light, "spread", math.pi) < math.pi - 1e-3:
        out.warn(f'the spread of the area light "{thing.name}" is not shown')
    # A Lambertian emitter of this power has the radiance power / (pi area). Before Blender 4.0, the radiance of an area light is power / (4 area).
    radiance = tint / (area * (math.pi if bpy.app.version >= (4, 0) else 4))
    if not round_one:
        # The normal u x v of the quad must be along the light's -z, also if the light is mirrored.
        u, v = (across, along) if across.cross(along).dot(Vector(toward)) > 0 else (along, across)
        corner = Vector(place) - across / 2 - along / 2
        out.lamp({"quad": {"corner": vector(corner), "u": vector(u), "v": vector(v)}}, radiance, not thing.visible_camera)
    elif abs(across.length - along.length) < 1e-6 * across.length:
        out.lamp({"disk": {"center": place, "normal": toward, "radius": across.length / 2}}, radiance, not thing.visible_camera)
    else:
        name = out.lamp_material(radiance, not thing.visible_camera)
        unit = {"name": f"ellipse {len(out.scene['group'])}", "shape": [{"disk": {"normal": [0, 0, -1], "radius": 1}, "material": name}]}
        out.scene["group"].append(unit)
        shape = Matrix((across / 2, along / 2, -Vector(toward))).transposed().to_4x4()
        shape.translation = Vector(place)
        out.scene["instance"].append({"of": unit["name"], "matrix": out.rows(shape)})


# ---- the world ----


# Adds the background and the fog of a world of Blender; None: the scene has no world.
def add_world(out, world):
    background = None
    try:
        background = world_background(out, world) if world is not None else {"constant": rgb((0, 0, 0))}
    except Unsupported as error:
        out.warn(f"the world: {error} cannot be shown; the background is black")
    out.scene["background"] = background or {"constant": rgb((0, 0, 0))}
    rays = getattr(world, "cycles_visibility", None)
    if rays is not None and not all(getattr(rays, kind) for kind in ("camera", "diffuse", "glossy", "transmission", "scatter")):
        out.warn("the world is seen by all rays, although its Ray Visibility says that it is not")
    if world is None or not world.use_nodes or world.node_tree is None:
        return
    end = shading.output_node(world.node_tree)
    volume = from_node(end.inputs["Volume"]) if end is not None else None
    if volume is not None:
        medium = medium_of(out, volume, "the world")
        if medium is not None:
            medium["name"] = "fog"
            out.scene["medium"].append(medium)
            out.scene["fog"] = "fog"


# Returns the message Background of a world. Raises Unsupported.
def world_background(out, world):
    if not world.use_nodes or world.node_tree is None:
        return {"constant": rgb(world.color)}
    end = shading.output_node(world.node_tree)
    output = from_node(end.inputs["Surface"]) if end is not None else None
    if output is None:
        return {"constant": rgb((0, 0, 0))}
    try:
        return {"constant": rgb(radiance_of(out, output, evaluate.Points(1))[0])}
    except evaluate.NeedsCoordinates:
        pass
    return plain_environment(out, output) or baked_environment(out, output)


def radiance_of(out, output, points, values=None):
    """Returns the radiance of the world's shader at `points`, whose generated coordinates are
    directions. `values`: the Evaluator to use; None: a new one."""
    node = output.node
    values = values or evaluator(out, "the world", points, light=True)
    if node.type in ("BACKGROUND", "EMISSION"):
        return evaluate.color(values.of(node, "Color")) * evaluate.number(values.of(node, "Strength"))[:, None]
    if node.type in ("MIX_SHADER", "ADD_SHADER"):
        sources = [from_node(socket) for socket in list(node.inputs)[-2:]]
        a, b = (np.zeros((1, 3)) if s is None else radiance_of(out, s, points, values) for s in sources)
        if node.type == "ADD_SHADER":
            return a + b
        share = np.clip(evaluate.number(values.socket(node.inputs[0])), 0, 1)[:, None]
        return a * (1 - share) + b * share
    raise Unsupported(f'the node "{node.name}" ({node.bl_label})')


def plain_environment(out, output):
    """Returns the message Background of a world that is one environment image, which may be rotated
    and multiplied by a strength. Returns None for every other world."""
    node = output.node
    if node.type not in ("BACKGROUND", "EMISSION") or from_node(input_of(node, "Strength")) is not None:
        return None
    source = from_node(input_of(node, "Color"))
    if source is None or source.node.type != "TEX_ENVIRONMENT" or source.node.image is None or source.node.projection != "EQUIRECTANGULAR":
        return None
    image, turned = source.node.image, Matrix.Identity(3)
    if image.colorspace_settings.name == "Non-Color" and not image.is_float:
        return None
    vector_from = from_node(input_of(source.node, "Vector"))
    if vector_from is not None and vector_from.node.type == "MAPPING":
        from mathutils import Euler
        mapping = vector_from.node
        if any(from_node(input_of(mapping, name)) is not None for name in ("Location", "Rotation", "Scale")):
            return None
        place, turn, scale = (tuple(input_of(mapping, name).default_value) for name in ("Location", "Rotation", "Scale"))
        if any(abs(x) > 1e-6 for x in place) or any(abs(x - 1) > 1e-6 for x in scale):
            return None
        turned = Euler(turn).to_matrix()
        if mapping.vector_type == "TEXTURE":
            turned = turned.transposed()
        vector_from = from_node(input_of(mapping, "Vector"))
        if vector_from is None:
            return None
    if vector_from is not None and not (vector_from.node.type == "TEX_COORD" and vector_from.name == "Generated"):
        return None
    swap = TO_SCENE.to_3x3()
    axis, angle = (swap @ turned.transposed() @ swap.transposed()).to_quaternion().to_axis_angle()
    made = {"file": out.images.file(image), "strength": float(input_of(node, "Strength").default_value)}
    if abs(angle) > 1e-9:
        made["rotate"] = [{"axis": vector(axis), "degrees": math.degrees(angle)}]
    return {"environment": made}


def baked_environment(out, output, width=1024):
    """Returns a message Background with an image of the world's nodes, evaluated in all directions. `width`: pixels."""
    height = width // 2
    y, x = np.divmod(np.arange(width * height), width)
    longitude = (0.5 - (x + 0.5) / width) * 2 * np.pi
    latitude = (0.5 - (y + 0.5) / height) * np.pi
    d = np.stack([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)], axis=1)
    points = evaluate.Points(len(d), generated=d, local=d, normal=d, position=d, world_normal=d)
    values = np.broadcast_to(radiance_of(out, output, points), (len(d), 3))
    picture = np.maximum(np.nan_to_num(values), 0).reshape(height, width, 3)
    return {"environment": {"file": out.images.store("world.exr", files.exr(picture))}}


# ---- media ----


def medium_of(out, output, where):
    """Returns the message Medium of a volume shader, without a name. If the volume cannot be shown,
    warns and returns None. `where`: the volume's owner, for warnings."""
    node = output.node
    values = evaluator(out, where, evaluate.Points(1))
    try:
        if node.type == "ADD_SHADER":
            parts = [medium_of(out, s, where) for s in map(from_node, node.inputs) if s is not None]
            return sum_of_media([part for part in parts if part is not None])

        def color(*names, default=(1, 1, 1)):
            socket = input_of(node, *names)
            return evaluate.color(values.socket(socket))[0] if socket is not None else np.array(default, dtype=float)

        density = float(evaluate.number(values.of(node, "Density", default=1.0))[0])
        if node.type == "VOLUME_SCATTER":
            if getattr(node, "phase", "HENYEY_GREENSTEIN") != "HENYEY_GREENSTEIN":
                out.warn(f"{where}: the phase function {node.phase} is shown as Henyey and Greenstein's")
            return {"scattering": rgb(color("Color") * density), "anisotropy": anisotropy(values, node)}
        if node.type == "VOLUME_ABSORPTION":
            return {"absorption": rgb((1 - np.clip(color("Color"), 0, 1)) * density)}
        if node.type == "EMISSION":
            return {"emission": rgb(color("Color") * evaluate.number(values.of(node, "Strength"))[0])}
        if node.type == "PRINCIPLED_VOLUME":
            scatter = np.clip(color("Color"), 0, 1)
            absorb = np.maximum(1 - scatter, 0) * np.maximum(1 - np.sqrt(np.maximum(color("Absorption Color"), 0)), 0)
            made = {"scattering": rgb(scatter * density), "absorption": rgb(absorb * density), "anisotropy": anisotropy(values, node)}
            glow = color("Emission Color") * evaluate.number(values.of(node, "Emission Strength"))[0]
            if glow.any():
                made["emission"] = rgb(glow)
            if float(evaluate.number(values.of(node, "Blackbody Intensity"))[0]) > 0:
                out.warn(f"{where}: fire (the volume's black body) is not shown")
            return made
        raise Unsupported(f'the node "{node.name}" ({node.bl_label})')
    except Unsupported as error:
        out.warn(f"{where}: {error} cannot be shown in a volume; the volume is left out")
        return None


# Returns the anisotropy of a volume node's phase function. `values`: the Evaluator of the node.
def anisotropy(values, node):
    return min(max(float(evaluate.number(values.of(node, "Anisotropy"))[0]), -0.999), 0.999)


# Returns the Medium whose coefficients are the sums of those of `parts`; the anisotropy is the mean, weighted by scattering.
def sum_of_media(parts):
    if not parts:
        return None
    made = {}
    for field in ("absorption", "scattering", "emission"):
        found = [np.array(part[field]["rgb"]) for part in parts if field in part]
        if found:
            made[field] = rgb(sum(found))
    weights = [(sum(part["scattering"]["rgb"]), part.get("anisotropy", 0.0)) for part in parts if "scattering" in part]
    total = sum(weight for weight, _ in weights)
    if total > 0:
        made["anisotropy"] = sum(weight * g for weight, g in weights) / total
    return made
