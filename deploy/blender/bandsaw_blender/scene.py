"""Walks over Blender's evaluated scene and makes a scene of Bandsaw of it: a scene file (proto/scene.proto, as JSON) and the files that it names.

Vertices stay in the space of their mesh; the change from Blender's axes (z up) to those of scene files (y up) is part of the placements. Features
that cannot be shown are named in `warnings`. In the functions, `out` is the Scene in the making, and `thing` an object of Blender."""

import contextlib
import hashlib
import json
import math
import os
import tempfile

import bpy
import numpy as np
from mathutils import Matrix, Vector

from . import evaluate, geometry, lights, shading
from .lights import TO_SCENE, vector

GEOMETRY = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


class Scene:
    """A scene in the making. `scene`: the message Scene as a dictionary; `files`: a dictionary from
    names to bytes or paths; `warnings`: sentences; `suns`: the suns with a size, for
    lights.finish_suns; `low`, `high`: the box around the scene in Blender's axes. Large files are
    kept in a temporary folder, because Blender needs the memory. The folder is removed with the
    scene."""

    MAIN = "scene.json"  # name of the scene file
    LARGE = 16 << 20  # size in bytes from which a file is large

    def __init__(self):
        self.scene = {"texture": [], "material": [], "group": [], "instance": [], "model": [], "shape": [], "light": [], "medium": []}
        self.files, self.warnings, self.suns = {}, [], []
        self._folder = None
        self.version = bpy.app.version
        self.images = shading.Images(self.store, self.warn)
        self._materials, self._media = {}, {}
        self.low, self.high = np.full(3, np.inf), np.full(3, -np.inf)

    def warn(self, text):
        if text not in self.warnings:
            self.warnings.append(text)

    def store(self, name, data):
        """Adds a file and returns its name, which has the suffix of `name`. Equal files are stored
        once."""
        stored = hashlib.sha256(data).hexdigest()[:24] + os.path.splitext(name)[1]
        if stored not in self.files:
            self.files[stored] = data if len(data) < self.LARGE else self._written(stored, data)
        return stored

    # Writes a large file to the temporary folder and returns its path.
    def _written(self, name, data):
        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="bandsaw-scene-")
        path = os.path.join(self._folder.name, name)
        with open(path, "wb") as file:
            file.write(data)
        return path

    def material(self, message):
        """Adds a material and returns its name. Equal materials are added once."""
        key = json.dumps(message, sort_keys=True)
        if key not in self._materials:
            self._materials[key] = f"m{len(self._materials)}"
            self.scene["material"].append({"name": self._materials[key], **message})
        return self._materials[key]

    # Adds a medium and returns its name. Equal media are added once.
    def medium(self, message):
        key = json.dumps(message, sort_keys=True)
        if key not in self._media:
            self._media[key] = f"v{len(self._media)}"
            self.scene["medium"].append({"name": self._media[key], **message})
        return self._media[key]

    # Returns the name of a material that emits to the side of the normal. `hidden`: the camera does not see it.
    def lamp_material(self, radiance, hidden):
        emissive = {"radiance": shading.rgb(radiance), "one_sided": True}
        if hidden:
            emissive["hidden"] = True
        return self.material({"emissive": emissive})

    def lamp(self, shape, radiance, hidden):
        """Adds a shape that emits to the side of its normal. `hidden`: the camera does not see it."""
        self.scene["shape"].append({**shape, "material": self.lamp_material(radiance, hidden)})

    # Returns the 12 numbers of an affine map: its first three rows, as the field Model.matrix has them.
    @staticmethod
    def rows(matrix):
        return [float(matrix[row][column]) for row in range(3) for column in range(4)]

    # Returns the scene file: JSON.
    def text(self):
        return json.dumps({field: value for field, value in self.scene.items() if value not in ([], "", {})})

    def grow(self, box, matrices):
        """Extends the box around the scene by placements of a mesh. `box`: two corners of the
        mesh's box, in the space of the mesh; `matrices`: the placements, in Blender's axes."""
        low, high = box
        corners = np.array([[(low, high)[k >> a & 1][a] for a in range(3)] + [1] for k in range(8)])
        placed = np.einsum("kj,nij->nki", corners, np.array([[list(row) for row in matrix] for matrix in matrices]))[:, :, :3].reshape(-1, 3)
        self.low, self.high = np.minimum(self.low, placed.min(axis=0)), np.maximum(self.high, placed.max(axis=0))


class Shape:
    """A mesh with its materials, which all its placements share. `parts`: for each material slot a
    dictionary with fields of the message Model and two more: "box", and "in_world", which is true
    if the textures depend on the mesh's position in the world. `placements`: pairs of a matrix and,
    if the object moves, the matrices when the shutter opens and when it closes (otherwise None)."""

    def __init__(self, parts):
        self.parts, self.placements = parts, []


def build(depsgraph, scene, size, region=None, camera=None, frame_set=None):
    """Returns the Scene of an evaluated dependency graph in render mode. `size`: (width, height) of
    the whole image; `region`: (x0, y0, x1, y1) in pixels from the lower left, or None; `camera`: an
    object, or None for the scene's camera; `frame_set`: a function of (frame, subframe) that moves
    the graph in time, for motion blur."""
    out = Scene()
    moved = Moved(depsgraph, scene, frame_set)
    camera = camera or scene.camera
    if camera is None:
        raise RuntimeError("the scene has no camera")
    add_camera(out, camera.evaluated_get(depsgraph), depsgraph, scene, size, region, moved)
    shapes = {}
    for instance in depsgraph.object_instances:
        if not instance.show_self:
            continue
        thing = instance.object
        matrix = instance.matrix_world.copy()
        if thing.type == "LIGHT":
            lights.add_light(out, thing, matrix)
        elif thing.type in GEOMETRY:
            add_geometry(out, shapes, thing, matrix, moved, moved.of(instance))
        elif thing.type == "VOLUME":
            add_grid(out, thing, matrix)
        elif thing.type in ("CURVES", "HAIR"):
            out.warn(f'the hair "{thing.name}" is not shown')
        elif thing.type == "POINTCLOUD":
            out.warn(f'the point cloud "{thing.name}" is not shown')
        if any(system.settings.type == "HAIR" and system.settings.render_type == "PATH" for system in getattr(thing, "particle_systems", ())):
            out.warn(f'the hair of "{thing.name}" is not shown')
    place(out, shapes)
    lights.add_world(out, depsgraph.scene_eval.world)
    center, radius = Vector((0, 0, 0)), 1.0
    if np.isfinite(out.low).all():
        center = TO_SCENE @ Vector((out.low + out.high) / 2)
        radius = float(np.linalg.norm(out.high - out.low)) / 2
    lights.finish_suns(out, center, radius)
    if scene.render.film_transparent:
        out.warn("a transparent background is not rendered: the film is opaque")
    return out


# ---- motion ----


class Moved:
    """The placements of all objects, and the poses of meshes that may deform, at the times when the
    shutter opens (`before`, `poses_before`) and closes (`after`, `poses_after`). Without motion
    blur these dictionaries are empty, and `times` is None."""

    def __init__(self, depsgraph, scene, frame_set):
        self.times, self.before, self.after = None, {}, {}
        self.poses_before, self.poses_after = {}, {}
        if not scene.render.use_motion_blur or frame_set is None:
            return
        length = scene.render.motion_blur_shutter
        position = getattr(scene.render, "motion_blur_position", None) or getattr(getattr(scene, "cycles", None), "motion_blur_position", "CENTER")
        start = {"START": 0.0, "CENTER": -length / 2, "END": -length}[position]
        frame = scene.frame_current + scene.frame_subframe
        self.times = (0.0, 1.0)
        for found, poses, time in ((self.before, self.poses_before, frame + start), (self.after, self.poses_after, frame + start + length)):
            frame_set(math.floor(time), time - math.floor(time))
            for instance in depsgraph.object_instances:
                found[self.key(instance)] = instance.matrix_world.copy()
                self._add_pose(instance, poses)
            camera = scene.camera.evaluated_get(depsgraph)
            found["camera"] = camera.matrix_world.copy()
        frame_set(math.floor(frame), frame - math.floor(frame))

    # Returns a key that is the same for an instance at every time.
    @staticmethod
    def key(instance):
        parent = instance.parent.name_full if instance.parent is not None else ""
        return instance.object.name_full, parent, tuple(instance.persistent_id)

    # Adds the pose of an instance's mesh to `poses`, a dictionary from the names of objects to pairs of
    # the address of the mesh and its Pose. Does nothing for a mesh that cannot deform.
    @staticmethod
    def _add_pose(instance, poses):
        thing = instance.object
        if not instance.show_self or not may_deform(thing):
            return
        data = thing.data.as_pointer()
        if thing.name_full in poses:
            # If an object has geometry nodes, other meshes may be placed under the object's name.
            # Then this name has no pose.
            if poses[thing.name_full][0] != data:
                poses[thing.name_full] = data, None
            return
        with mesh_of(thing) as mesh:
            poses[thing.name_full] = data, geometry.Pose(mesh) if mesh is not None else None

    def ends_of(self, out, thing, mesh):
        """Returns the Poses of a mesh when the shutter opens and when it closes; None if the mesh
        does not deform, or if its deformation cannot be blurred."""
        if self.times is None or not may_deform(thing):
            return None
        first, last = (poses.get(thing.name_full, (None, None))[1] for poses in (self.poses_before, self.poses_after))
        if first is None or last is None or first.equals(last):
            return None
        now = geometry.Pose(mesh)
        if not now.fits(first) or not now.fits(last):
            out.warn(f'the motion of "{thing.name}", whose number of vertices changes, is not blurred')
            return None
        return first, last

    def of(self, instance):
        """Returns the two placements of an instance that moves; None if it does not move."""
        if self.times is None or not blurred(instance.object, "use_motion_blur"):
            return None
        key = self.key(instance)
        first, last = self.before.get(key), self.after.get(key)
        if first is None or last is None or max(abs(a - b) for x, y in zip(first, last) for a, b in zip(x, y)) < 1e-7:
            return None
        return first, last


def blurred(thing, setting):
    """Returns true unless the object's settings for Cycles say that its motion is not blurred."""
    return getattr(getattr(thing.original, "cycles", None), setting, True)


def may_deform(thing):
    """Returns true if an object has something that can move its vertices."""
    if thing.type not in GEOMETRY or not blurred(thing, "use_motion_blur") or not blurred(thing, "use_deform_motion"):
        return False
    data = thing.original.data
    return (len(thing.modifiers) > 0 or thing.original.parent_type in ("ARMATURE", "LATTICE") or
            getattr(data, "shape_keys", None) is not None or getattr(data, "animation_data", None) is not None)


@contextlib.contextmanager
def mesh_of(thing):
    """Yields the mesh of an evaluated object; None: it has none."""
    if thing.type == "MESH":
        yield thing.data
        return
    try:
        yield thing.to_mesh()
    finally:
        thing.to_mesh_clear()


def key_of(time, matrix, previous=None):
    """Returns the message Key of a placement at a time, in the axes of scene files, and the
    placement's rotation, a quaternion. `previous`: the rotation of the key before, or None. The
    quaternion is negated if this makes the rotation between both keys take the shorter way."""
    location, rotation, scale = (TO_SCENE @ matrix).decompose()
    if previous is not None and rotation.dot(previous) < 0:
        rotation.negate()
    axis, angle = rotation.to_axis_angle()
    made = {"time": time, "translate": vector(location), "scale": vector(scale)}
    if abs(angle) > 1e-9:
        made["rotate"] = [{"axis": vector(axis), "degrees": math.degrees(angle)}]
    return made, rotation


# Returns true if a placement is not a product of a scale, a rotation and a translation, as a Key
# must be.
def sheared(matrix):
    location, rotation, scale = matrix.decompose()
    again = Matrix.LocRotScale(location, rotation, scale)
    largest = max(abs(x) for row in matrix for x in row)
    return max(abs(a - b) for x, y in zip(matrix, again) for a, b in zip(x, y)) > 1e-4 * largest


# ---- the camera ----


def view(matrix_world):
    """Returns the fields of a message Camera that give its position and orientation."""
    matrix = TO_SCENE @ matrix_world.normalized()
    turned = matrix.to_3x3()
    place, ahead, up = matrix.translation, -turned.col[2], turned.col[1]
    return {"position": vector(place), "look_at": vector(place + ahead), "up": vector(up)}


# Adds the messages Camera and Image. The image has the size of `region`. If the camera moves, its
# position and orientation get keys at both ends of the shutter. `size`, `region`: as in build().
def add_camera(out, camera, depsgraph, scene, size, region, moved):
    data = camera.data
    width, height = size
    if data.type == "PANO":
        out.warn("a panoramic camera is not rendered; it is shown as a perspective one")
    render = scene.render
    projection = camera.calc_matrix_camera(depsgraph, x=width, y=height, scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y)
    x0, y0, x1, y1 = region or (0, 0, width, height)
    corners = [2 * x0 / width - 1, 2 * x1 / width - 1, 2 * y0 / height - 1, 2 * y1 / height - 1]
    flat = data.type == "ORTHO"
    message = view(camera.matrix_world)
    # The edges of the image, in the camera's axes. For a perspective camera they are measured at distance 1. Column `offset` of the projection
    # matrix has the shift of the lens.
    axes = (0, 0, 1, 1)  # the axis, x or y, of each edge
    offset = 3 if flat else 2
    sign = -1 if flat else 1
    message["window"] = [(corner + sign * projection[axis][offset]) / projection[axis][axis] for corner, axis in zip(corners, axes)]
    # The unit of `window` is half of the height of the view that `orthographic` or `vertical_fov` describes. For a perspective camera, the height is
    # measured at distance 1. With a height of 2, or an angle of 90 degrees, the unit is 1.
    if flat:
        message["orthographic"] = {"height": 2.0}
    else:
        message["vertical_fov"] = 90.0
    if data.clip_start > 0.1 + 1e-6:  # Blender's default
        out.warn("objects that are nearer to the camera than its Clip Start are shown")
    if data.dof.use_dof and flat:
        out.warn("the depth of field of an orthographic camera is not shown")
    elif data.dof.use_dof:
        message["aperture"] = 1e-3 * data.lens / max(data.dof.aperture_fstop, 1e-5)
        focus = data.dof.focus_distance
        if data.dof.focus_object is not None:
            focused = data.dof.focus_object.evaluated_get(depsgraph).matrix_world.translation
            focus = abs((camera.matrix_world.normalized().inverted() @ focused).z)
        message["focus_distance"] = max(focus, 1e-5)
        if data.dof.aperture_blades >= 3 or abs(data.dof.aperture_ratio - 1) > 1e-3:
            out.warn("the lens is round; the blades and the ratio of the aperture are not shown")
    if moved.times is not None:
        message["shutter_open"], message["shutter_close"] = moved.times
        a, b = moved.before["camera"], moved.after["camera"]
        if max(abs(p - q) for x, y in zip(a, b) for p, q in zip(x, y)) > 1e-6:
            out.scene["track"] = [{"field": f"camera.{field}", "key": [{"time": time, "value": view(at)[field]} for time, at in zip(moved.times, (a, b))]}
                                  for field in ("position", "look_at", "up")]
    out.scene["camera"] = message
    out.scene["image"] = {"width": x1 - x0, "height": y1 - y0, "filter": {"gaussian": {"radius": 1.5}}}


# ---- geometry ----


# Settings of objects that Bandsaw does not have. For each: its name, the value that has an effect
# in Blender, and the text of the warning if the setting has this value.
IGNORED = (("visible_camera", False, "is seen by the camera, although its setting says that it is not"),
           ("visible_diffuse", False, "is seen by diffuse rays, although its setting says that it is not"),
           ("visible_glossy", False, "is seen by glossy rays, although its setting says that it is not"),
           ("visible_transmission", False, "is seen by transmitted rays, although its setting says that it is not"),
           ("visible_volume_scatter", False, "is seen by rays that volumes scatter, although its setting says that it is not"),
           ("visible_shadow", False, "casts shadows, although its setting says that it does not"),
           ("is_shadow_catcher", True, "is shown itself, although it is a shadow catcher"),
           ("is_holdout", True, "is shown, although it is a holdout"))


# Warns of the settings of an object that have an effect in Blender and none in Bandsaw.
def name_ignored(out, thing):
    for setting, effective, what in IGNORED:
        if getattr(thing, setting) == effective:
            out.warn(f'"{thing.name}" {what}')


# Returns the materials of the object's slots, or those of the mesh if the object has no slots.
def materials_of(thing, mesh):
    slots = [slot.material for slot in thing.material_slots]
    return slots or [material for material in mesh.materials]


# Adds a placement of an object's mesh to `shapes`, a dictionary of Shapes. Converts the mesh if it
# has no Shape yet. `motion`: the placements at both ends of the shutter, or None.
def add_geometry(out, shapes, thing, matrix, moved, motion):
    data = thing.data
    key = (data.as_pointer() if thing.type == "MESH" else (thing.name_full, data.as_pointer()),
           tuple(slot.material.name_full if slot.material else "" for slot in thing.material_slots))
    shape = shapes.get(key)
    if shape is None:
        with mesh_of(thing) as mesh:
            shape = shapes[key] = Shape(parts_of(out, thing, mesh, matrix, moved.ends_of(out, thing, mesh)) if mesh is not None else [])
    name_ignored(out, thing)
    if motion is not None and (sheared(motion[0]) or sheared(motion[1])):
        out.warn(f'the motion of "{thing.name}", which is sheared, is not blurred')
        motion = None
    if shape.placements and any(part["in_world"] for part in shape.parts):
        out.warn(f'textures of the mesh "{data.name}" depend on where it is; '
                 'all objects that share the mesh have the textures of the first one')
    shape.placements.append((matrix, motion))


# Returns Shape.parts of a mesh, and stores its files. `ends`: the Poses at both ends of the shutter, or None.
def parts_of(out, thing, mesh, matrix, ends):
    materials = materials_of(thing, mesh)
    names = [""] + [name for name in uv_names(materials) if name]
    parts = []
    pieces = geometry.triangles_of(mesh, names, ends)
    # The names of the uv maps in Triangles.uvs, in the same order.
    real = [layer.name for layer in geometry.uv_layers(mesh, names)]
    size = np.array(mesh.texspace_size, dtype=float) * 2
    low = np.array(mesh.texspace_location, dtype=float) - size / 2
    size = np.where(size == 0, 1, size)
    for slot, triangles in sorted(pieces.items()):
        material = materials[min(slot, len(materials) - 1)] if materials else None
        piece = shading.Piece(triangles, low, size, matrix, real)
        part = material_part(out, material, piece, thing)
        if part is not None:
            part["box"] = triangles.box()
            part["in_world"] = not piece.used.isdisjoint(("position", "world_normal"))
            part["file"] = out.store("mesh.glb", geometry.glb(piece.finished()))
            if ends is not None:
                part["animation"] = geometry.DEFORMS
            parts.append(part)
    return parts


# Returns the names of the uv maps that the materials contain.
def uv_names(materials):
    found = []
    for material in materials:
        if material is not None and material.use_nodes and material.node_tree is not None:
            waiting = [material.node_tree]
            while waiting:
                for node in waiting.pop().nodes:
                    if node.type in ("UVMAP", "NORMAL_MAP") and node.uv_map and node.uv_map not in found:
                        found.append(node.uv_map)
                    if node.type == "GROUP" and node.node_tree is not None:
                        waiting.append(node.node_tree)
    return found


def material_part(out, material, piece, thing):
    """Returns fields of the message Model for a piece of geometry; None if nothing of the piece is
    visible."""
    if material is None:
        return {"material": out.material({"diffuse": {"color": shading.rgb((0.8, 0.8, 0.8))}})}
    medium = interior_of(out, material, thing)
    shader = shading.Shader(out, material, piece)
    try:
        surface = shader.surface()
    except evaluate.Unsupported as error:
        shader.warn(f"{error} cannot be shown; the surface is grey")
        surface = shader.plain_surface()
    except ValueError as error:
        shader.warn(f"its textures cannot be baked ({error}); the surface is grey")
        surface = shader.plain_surface()
    if surface is None and medium is None:
        return None
    part = {}
    if surface is not None:
        part["material"] = out.material(shading.message(surface, out))
    if medium is not None:
        part["interior"] = out.medium(medium)
        if surface is None:
            part["boundary_only"] = True
    return part


# Returns the message Medium of a material's volume, without a name. Returns None if the material has
# no volume, or if the volume cannot be shown.
def interior_of(out, material, thing):
    if not material.use_nodes or material.node_tree is None:
        return None
    end = shading.output_node(material.node_tree)
    volume = evaluate.from_node(end.inputs["Volume"]) if end is not None else None
    return lights.medium_of(out, volume, f'the volume of "{thing.name}"') if volume is not None else None


def add_grid(out, thing, matrix):
    """Adds an OpenVDB object: its box, filled with the grid's medium."""
    path = bpy.path.abspath(thing.data.filepath) if thing.data.filepath else ""
    if thing.data.is_sequence:
        path = thing.data.grids.frame_filepath if hasattr(thing.data.grids, "frame_filepath") else path
    if not path or not os.path.isfile(path):
        out.warn(f'the volume "{thing.name}" has no file ({path or "made by modifiers"}) and is not shown')
        return
    material = next((slot.material for slot in thing.material_slots if slot.material is not None), None)
    medium = {"scattering": shading.rgb((0.5, 0.5, 0.5))}
    if material is not None and material.use_nodes:
        end = shading.output_node(material.node_tree)
        volume = evaluate.from_node(end.inputs["Volume"]) if end is not None else None
        if volume is None:
            return
        medium = lights.medium_of(out, volume, f'the volume "{thing.name}"')
        if medium is None:
            return
    with open(path, "rb") as file:
        name = out.store("grid.vdb", file.read())
    medium["density_grid"] = {"file": name, "grid": "density"}
    corners = np.array([tuple(corner) for corner in thing.bound_box])
    low, high = corners.min(axis=0), corners.max(axis=0)
    if not (high > low).all():
        out.warn(f'the volume "{thing.name}" is empty')
        return
    box = geometry.box(low, high)
    out.grow((low, high), [matrix])
    out.scene["model"].append({"file": out.store("mesh.glb", geometry.glb(box)), "matrix": out.rows(TO_SCENE @ matrix),
                               "interior": out.medium(medium), "boundary_only": True})


def place(out, shapes):
    """Writes the placements of all Shapes. A mesh with one placement becomes models; a mesh with
    several placements becomes a group and its instances."""
    for shape in shapes.values():
        models = [{field: value for field, value in part.items() if field not in ("box", "in_world")} for part in shape.parts]
        if not models:
            continue
        for part in shape.parts:
            out.grow(part["box"], [matrix for matrix, _ in shape.placements])
        if len(shape.placements) == 1:
            for model in models:
                out.scene["model"].append({**model, **placed(out, *shape.placements[0])})
            continue
        name = f"g{len(out.scene['group'])}"
        out.scene["group"].append({"name": name, "model": models})
        for placement in shape.placements:
            out.scene["instance"].append({"of": name, **placed(out, *placement)})


# Returns the field of Model or Instance for a placement: a matrix, or keys at both ends of the
# shutter.
def placed(out, matrix, motion):
    if motion is None:
        return {"matrix": out.rows(TO_SCENE @ matrix)}
    first, rotation = key_of(0.0, motion[0])
    last, _ = key_of(1.0, motion[1], rotation)
    return {"key": [first, last]}
