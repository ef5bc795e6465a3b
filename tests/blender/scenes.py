"""The scenes of the comparison with Cycles, one for each feature of the add-on. Each function builds its scene into an empty file."""

import math

import bpy
import numpy as np
from mathutils import Vector

SCENES = {}


# Decorator that registers a function that builds a scene. Cycles and the add-on render the scene,
# and judge.sh limits the difference of the two images.
def scene(function):
    SCENES[function.__name__] = function
    return function


# Replaces everything in Blender by the scene of this name.
def build(name):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    made = bpy.context.scene
    made.render.resolution_x, made.render.resolution_y, made.render.resolution_percentage = 96, 64, 100
    made.view_settings.view_transform = "Standard"
    camera((0, -7, 2.5), (0, 0, 0.6))
    (SCENES.get(name) or OTHERS[name])()


# ---- parts ----


def link(thing):
    bpy.context.scene.collection.objects.link(thing)
    return thing


def camera(place, target, lens=40):
    thing = link(bpy.data.objects.new("camera", bpy.data.cameras.new("camera")))
    thing.location = place
    thing.rotation_euler = (Vector(target) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    thing.data.lens = lens
    bpy.context.scene.camera = thing
    return thing


def material(name, build_nodes=None, **inputs):
    """Returns a material with a Principled BSDF that has these inputs. `build_nodes`, a function of (node tree, that BSDF), may add or replace nodes."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    for key, value in inputs.items():
        socket(shader, key).default_value = value
    if build_nodes is not None:
        build_nodes(made.node_tree, shader)
    return made


# Inputs of the Principled BSDF that Blender 4 has renamed.
NEW_NAMES = {"Specular": "Specular IOR Level", "Transmission": "Transmission Weight", "Emission": "Emission Color", "Clearcoat": "Coat Weight",
             "Clearcoat Roughness": "Coat Roughness"}


def socket(node, key):
    """Returns an input of a node. `key`: its name in Blender 3; underscores stand for spaces."""
    key = key.replace("_", " ")
    return node.inputs[key] if key in node.inputs else node.inputs[NEW_NAMES[key]]


def only(kind, **inputs):
    """A material of one shader node."""
    made = bpy.data.materials.new(kind)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    node = tree.nodes.new("ShaderNode" + kind)
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = value
    tree.links.new(node.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return made


def diffuse(*rgb):
    return only("BsdfDiffuse", Color=(*rgb, 1))


def ball(place, made, radius=1.0, name="ball"):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=radius, location=place)
    thing = bpy.context.view_layer.objects.active
    thing.name = name
    bpy.ops.object.shade_smooth()
    thing.data.materials.append(made)
    return thing


def plane(size, made, place=(0, 0, 0), turn=(0, 0, 0)):
    bpy.ops.mesh.primitive_plane_add(size=size, location=place, rotation=turn)
    bpy.context.view_layer.objects.active.data.materials.append(made)
    return bpy.context.view_layer.objects.active


def cube(place, size, made):
    bpy.ops.mesh.primitive_cube_add(size=size, location=place)
    bpy.context.view_layer.objects.active.data.materials.append(made)
    return bpy.context.view_layer.objects.active


def light(kind, place, energy, target=(0, 0, 0), **fields):
    """Adds a light at `place` that shines towards `target`. `fields`: further properties of Blender's light."""
    thing = link(bpy.data.objects.new(kind.lower(), bpy.data.lights.new(kind.lower(), kind)))
    thing.location = place
    thing.rotation_euler = (Vector(target) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    thing.data.energy = energy
    thing.visible_camera = False  # as Blender's own command "Add Light" sets it
    for key, value in fields.items():
        setattr(thing.data, key, value)
    return thing


def world(*rgb, strength=1.0):
    made = bpy.context.scene.world = bpy.data.worlds.new("world")
    made.use_nodes = True
    background = made.node_tree.nodes["Background"]
    background.inputs[0].default_value = (*rgb, 1)
    background.inputs[1].default_value = strength
    return made.node_tree, background


def picture(name, pixels, color=True, is_float=False):
    """Returns an image that is stored in the file. `pixels`: (height, width, 3), linear if it is a float image, rows from the bottom."""
    height, width = pixels.shape[:2]
    made = bpy.data.images.new(name, width, height, float_buffer=is_float)
    if not color:
        made.colorspace_settings.name = "Non-Color"
    made.pixels.foreach_set(np.concatenate([pixels, np.ones((height, width, 1))], axis=2).astype(np.float32).reshape(-1))
    made.pack()
    return made


def stripes():
    """Returns the pixels of a picture of four stripes, for picture()."""
    y, x = np.mgrid[0:64, 0:64] / 64
    return np.stack([0.2 + 0.6 * (np.floor(x * 4) % 2), 0.3 + 0.4 * y, 0.7 - 0.5 * x], axis=2)


# ---- scenes ----


@scene
def principled():
    world(0.8, 0.9, 1)
    plane(20, material("floor", Base_Color=(0.6, 0.55, 0.5, 1), Roughness=0.6, Specular=0.5))
    ball((-2.2, 0, 1), material("clay", Base_Color=(0.8, 0.3, 0.2, 1), Roughness=0.4))
    ball((0, 0, 1), material("gold", Base_Color=(0.9, 0.7, 0.3, 1), Metallic=1.0, Roughness=0.3))
    ball((2.2, 0, 1), material("lacquer", Base_Color=(0.1, 0.2, 0.5, 1), Roughness=0.8, Clearcoat=1.0))


@scene
def textures():
    world(1, 1, 1)

    def image_nodes(tree, shader):
        node, mapping, uv = (tree.nodes.new("ShaderNode" + kind) for kind in ("TexImage", "Mapping", "TexCoord"))
        node.image = picture("stripes", stripes())
        mapping.inputs["Scale"].default_value = (2, 2, 1)
        mapping.inputs["Rotation"].default_value = (0, 0, 0.5)
        tree.links.new(uv.outputs["UV"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs[0], node.inputs["Vector"])
        flat(tree, node.outputs["Color"])

    def noise_nodes(tree, shader):
        noise, ramp = tree.nodes.new("ShaderNodeTexNoise"), tree.nodes.new("ShaderNodeValToRGB")
        noise.inputs["Scale"].default_value = 4
        noise.inputs["Detail"].default_value = 3
        ramp.color_ramp.elements[0].position, ramp.color_ramp.elements[1].position = 0.35, 0.65
        ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.1, 0.2, 0.6, 1), (0.9, 0.6, 0.2, 1)
        tree.links.new(noise.outputs["Fac"], ramp.inputs["Fac"])
        flat(tree, ramp.outputs["Color"])

    def checker_nodes(tree, shader):
        checker = tree.nodes.new("ShaderNodeTexChecker")
        checker.inputs["Scale"].default_value = 6
        mix = tree.nodes.new("ShaderNodeMixRGB")
        mix.blend_type = "MULTIPLY"
        mix.inputs[0].default_value = 1
        mix.inputs[2].default_value = (0.9, 0.4, 0.3, 1)
        tree.links.new(checker.outputs["Color"], mix.inputs[1])
        flat(tree, mix.outputs[0])

    plane(20, material("image", image_nodes))
    ball((-1.3, 0, 1), material("noise", noise_nodes))
    ball((1.3, 0, 1), material("checker", checker_nodes))


def flat(tree, output):
    """Makes the surface a Diffuse BSDF whose colour is this output of a node."""
    node = tree.nodes.new("ShaderNodeBsdfDiffuse")
    tree.links.new(output, node.inputs["Color"])
    tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    return node


@scene
def normals():
    world(0.2, 0.2, 0.2)
    light("SUN", (0, 0, 5), 2, target=(2, 2, 0), angle=0)
    y, x = np.mgrid[0:64, 0:64] / 64 * 2 * math.pi * 4
    slope = np.stack([0.5 + 0.25 * np.cos(x), 0.5 + 0.25 * np.cos(y), np.full_like(x, 0.95)], axis=2)

    def mapped(tree, shader):
        image, normal = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeNormalMap")
        image.image = picture("slopes", slope, color=False)
        tree.links.new(image.outputs["Color"], normal.inputs["Color"])
        node = tree.nodes.new("ShaderNodeBsdfDiffuse")
        tree.links.new(normal.outputs[0], node.inputs["Normal"])
        tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])

    def bumped(tree, shader):
        noise, bump = tree.nodes.new("ShaderNodeTexNoise"), tree.nodes.new("ShaderNodeBump")
        noise.inputs["Scale"].default_value = 5
        bump.inputs["Distance"].default_value = 0.2
        tree.links.new(noise.outputs["Fac"], bump.inputs["Height"])
        node = tree.nodes.new("ShaderNodeBsdfDiffuse")
        tree.links.new(bump.outputs[0], node.inputs["Normal"])
        tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])

    plane(20, material("mapped", mapped))
    ball((-1.2, 0, 1), material("bumped", bumped))
    ball((1.2, 0, 1), diffuse(0.8, 0.8, 0.8))


@scene
def emission():
    world(0, 0, 0)
    plane(20, diffuse(0.7, 0.7, 0.7))
    ball((-1.5, 0, 1), only("Emission", Color=(1, 0.6, 0.3, 1), Strength=3), 0.6)
    ball((1.5, 0, 1), material("glow", Base_Color=(0.2, 0.2, 0.2, 1), Specular=0.0, Roughness=1.0, Emission=(0.2, 0.5, 1, 1), Emission_Strength=2), 0.8)


@scene
def glass():
    world(0.9, 1, 1.1)
    plane(20, diffuse(0.5, 0.6, 0.5))
    ball((-1.3, 0, 1), only("BsdfGlass", Color=(1, 1, 1, 1), Roughness=0.0, IOR=1.5))
    ball((1.3, 0, 1), only("BsdfGlass", Color=(1, 1, 1, 1), Roughness=0.2, IOR=1.45))


@scene
def mixed():
    world(1, 1, 1)
    plane(20, diffuse(0.6, 0.5, 0.4))

    def mixture(first, second, factor):
        """Returns a function for material(): a mix of two BSDFs. `factor`: the share of the second."""
        def nodes(tree, shader):
            mix = tree.nodes.new("ShaderNodeMixShader")
            mix.inputs[0].default_value = factor
            for number, (kind, rgb) in enumerate((first, second)):
                node = tree.nodes.new("ShaderNode" + kind)
                node.inputs["Color"].default_value = (*rgb, 1)
                if kind == "BsdfGlossy" or kind == "BsdfAnisotropic":
                    node.inputs["Roughness"].default_value = 0.2
                tree.links.new(node.outputs[0], mix.inputs[1 + number])
            tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        return nodes

    glossy = "BsdfGlossy" if hasattr(bpy.types, "ShaderNodeBsdfGlossy") else "BsdfAnisotropic"
    ball((-2.2, 0, 1), material("a", mixture(("BsdfTransparent", (1, 1, 1)), ("BsdfDiffuse", (0.8, 0.2, 0.2)), 0.6)))
    ball((0, 0, 1), material("b", mixture(("BsdfDiffuse", (0.2, 0.5, 0.8)), (glossy, (0.9, 0.9, 0.9)), 0.3)))
    ball((2.2, 0, 1), material("c", mixture(("BsdfTranslucent", (0.7, 0.7, 0.2)), ("BsdfDiffuse", (0.2, 0.7, 0.3)), 0.5)))


@scene
def instances():
    world(0.9, 0.9, 1)
    plane(20, diffuse(0.5, 0.5, 0.5))
    collection = bpy.data.collections.new("things")
    one = ball((0, 0, 0), diffuse(0.8, 0.3, 0.2), 0.3)
    bpy.context.scene.collection.objects.unlink(one)
    collection.objects.link(one)
    for k in range(4):
        empty = link(bpy.data.objects.new(f"empty {k}", None))
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        empty.location = (-2 + k * 1.2, 0.5, 0.4 + 0.2 * k)
        empty.scale = (1 + 0.2 * k, 1, 1)
    thing = cube((-2, -1.5, 0.4), 0.6, diffuse(0.2, 0.6, 0.3))
    thing.modifiers.new("array", "ARRAY").count = 3
    thing.modifiers.new("round", "SUBSURF").render_levels = 2
    bed = plane(1.5, diffuse(0.3, 0.3, 0.8), (2, -1, 0.5))
    tree = bpy.data.node_groups.new("scatter", "GeometryNodeTree")
    if hasattr(tree, "interface"):
        tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
        tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    else:
        tree.inputs.new("NodeSocketGeometry", "Geometry")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    spread, source = tree.nodes.new("GeometryNodeInstanceOnPoints"), tree.nodes.new("GeometryNodeObjectInfo")
    small = cube((0, 0, -50), 0.5, diffuse(0.9, 0.7, 0.1))
    source.inputs["Object"].default_value = small
    tree.links.new(start.outputs[0], spread.inputs["Points"])
    tree.links.new(source.outputs["Geometry"], spread.inputs["Instance"])
    tree.links.new(spread.outputs[0], end.inputs[0])
    bed.modifiers.new("scatter", "NODES").node_group = tree


@scene
def lights():
    world(0, 0, 0)
    plane(20, diffuse(0.7, 0.7, 0.7))
    ball((0, 0, 0.7), diffuse(0.6, 0.4, 0.3), 0.7)
    light("POINT", (-2.5, 0, 1.5), 40, shadow_soft_size=0.1)
    light("SPOT", (2.5, 0, 2.5), 150, target=(2.5, 0, 0), spot_size=math.radians(60), spot_blend=0.3, shadow_soft_size=0.0)
    light("AREA", (0, 2, 3), 60, target=(0, 0, 0.5), shape="RECTANGLE", size=1, size_y=0.5)
    light("AREA", (-3, -2, 2), 20, target=(-2, 0, 0), shape="DISK", size=0.8)
    light("SUN", (0, 0, 5), 0.3, target=(1, 2, 0), angle=math.radians(5))
    # A light that Cycles uses as a portal emits nothing, whatever its power is.
    light("AREA", (3, -3, 3), 500, size=2).data.cycles.is_portal = True


@scene
def sky():
    tree, background = world(1, 1, 1)
    y, x = np.mgrid[0:64, 0:128]
    pixels = np.stack([0.2 + x / 128, 0.2 + y / 64, 1.2 - x / 128], axis=2)
    pixels[40:44, 20:26] = 40
    node, mapping, coordinates = (tree.nodes.new("ShaderNode" + kind) for kind in ("TexEnvironment", "Mapping", "TexCoord"))
    node.image = picture("sky", pixels, is_float=True)
    mapping.inputs["Rotation"].default_value = (0, 0, 1.0)
    tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], node.inputs["Vector"])
    tree.links.new(node.outputs[0], background.inputs["Color"])
    background.inputs["Strength"].default_value = 0.8
    plane(20, diffuse(0.6, 0.6, 0.6))
    ball((0, 0, 1), diffuse(0.7, 0.7, 0.7))


@scene
def gradient():
    tree, background = world(1, 1, 1)
    split, coordinates, ramp = (tree.nodes.new("ShaderNode" + kind) for kind in ("SeparateXYZ", "TexCoord", "ValToRGB"))
    scale = tree.nodes.new("ShaderNodeMapRange")
    scale.inputs["From Min"].default_value = -1
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.1, 0.1, 0.2, 1), (0.4, 0.7, 1, 1)
    tree.links.new(coordinates.outputs["Generated"], split.inputs[0])
    tree.links.new(split.outputs["Z"], scale.inputs["Value"])
    tree.links.new(scale.outputs[0], ramp.inputs["Fac"])
    tree.links.new(ramp.outputs["Color"], background.inputs["Color"])
    ball((0, 0, 1), diffuse(0.7, 0.7, 0.7))
    plane(3, diffuse(0.8, 0.6, 0.4))


@scene
def lens():
    world(1, 1, 1)
    plane(20, diffuse(0.5, 0.5, 0.5))
    for k in range(4):
        ball((-1.5 + k, -2 + 1.5 * k, 0.5), diffuse(0.9, 0.2 * k, 0.3), 0.5)
    thing = bpy.context.scene.camera
    thing.data.shift_x, thing.data.shift_y = 0.1, -0.05
    thing.data.dof.use_dof = True
    thing.data.dof.focus_distance, thing.data.dof.aperture_fstop = 7.0, 0.15


@scene
def orthographic():
    world(1, 0.9, 0.8)
    plane(20, diffuse(0.5, 0.5, 0.5))
    ball((-1, 0, 1), diffuse(0.2, 0.4, 0.8))
    cube((1.2, 0, 0.6), 1.2, diffuse(0.8, 0.5, 0.2))
    data = bpy.context.scene.camera.data
    data.type, data.ortho_scale, data.shift_x = "ORTHO", 6.0, 0.1


@scene
def motion():
    world(1, 1, 1)
    plane(20, diffuse(0.5, 0.5, 0.5))
    thing = ball((-1.5, 0, 1), diffuse(0.9, 0.2, 0.2), 0.7)
    thing.keyframe_insert("location", frame=1)
    thing.location = (1.5, 0, 1)
    thing.keyframe_insert("location", frame=3)
    for curve in curves_of(thing):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"
    made = bpy.context.scene
    made.frame_set(2)
    made.render.use_motion_blur, made.render.motion_blur_shutter = True, 1.0


@scene
def deforming():
    """A bar that a bone swings, a ball whose shape key grows, and a camera that moves."""
    world(1, 1, 1)
    plane(20, diffuse(0.5, 0.5, 0.5))
    made = bpy.context.scene
    bar = cube((-0.6, 0, 1), 0.4, diffuse(0.2, 0.4, 0.9))
    for vertex in bar.data.vertices:
        vertex.co.x *= 5
    rig = link(bpy.data.objects.new("rig", bpy.data.armatures.new("rig")))
    rig.location = (-1.6, 0, 1)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bone = rig.data.edit_bones.new("bone")
    bone.head, bone.tail = (0, 0, 0), (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    bar.vertex_groups.new(name="bone").add(list(range(len(bar.data.vertices))), 1, "REPLACE")
    bar.modifiers.new("bones", "ARMATURE").object = rig
    joint = rig.pose.bones["bone"]
    joint.rotation_mode = "XYZ"
    joint.keyframe_insert("rotation_euler", frame=1)
    joint.rotation_euler = (0, 0, math.radians(60))
    joint.keyframe_insert("rotation_euler", frame=3)
    growing = ball((1.6, 0, 1), diffuse(0.9, 0.2, 0.2), 0.5)
    growing.shape_key_add(name="small")
    wide = growing.shape_key_add(name="wide")
    for point in wide.data:
        point.co.x *= 2
    wide.keyframe_insert("value", frame=1)
    wide.value = 1
    wide.keyframe_insert("value", frame=3)
    eye = made.camera
    eye.keyframe_insert("location", frame=1)
    eye.location.z += 0.6
    eye.keyframe_insert("location", frame=3)
    for curves in (curves_of(rig), growing.data.shape_keys.animation_data.action.fcurves, curves_of(eye)):
        for curve in curves:
            for point in curve.keyframe_points:
                point.interpolation = "LINEAR"
    made.frame_set(2)
    made.render.use_motion_blur, made.render.motion_blur_shutter = True, 1.0


def curves_of(thing):
    """Returns the animation curves of an object."""
    return thing.animation_data.action.fcurves


@scene
def volume():
    world(0.5, 0.6, 0.7)
    plane(20, diffuse(0.6, 0.6, 0.6))
    light("SUN", (0, 0, 5), 2, target=(1, 1, 0), angle=0)
    made = bpy.data.materials.new("fog")
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    node = tree.nodes.new("ShaderNodeVolumePrincipled")
    node.inputs["Density"].default_value = 0.8
    node.inputs["Color"].default_value = (0.8, 0.7, 0.6, 1)
    node.inputs["Anisotropy"].default_value = 0.3
    tree.links.new(node.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Volume"])
    cube((0, 0, 1.01), 2, made)


# ---- scenes for other tests, which are not compared with Cycles ----


def layers():
    """Two view layers; the second one is without the ball."""
    SCENES["lens"]()
    hidden = bpy.data.collections.new("hidden")
    bpy.context.scene.collection.children.link(hidden)
    one = ball((0, 0, 1), diffuse(0, 1, 0))
    bpy.context.scene.collection.objects.unlink(one)
    hidden.objects.link(one)
    bpy.context.scene.view_layers.new("without").layer_collection.children["hidden"].exclude = True


OTHERS = {"layers": layers}
