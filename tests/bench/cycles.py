"""Renders a scene of Bandsaw with Cycles, Blender's renderer. peers.sh compares the two renderers.

blender -b --python cycles.py -- SCENE.textproto WIDTH HEIGHT SAMPLES SEED OUTPUT.exr
Prints "cpu_s=…": the CPU seconds of SAMPLES - 1 samples a pixel. The program subtracts the time of
a render with one sample from the time of a render with SAMPLES samples, so that the preparation of
the scene does not count.

Supports perspective cameras with a lens, quads, boxes, spheres (as meshes, because Cycles has no
spheres), models in PLY and OBJ files that are scaled and translated, diffuse, emissive, metal and
dielectric materials of one colour, diffuse checkers in space, homogeneous media in glass, constant
and gradient backgrounds. Anything else ends the program with an error. Two materials differ:
- The fuzz of a metal becomes a Beckmann distribution with the same variance of small angles.
- Cycles does not scale radiance at a refraction. So the radiance of a lamp in glass is divided by
  the square of the index. This is done only if the lamp and the glass are spheres.
"""

import math
import os
import re
import resource
import sys

import bpy
from mathutils import Matrix, Vector


def parse(text):
    """Parses protobuf's text format. Returns the message as {field: [values]}; a nested message is such a dictionary too."""
    text = re.sub(r"#.*", "", text)
    tokens = iter(re.findall(r'"[^"]*"|[{}\[\]:,]|[^\s{}\[\]:,"]+', text) + ["}"])

    def value(token):
        if token == "{":
            return message()
        if token == "[":
            return [float(t) for t in iter(lambda: next(tokens), "]") if t != ","]
        if token.startswith('"'):
            return token[1:-1]
        try:
            return float(token)
        except ValueError:
            return token == "true" if token in ("true", "false") else token

    def message():
        fields = {}
        for name in iter(lambda: next(tokens), "}"):
            token = next(tokens)
            fields.setdefault(name, []).append(value(next(tokens) if token == ":" else token))
        return fields

    return message()


# Ends the program if the message has a field that is not `known`.
def only(message, *known):
    unknown = set(message) - set(known)
    if unknown:
        sys.exit(f"cycles.py: does not know {', '.join(sorted(unknown))}")


def colour(message):
    return (*message["rgb"][0], 1)


# Returns the output of a node that computes a checker, whose cells are boxes in space.
def make_checker(tree, fields):
    only(fields, "even", "odd", "mapping", "size")
    if fields.get("mapping") != ["MAPPING_POSITION"]:
        sys.exit("cycles.py: does not know checkers by uv")
    cells = tree.nodes.new("ShaderNodeVectorMath")
    cells.operation = "MULTIPLY_ADD"
    tree.links.new(tree.nodes.new("ShaderNodeNewGeometry").outputs["Position"], cells.inputs[0])
    (sizes,) = fields["size"]  # one for each axis, or one for all
    cells.inputs[1].default_value = [1 / size for size in (sizes if isinstance(sizes, list) else [sizes] * 3)]
    # As in Bandsaw, a plane on a border shows the cell with the larger coordinate.
    cells.inputs[2].default_value = (1e-4,) * 3
    checker = tree.nodes.new("ShaderNodeTexChecker")
    tree.links.new(cells.outputs[0], checker.inputs["Vector"])
    checker.inputs["Scale"].default_value = 1
    for name, socket in (("odd", "Color1"), ("even", "Color2")):
        (texture,) = fields[name]
        only(texture, "color")
        checker.inputs[socket].default_value = colour(texture["color"][0])
    return checker.outputs["Color"]


NODES = {"diffuse": "BsdfDiffuse", "metal": "BsdfGlossy", "dielectric": "BsdfGlass", "emissive": "Emission"}


# Returns Blender's material for a message `material`. The message has a name and one more field,
# which is the kind of the material.
def make_material(message):
    only(message, "name", *NODES)
    ((kind, (fields,)),) = ((name, value) for name, value in message.items() if name != "name")
    material = bpy.data.materials.new(message["name"][0])
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    node = tree.nodes.new("ShaderNode" + NODES[kind])
    if kind == "dielectric":
        only(fields, "index_of_refraction")
        node.inputs["IOR"].default_value = fields["index_of_refraction"][0]
        node.inputs["Roughness"].default_value = 0
    elif kind == "emissive":
        only(fields, "radiance", "one_sided")
        node.inputs["Color"].default_value = colour(fields["radiance"][0])
        if fields.get("one_sided", [False])[0]:
            back = tree.nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"]
            front = tree.nodes.new("ShaderNodeMath")
            front.operation = "SUBTRACT"
            front.inputs[0].default_value = 1
            tree.links.new(back, front.inputs[1])
            tree.links.new(front.outputs[0], node.inputs["Strength"])
    elif kind == "metal":
        only(fields, "color", "fuzz")
        node.inputs["Color"].default_value = colour(fields["color"][0])
        # A uniform point of a ball has the variance fuzz^2 / 5 along each axis. Beckmann's alpha
        # gives the reflected direction the variance 2 alpha^2. Alpha is the square of roughness.
        node.distribution = "BECKMANN"
        node.inputs["Roughness"].default_value = math.sqrt(fields.get("fuzz", [0])[0] / math.sqrt(10))
    elif "texture" in fields:
        only(fields, "texture")
        only(fields["texture"][0], "checker")
        tree.links.new(make_checker(tree, fields["texture"][0]["checker"][0]), node.inputs["Color"])
    else:
        only(fields, "color")
        node.inputs["Color"].default_value = colour(fields["color"][0])
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return material


# Returns a copy of a material, with the medium of this message behind the surface.
def filled(material, medium):
    only(medium, "name", "albedo", "density", "anisotropy")
    material = material.copy()
    tree = material.node_tree
    total = tree.nodes.new("ShaderNodeAddShader")
    for i, kind in enumerate(("Scatter", "Absorption")):  # albedo and 1 - albedo, times the density
        node = tree.nodes.new("ShaderNodeVolume" + kind)
        node.inputs["Color"].default_value = colour(medium["albedo"][0])
        node.inputs["Density"].default_value = medium.get("density", [1])[0]
        tree.links.new(node.outputs[0], total.inputs[i])
    tree.nodes["Volume Scatter"].inputs["Anisotropy"].default_value = medium.get("anisotropy", [0])[0]
    tree.links.new(total.outputs[0], tree.nodes["Material Output"].inputs["Volume"])
    return material


# Returns a copy of the material of a lamp, for a lamp in glass with this index of refraction.
def emitting_in_glass(material, index):
    material = material.copy()
    radiance = material.node_tree.nodes["Emission"].inputs["Color"]
    radiance.default_value = [value / index**2 for value in radiance.default_value]
    return material


# Returns the index of refraction of the glass around a sphere; 1 if it is not in a sphere of glass.
def index_around(sphere, scene):
    glass = {m["name"][0]: m["dielectric"][0] for m in scene["material"] if "dielectric" in m}
    index = 1
    for shape in scene["shape"]:
        if "sphere" in shape and shape["material"][0] in glass:
            (around,) = shape["sphere"]
            if math.dist(sphere["center"][0], around["center"][0]) + sphere["radius"][0] < around["radius"][0]:
                index *= glass[shape["material"][0]]["index_of_refraction"][0]
    return index


# Adds an object to the scene. The material belongs to the object, because spheres share a mesh.
def add_object(mesh, material):
    thing = bpy.data.objects.new("thing", mesh)
    bpy.context.scene.collection.objects.link(thing)
    if not mesh.materials:
        mesh.materials.append(None)
    thing.material_slots[0].link = "OBJECT"
    thing.material_slots[0].material = material
    return thing


# Returns the mesh of a sphere of radius 1 with this many segments around its axis.
def sphere_mesh(segments):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=segments, ring_count=segments // 2, radius=1)
    thing = bpy.context.object
    bpy.ops.object.shade_smooth()
    mesh = thing.data
    bpy.data.objects.remove(thing)
    return mesh


# Returns the mesh of a box. The normals of its faces point outwards.
def box_mesh(low, high):
    corners = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh = bpy.data.meshes.new("box")
    mesh.from_pydata(corners, [], faces)
    return mesh


# Returns the mesh of a model's file, in the file's coordinates and without materials.
def model_mesh(path):
    load = {".ply": bpy.ops.import_mesh.ply, ".obj": bpy.ops.wm.obj_import}
    load[os.path.splitext(path)[1]](filepath=path)
    (thing,) = bpy.context.selected_objects
    mesh = thing.data
    bpy.data.objects.remove(thing)
    mesh.materials.clear()
    return mesh


# Adds the shapes and models of the message `scene`. `materials` has Blender's material for each
# name. The files of models are relative to `folder`.
def add_shapes(scene, materials, folder):
    media = {medium["name"][0]: medium for medium in scene.get("medium", [])}
    lamps = {message["name"][0] for message in scene["material"] if "emissive" in message}
    spheres = {}
    for shape in scene.get("shape", []):
        only(shape, "quad", "box", "sphere", "material", "interior")
        if "material" not in shape:
            sys.exit("cycles.py: does not know shapes without a material")
    for shape in scene.get("shape", []):
        material = materials[shape["material"][0]]
        if "interior" in shape:
            material = filled(material, media[shape["interior"][0]])
        if "quad" in shape:
            corner, u, v = (Vector(shape["quad"][0][k][0]) for k in ("corner", "u", "v"))
            mesh = bpy.data.meshes.new("quad")
            mesh.from_pydata([corner, corner + u, corner + u + v, corner + v], [], [(0, 1, 2, 3)])
            add_object(mesh, material)
            continue
        if "box" in shape:
            add_object(box_mesh(shape["box"][0]["min"][0], shape["box"][0]["max"][0]), material)
            continue
        (sphere,) = shape["sphere"]
        if shape["material"][0] in lamps:
            material = emitting_in_glass(material, index_around(sphere, scene))
        radius = sphere["radius"][0]
        # A very large sphere is a ground, whose facets would be seen. The edges of small emissive
        # triangles must not be much longer than 1: Cycles 3.4 would sample their solid angles, which
        # it computes with errors of about 10 %.
        segments = 1024 if radius > 500 else 256 if radius > 16 else 64
        if segments not in spheres:
            spheres[segments] = sphere_mesh(segments)
        thing = add_object(spheres[segments], material)
        thing.location = sphere["center"][0]
        thing.scale = (radius,) * 3
    for model in scene.get("model", []):
        only(model, "file", "material", "scale", "translate")
        thing = add_object(model_mesh(os.path.join(folder, model["file"][0])), materials[model["material"][0]])
        thing.scale = model.get("scale", [(1, 1, 1)])[0]
        thing.location = model.get("translate", [(0, 0, 0)])[0]


def set_camera(fields):
    only(fields, "position", "look_at", "vertical_fov", "aperture", "focus_distance")
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    position, target = Vector(fields["position"][0]), Vector(fields["look_at"][0])
    back = (position - target).normalized()
    right = Vector((0, 1, 0)).cross(back).normalized()
    turned = Matrix((right, back.cross(right), back)).transposed().to_4x4()
    camera.matrix_world = Matrix.Translation(position) @ turned
    camera.data.sensor_fit = "VERTICAL"
    camera.data.angle = math.radians(fields["vertical_fov"][0])
    camera.data.clip_start, camera.data.clip_end = 1e-3, 1e5
    if "aperture" in fields:
        camera.data.dof.use_dof = True
        camera.data.dof.focus_distance = fields["focus_distance"][0]
        # The f-number is the focal length over the diameter of the lens; Blender's lens is in mm.
        camera.data.dof.aperture_fstop = camera.data.lens * 1e-3 / fields["aperture"][0]


# Makes the background: one colour, or a gradient in height from `bottom` to `top`.
def set_background(fields):
    world = bpy.context.scene.world = bpy.data.worlds.new("world")
    world.use_nodes = True
    tree = world.node_tree
    background = tree.nodes["Background"]
    only(fields, "constant", "gradient")
    if "gradient" not in fields:
        background.inputs["Color"].default_value = colour(fields["constant"][0]) if fields else (0, 0, 0, 1)
        return
    height = tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], height.inputs[0])
    share = tree.nodes.new("ShaderNodeMapRange")
    share.inputs["From Min"].default_value = -1
    tree.links.new(height.outputs["Y"], share.inputs["Value"])
    mix = tree.nodes.new("ShaderNodeMixRGB")
    mix.inputs[1].default_value = colour(fields["gradient"][0]["bottom"][0])
    mix.inputs[2].default_value = colour(fields["gradient"][0]["top"][0])
    tree.links.new(share.outputs[0], mix.inputs[0])
    tree.links.new(mix.outputs[0], background.inputs["Color"])


# Turns off everything that makes Cycles biased. Also turns off adaptive sampling, so that both
# renderers take the same number of samples in each pixel. A path has at most `depth` scatterings.
def set_quality(width, height, seed, depth):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.render.threads_mode = "AUTO"
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.seed = seed
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.light_sampling_threshold = 0
    cycles.blur_glossy = 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    for kind in ("max", "diffuse", "glossy", "transmission", "volume"):
        setattr(cycles, kind + "_bounces", depth - 1)  # Cycles does not count the last scattering


def rendered(samples):
    """Renders with this many samples a pixel and returns the CPU seconds."""
    bpy.context.scene.cycles.samples = samples
    bpy.context.scene.update_tag()
    before = resource.getrusage(resource.RUSAGE_SELF)
    bpy.ops.render.render(write_still=True)
    after = resource.getrusage(resource.RUSAGE_SELF)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def main():
    path, width, height, samples, seed, output = sys.argv[sys.argv.index("--") + 1 :]
    with open(path) as file:
        scene = parse(file.read())
    only(scene, "camera", "image", "integrator", "background", "material", "medium", "shape", "model")
    # exposure and tone do not change the EXR file
    only(scene.get("image", [{}])[0], "width", "height", "exposure", "tone")
    integrator = scene.get("integrator", [{}])[0]
    only(integrator, "max_depth")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    set_quality(int(width), int(height), int(seed), int(integrator.get("max_depth", [32])[0]))
    set_camera(scene["camera"][0])
    set_background(scene.get("background", [{}])[0])
    materials = {m["name"][0]: make_material(m) for m in scene["material"]}
    add_shapes(scene, materials, os.path.dirname(path))
    bpy.context.scene.render.filepath = os.path.abspath(output)
    rendered(1)  # not measured: the first render loads data that later renders reuse
    first = rendered(1)
    print(f"cpu_s={rendered(int(samples)) - first:.3f}")


main()
