"""Tests the installed add-on in Blender without a window. The add-on talks to
tests/python/fake_farm.py, a coordinator that renders nothing:

    BLENDER_USER_SCRIPTS=EMPTY-FOLDER blender -b --factory-startup --python addon_test.py -- ADDON.zip"""

import json
import os
import sys
import tempfile
import time
import unittest
from unittest import mock

import bpy
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.dont_write_bytecode = True
sys.path[:0] = [HERE, os.path.join(HERE, "..", "python")]
import fake_farm  # noqa: E402
import scenes  # noqa: E402

ADDON = sys.argv[sys.argv.index("--") + 1]


def preferences():
    return bpy.context.preferences.addons["bandsaw_blender"].preferences


class AddOn(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        bpy.ops.preferences.addon_install(filepath=ADDON)

    def setUp(self):
        scenes.build("gradient")  # loads factory settings, which disables the add-on
        bpy.ops.preferences.addon_enable(module="bandsaw_blender")
        self.no_exception_in_render()
        self.fake = fake_farm.FakeFarm()
        self.addCleanup(self.fake.stop)
        preferences().farm = self.fake.string
        self.scene = bpy.context.scene
        self.scene.render.engine = "BANDSAW"
        self.scene.bandsaw.samples = 7
        self.scene.bandsaw.denoise = False
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.scene.render.image_settings.file_format = "OPEN_EXR"
        self.scene.render.image_settings.color_depth = "32"
        self.scene.render.filepath = os.path.join(self.folder.name, "out.exr")

    def no_exception_in_render(self):
        """Makes the test fail at its end if the engine raised an exception, which Blender only prints."""
        engine = sys.modules["bandsaw_blender.engine"].BandsawEngine
        whole, raised = engine.render, []

        def noting(this, depsgraph):
            try:
                whole(this, depsgraph)
            except Exception as error:
                raised.append(repr(error))
                raise

        engine.render = noting
        self.addCleanup(setattr, engine, "render", whole)
        self.addCleanup(lambda: self.assertEqual(raised, []))

    def render(self):
        bpy.ops.render.render(write_still=True)

    def pixels(self):
        image = bpy.data.images.load(self.scene.render.filepath)
        width, height = image.size
        return np.array(image.pixels[:]).reshape(height, width, 4)

    def saved(self, image, name, file_format):
        """Saves the image to a file and returns the image that is loaded from it."""
        image.filepath_raw, image.file_format = os.path.join(self.folder.name, name), file_format
        image.save()
        return bpy.data.images.load(image.filepath_raw)

    def fails_with(self, *words):
        """Renders. The render must end with one error that has these words, and Blender must go on.
        Returns the error."""
        with self.assertRaises(RuntimeError) as caught:
            self.render()
        for word in words:
            self.assertIn(word, str(caught.exception))
        self.assertEqual(str(caught.exception).count("Error: Bandsaw:"), 1, str(caught.exception))
        self.assertFalse(os.path.exists(self.scene.render.filepath) and os.path.getsize(self.scene.render.filepath) == 0)
        return str(caught.exception)

    def sent(self):
        """Returns the scene file that was sent last, as a dictionary, and the files that were sent
        with it."""
        scene = self.fake.scenes[-1]
        return json.loads(scene["files"][scene["main"]]), scene["files"]

    def material_of(self, nodes, **inputs):
        """Renders a plane whose Principled BSDF the function `nodes` changes (scenes.material). Returns the material's fields that were sent."""
        thing = scenes.plane(1, scenes.material("tested", nodes, **inputs))
        thing.name = "tested"
        self.render()
        return self.sent()[0]["material"][-1]

    def texels(self, texture):
        """`texture`: a message Texture of the scene that was sent last. Returns the linear pixels
        of its image as an array (height, width, 3), with rows from the bottom."""
        name = texture["image"]["file"]
        path = os.path.join(self.folder.name, name)
        with open(path, "wb") as file:
            file.write(self.sent()[1][name])
        image = bpy.data.images.load(path)
        width, height = image.size
        pixels = np.array(image.pixels[:]).reshape(height, width, 4)[:, :, :3]
        if texture["image"]["encoding"] == "ENCODING_SRGB":
            pixels = sys.modules["bandsaw_blender.files"].linear(pixels)
        return pixels

    def told(self):
        """Returns the warnings of the last render about what is not shown, one a line."""
        return "\n".join(sys.modules["bandsaw_blender.engine"].last_warnings)

    def test_a_still_has_the_farms_pixels(self):
        self.render()
        got = self.pixels()
        self.assertEqual(got.shape, (64, 96, 4))
        # In the picture of the fake farm, red is x / width and green is y / height.
        y, x = np.mgrid[0:64, 0:96]
        self.assertLess(abs(got[:, :, 0] - x / 96).max(), 1e-6)
        self.assertLess(abs(got[:, :, 1] - y / 64).max(), 1e-6)
        self.assertEqual(got[:, :, 3].min(), 1)
        self.assertEqual(self.fake.scenes[-1]["samples"], "7")

    def test_an_error_limit_is_sent_as_a_fraction(self):
        self.scene.bandsaw.stop, self.scene.bandsaw.error = "ERROR", 5
        self.render()
        self.assertAlmostEqual(float(self.fake.scenes[-1]["error"]), 0.05)

    def test_unchanged_files_are_not_sent_again(self):
        self.render()
        self.fake.requests.clear()
        bpy.context.scene.camera.location.x += 1
        self.render()
        file_counts = [len(scene["files"]) for scene in self.fake.scenes]
        self.assertEqual(file_counts[0], file_counts[1])
        sent_again = len([1 for method, path in self.fake.requests if path == "/api/files"])
        self.assertEqual(sent_again, 1)  # the scene file alone, whose camera has moved

    def test_an_animation_is_a_job_for_each_frame(self):
        self.scene.frame_start, self.scene.frame_end = 3, 5
        self.scene.render.filepath = os.path.join(self.folder.name, "f")
        bpy.ops.render.render(animation=True)
        self.assertEqual(sorted(os.listdir(self.folder.name)), ["f0003.exr", "f0004.exr", "f0005.exr"])
        self.assertEqual([scene["title"] for scene in self.fake.scenes], ["untitled 3", "untitled 4", "untitled 5"])

    def test_an_animation_has_the_world_of_each_frame(self):
        tree, background = scenes.world(1, 1, 1)
        for frame, strength in ((1, 2), (2, 3)):
            background.inputs["Strength"].default_value = strength
            background.inputs["Strength"].keyframe_insert("default_value", frame=frame)
        self.scene.frame_set(1)
        self.scene.frame_start, self.scene.frame_end = 1, 2
        self.scene.render.filepath = os.path.join(self.folder.name, "f")
        bpy.ops.render.render(animation=True)
        found = [json.loads(scene["files"][scene["main"]])["background"]["constant"]["rgb"] for scene in self.fake.scenes]
        self.assertEqual(found, [[2, 2, 2], [3, 3, 3]])

    def test_percentage_and_region_change_size_and_window(self):
        self.scene.render.resolution_percentage = 50
        self.render()
        self.assertEqual(self.sent()[0]["image"]["width"], 48)
        whole = self.sent()[0]["camera"]["window"]
        self.scene.render.use_border, self.scene.render.use_crop_to_border = True, True
        self.scene.render.border_min_x, self.scene.render.border_max_x = 0.25, 0.75
        self.scene.render.border_min_y, self.scene.render.border_max_y = 0.0, 0.5
        self.render()
        scene, _ = self.sent()
        self.assertEqual((scene["image"]["width"], scene["image"]["height"]), (24, 16))
        left, right, bottom, top = scene["camera"]["window"]
        self.assertAlmostEqual(left, whole[0] / 2)
        self.assertAlmostEqual(right, whole[1] / 2)
        self.assertAlmostEqual(bottom, whole[2])
        self.assertAlmostEqual(top, 0)
        self.assertEqual(self.pixels().shape, (16, 24, 4))

    def test_passes_are_rendered_and_converted(self):
        layer = bpy.context.view_layer
        layer.use_pass_z = layer.use_pass_normal = layer.use_pass_diffuse_color = True
        self.scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
        self.render()
        self.assertEqual([job["kind"] for job in self.fake.jobs.values()], ["path", "depth", "normals", "albedo"])
        engine = sys.modules["bandsaw_blender.engine"]
        # For a normal n, the farm's layer has (n + 1) / 2 with y up, and Blender's pass has n with z
        # up. If a ray hits nothing, the depth is 0 on the farm and 1e10 in Blender.
        up = engine.pass_pixels("normals", np.full((1, 1, 3), 0.5) + [[[0, 0.5, 0]]], None)
        self.assertEqual(up.tolist(), [[[0, 0, 1]]])
        eye = {"window": [-2, 4, -3, 1]}
        self.assertEqual(engine.pass_pixels("depth", np.zeros((1, 1, 3)), eye).tolist(), [[[1e10]]])
        # The farm's depth is along the ray, and Blender's is along the camera's axis. At distance 1 the pixels' centres are at (-0.5, 0), (2.5, 0),
        # (-0.5, -2) and (2.5, -2), and `rays` has the distances from the camera to them. So 3 * rays must become 3. The rays of an orthographic
        # camera are parallel to its axis, so the depths must not change.
        rays = np.sqrt([[1.25, 7.25], [5.25, 11.25]])
        for camera, depths in ((eye, np.full((2, 2), 3)), ({**eye, "orthographic": {}}, 3 * rays)):
            found = engine.pass_pixels("depth", np.repeat(3 * rays[:, :, None], 3, axis=2), camera)[:, :, 0]
            self.assertLess(abs(found - depths).max(), 1e-6)

    def test_a_denoised_picture_has_the_noisy_one_as_a_pass(self):
        self.scene.property_unset("bandsaw")  # Denoise is on by default
        shown = {}
        engine = sys.modules["bandsaw_blender.engine"].BandsawEngine
        given = engine.set_pixels

        def noting(this, result, name, pixels):
            shown[name] = pixels, result.layers[0].passes.get(name) is not None
            given(this, result, name, pixels)

        with mock.patch.object(engine, "set_pixels", noting):
            self.render()
        self.assertEqual(self.pixels()[5, 7].tolist(), [0.75, 0.5, 0.25, 1])  # the fake farm's denoised picture has one colour
        noisy, has_pass = shown["Noisy Image"]
        self.assertTrue(has_pass)
        self.assertLess(abs(noisy[::-1, :, 0] - np.arange(96) / 96).max(), 1e-6)

    def test_the_sample_count_is_a_pass(self):
        self.scene.bandsaw.pass_samples = True
        engine = sys.modules["bandsaw_blender.engine"].BandsawEngine
        given, counts = engine.set_pixels, []

        def noting(this, result, name, pixels):
            if name == "Debug Sample Count":
                counts.append((result.layers[0].passes.get(name) is not None, pixels.shape, float(pixels.min()), float(pixels.max())))
            given(this, result, name, pixels)

        with mock.patch.object(engine, "set_pixels", noting):
            self.render()
        self.assertEqual(counts, [(True, (64, 96, 1), 64, 64)])  # the fake farm takes 64 samples

    def test_a_picture_that_cannot_be_denoised_stays_as_it_was_rendered(self):
        self.scene.bandsaw.denoise = True
        self.fake.clean_failure = "a guide has failed"
        self.render()
        self.assertLess(abs(self.pixels()[:, :, 0] - np.arange(96) / 96).max(), 1e-6)
        self.assertIn("the image is not denoised: the image of job 1 was not denoised: a guide has failed", self.told())

    def test_esc_during_denoising_keeps_the_image_as_rendered(self):
        self.scene.bandsaw.denoise = True
        module = sys.modules["bandsaw_blender.engine"]
        with mock.patch.object(module.BandsawEngine, "denoise", side_effect=module.Stopped):
            self.render()
        self.assertLess(abs(self.pixels()[:, :, 0] - np.arange(96) / 96).max(), 1e-6)

    def test_esc_during_the_passes_cancels_all_of_them(self):
        layer = bpy.context.view_layer
        layer.use_pass_z = layer.use_pass_normal = layer.use_pass_diffuse_color = True
        module = sys.modules["bandsaw_blender.engine"]
        passes = [mock.Mock(**{"progress.return_value": []}) for _ in range(3)]
        engine, job = mock.Mock(**{"test_break.return_value": True}), mock.Mock(**{"layer.side_effect": passes})
        self.assertRaises(module.Stopped, module.BandsawEngine.add_passes, engine, mock.Mock(view_layer=layer), job, None, None)
        self.assertEqual([submitted.cancel.call_count for submitted in passes], [1, 1, 1])

    def test_a_missing_string_is_reported(self):
        preferences().farm = ""
        os.environ.pop("BANDSAW_FARM", None)
        self.fails_with("paste its string")

    def test_a_wrong_string_is_reported(self):
        preferences().farm = self.fake.string[:-1] + "x"
        self.fails_with("refuses this string")
        preferences().farm = "hello"
        self.fails_with("must begin with bsw1-f-")

    def test_a_missing_coordinator_is_reported(self):
        other = fake_farm.FakeFarm()
        string = other.string
        other.stop()
        preferences().farm = string
        self.fails_with("no coordinator answers", "bandsaw serve")

    def test_a_coordinator_that_disappears_is_reported(self):
        engine = sys.modules["bandsaw_blender.engine"]
        self.addCleanup(setattr, engine, "PATIENCE", engine.PATIENCE)
        engine.PATIENCE = 0.5
        self.fake.seconds = 1000

        answer = self.fake.answer

        def once_then_close(request, body):  # the coordinator goes away after the first question about the job
            answer(request, body)
            if request.path.startswith("/api/jobs/"):
                self.fake.server.socket.close()
        self.fake.answer = once_then_close
        self.fails_with("no coordinator answers")

    def test_a_refused_scene_is_reported(self):
        self.fake.refusals = [400]
        self.fails_with("not now")

    def test_a_missing_camera_is_reported(self):
        self.scene.camera = None
        self.assertRaises(RuntimeError, self.render)  # Blender's own message

    def test_a_missing_texture_is_named_and_the_rest_is_rendered(self):
        image = bpy.data.images.new("wood", 4, 4)
        image.source, image.filepath = "FILE", "/nowhere/wood.png"

        def nodes(tree, shader):
            node = tree.nodes.new("ShaderNodeTexImage")
            node.image = image
            tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
        scenes.plane(1, scenes.material("table", nodes))
        self.render()
        engine = sys.modules["bandsaw_blender.engine"]
        named = [warning for warning in engine.last_warnings if "wood" in warning]
        self.assertEqual(len(named), 1, engine.last_warnings)
        self.assertIn('material "table"', named[0])
        self.assertIn("missing", named[0])

    def test_unsupported_features_cause_warnings(self):
        def nodes(tree, shader):
            tree.links.new(tree.nodes.new("ShaderNodeBsdfToon" if hasattr(bpy.types, "ShaderNodeBsdfToon") else "ShaderNodeBsdfSheen").outputs[0],
                           tree.nodes["Material Output"].inputs["Surface"])
        scenes.plane(1, scenes.material("cartoon", nodes))

        def sides(tree, shader):
            tree.links.new(tree.nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"], shader.inputs["Roughness"])
            tree.links.new(tree.nodes.new("ShaderNodeLightPath").outputs["Is Shadow Ray"], shader.inputs["Metallic"])
        scenes.plane(1, scenes.material("sides", sides))
        self.scene.render.film_transparent = True
        self.fake.warnings = ["the importer says this"]
        self.render()
        for word in ('material "cartoon"', "transparent background", "the importer says this",
                     'material "sides": "Backfacing" of the node "Geometry"', 'material "sides": the node "Light Path" depends on the ray'):
            self.assertIn(word, self.told())

    def test_a_backdrop_for_the_camera_does_not_light_the_scene(self):
        tree, lit = scenes.world(1, 0.5, 0)
        backdrop, mix, path = (tree.nodes.new("ShaderNode" + kind) for kind in ("Background", "MixShader", "LightPath"))
        backdrop.inputs["Color"].default_value = (0, 0, 1, 1)
        tree.links.new(path.outputs["Is Camera Ray"], mix.inputs[0])
        tree.links.new(lit.outputs[0], mix.inputs[1])
        tree.links.new(backdrop.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], tree.nodes["World Output"].inputs["Surface"])
        self.render()
        self.assertEqual(self.sent()[0]["background"], {"constant": {"rgb": [1, 0.5, 0]}})
        self.assertIn('the world: the node "Light Path" depends on the ray', self.told())

    def test_reflectances_above_1_are_sent_as_1(self):
        made = self.material_of(None, Base_Color=(2, 0.5, 0.25, 1), Roughness=1.0, Specular=0.0)
        self.assertEqual(max(made["gltf"]["base_color"]["rgb"]), 1)

        def bright(tree, shader):
            noise, double = tree.nodes.new("ShaderNodeTexNoise"), tree.nodes.new("ShaderNodeMath")
            double.operation, double.inputs[1].default_value = "MULTIPLY", 3
            tree.links.new(noise.outputs["Fac"], double.inputs[0])
            for name in ("Base Color", "Roughness", "Alpha"):
                tree.links.new(double.outputs[0], shader.inputs[name])
            tree.links.new(double.outputs[0], scenes.socket(shader, "Emission"))
            scenes.socket(shader, "Emission_Strength").default_value = 1
        made = self.material_of(bright)["gltf"]
        for field in ("base_color_texture", "roughness_texture", "alpha_texture"):
            self.assertEqual(self.texels(made[field]).max(), 1, field)
        self.assertGreater(self.texels(made["emissive_texture"]).max(), 1.2)

    def test_a_float_image_above_1_reflects_1_and_emits_its_values(self):
        image = scenes.picture("hdr", np.full((4, 4, 3), 1.5), is_float=True)
        image = self.saved(image, "hdr.exr", "OPEN_EXR")

        def both(tree, shader):
            node = tree.nodes.new("ShaderNodeTexImage")
            node.image = image
            tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
            tree.links.new(node.outputs["Color"], scenes.socket(shader, "Emission"))
            scenes.socket(shader, "Emission_Strength").default_value = 1
        made = self.material_of(both)["gltf"]
        self.assertTrue(np.allclose(self.texels(made["base_color_texture"]), 1))
        self.assertTrue(np.allclose(self.texels(made["emissive_texture"]), 1.5))

    def test_a_muted_node_passes_its_input_on(self):
        def muted(kind, output, name):
            def nodes(tree, shader):
                node = tree.nodes.new("ShaderNode" + kind)
                if "Color" in node.inputs:
                    node.inputs["Color"].default_value = (0, 1, 0, 1)
                tree.links.new(node.outputs[output], shader.inputs[name])
                node.mute = True
            return nodes
        # A muted node passes on its input for the colour. If no input fits, the shader's own value
        # counts.
        for kind, output, name, green in (("HueSaturation", 0, "Base Color", 1), ("TexVoronoi", "Color", "Base Color", 0), ("Bump", 0, "Normal", 0),
                                          ("NormalMap", 0, "Normal", 0)):
            color = self.material_of(muted(kind, output, name), Base_Color=(1, 0, 0, 1), Roughness=1.0, Specular=0.0)["gltf"]["base_color"]["rgb"]
            self.assertGreater(color[1 if green else 0], 0.9, kind)
            self.assertEqual(color[0 if green else 1], 0, kind)
        self.assertEqual(self.told(), "")

    def test_a_muted_link_is_ignored(self):
        def nodes(tree, shader):
            tree.links.new(tree.nodes.new("ShaderNodeRGB").outputs[0], shader.inputs["Base Color"]).is_muted = True
            displacement = tree.nodes.new("ShaderNodeDisplacement")
            tree.links.new(displacement.outputs[0], tree.nodes["Material Output"].inputs["Displacement"])
            displacement.mute = True
        color = self.material_of(nodes, Base_Color=(1, 0, 0, 1), Roughness=1.0, Specular=0.0)["gltf"]["base_color"]["rgb"]
        self.assertEqual(color[1:], [0, 0])
        self.assertEqual(self.told(), "")

    def test_a_muted_shader_is_black(self):
        def nodes(tree, shader):
            shader.mute = True
        self.assertEqual(self.material_of(nodes)["diffuse"]["texture"]["color"]["rgb"], [0, 0, 0])

    def test_muted_volumes_worlds_and_lamps_are_not_sent(self):
        def fog(tree, shader):
            node = tree.nodes.new("ShaderNodeVolumePrincipled")
            tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Volume"])
            node.mute = True
        tree, _ = scenes.world(1, 1, 1)
        mist = tree.nodes.new("ShaderNodeVolumeScatter")
        tree.links.new(mist.outputs[0], tree.nodes["World Output"].inputs["Volume"])
        mist.mute = True
        lamp = scenes.light("POINT", (0, 0, 3), 100).data
        lamp.use_nodes = True
        lamp.node_tree.nodes["Emission"].mute = True
        self.material_of(fog)
        sent, _ = self.sent()
        self.assertEqual([field for field in ("medium", "fog", "light") if field in sent], [])
        self.assertEqual([model for model in sent["model"] if "interior" in model], [])
        self.assertEqual(self.told(), "")

    def test_a_texture_lies_on_the_uv_map_that_its_node_names(self):
        image = scenes.picture("halves", np.concatenate([np.tile([1.0, 0, 0], (8, 4, 1)), np.tile([0, 1.0, 0], (8, 4, 1))], axis=1))
        for name, column in (("second", 0), ("third", 1), ("nowhere", 0)):
            def nodes(tree, shader):
                # Makes three nodes "UV Map". The texture uses the last one, which names `name`.
                for number, uv_map in enumerate(("second", "third", name)):
                    uv = tree.nodes.new("ShaderNodeUVMap")
                    uv.uv_map = uv_map
                texture = tree.nodes.new("ShaderNodeTexImage")
                texture.image = image
                tree.links.new(uv.outputs[0], texture.inputs["Vector"])
                invert = tree.nodes.new("ShaderNodeInvert")  # so that it is baked
                tree.links.new(texture.outputs["Color"], invert.inputs["Color"])
                tree.links.new(invert.outputs[0], shader.inputs["Base Color"])
            thing = scenes.plane(1, scenes.material(name, nodes))
            for other, u in (("second", 0.25), ("third", 0.75)):
                thing.data.uv_layers.new(name=other).data.foreach_set("uv", [u, 0.5] * 4)
            self.render()
            texture = self.sent()[0]["material"][-1]["gltf"]["base_color_texture"]
            pixels = self.texels(texture)
            if name == "nowhere":  # the texture lies on the active map and is baked whole
                self.assertNotIn("uv_set", texture["image"])
                self.assertLess(pixels[:, 64, 0].max(), 0.01)
                self.assertGreater(pixels[:, 192, 0].min(), 0.99)
            else:  # one colour: inverted red is cyan, inverted green magenta
                self.assertEqual(texture["image"]["uv_set"], "UV_SET_SECOND")
                self.assertLess(pixels[:, :, column].max(), 0.01, name)
                self.assertGreater(pixels[:, :, 1 - column].min(), 0.99, name)
            bpy.data.objects.remove(thing)

    def test_baked_normals_are_in_world_space_and_a_shared_mesh_causes_a_warning(self):
        def nodes(tree, shader):
            coordinates = tree.nodes.new("ShaderNodeNewGeometry")
            tree.links.new(coordinates.outputs["Normal"], shader.inputs["Base Color"])
        # The wall's normal is +x in the world, and +z in the wall's own space.
        wall = scenes.plane(4, scenes.material("snow", nodes), turn=(0, np.pi / 2, 0))
        wall.scale = (1, 2, 3)
        self.render()
        pixels = self.texels(self.sent()[0]["material"][-1]["gltf"]["base_color_texture"])
        self.assertLess(abs(pixels[10:100, 10:100] - (1, 0, 0)).max(), 0.01)
        self.assertEqual(self.told(), "")
        other = scenes.link(wall.copy())
        other.rotation_euler = (0, 0, 0)
        self.render()
        self.assertIn(f'textures of the mesh "{wall.data.name}" depend on where it is', self.told())

    def test_generated_coordinates_are_those_before_deformation(self):
        def nodes(tree, shader):
            coordinates = tree.nodes.new("ShaderNodeTexCoord")
            tree.links.new(coordinates.outputs["Generated"], shader.inputs["Base Color"])
        thing = scenes.plane(2, scenes.material("generated", nodes))
        self.render()
        before = self.texels(self.sent()[0]["material"][-1]["gltf"]["base_color_texture"])
        thing.shape_key_add(name="basis")
        moved = thing.shape_key_add(name="moved")
        for point in moved.data:
            point.co.x += 5
        moved.value = 1
        self.render()
        after = self.texels(self.sent()[0]["material"][-1]["gltf"]["base_color_texture"])
        self.assertGreater(before[:, :, 0].std(), 0.2)
        self.assertLess(abs(after - before).max(), 0.01)

    def test_a_mirrored_area_light_shines_forwards(self):
        for scale in ((1, 1, 1), (-1, 1, 1), (1, -2, 1), (1, 1, -1)):
            lamp = scenes.light("AREA", (0, 0, 3), 100, size=1)
            lamp.rotation_euler, lamp.scale = (0, 0, 0), scale
            self.render()
            quad = self.sent()[0]["shape"][0]["quad"]
            normal = np.cross(quad["u"], quad["v"])
            self.assertEqual(np.sign(normal).tolist(), [0, -scale[2], 0], scale)
            bpy.data.objects.remove(lamp)

    def test_colours_are_multiplied_by_an_alpha_that_is_not_used(self):
        image = bpy.data.images.new("veil", 4, 4, alpha=True)
        image.pixels.foreach_set(np.tile(np.array([1, 1, 0, 0.25], dtype=np.float32), 16))
        image = self.saved(image, "veil.png", "PNG")

        def nodes(tree, shader):
            node = tree.nodes.new("ShaderNodeTexImage")
            node.image = image
            scale = tree.nodes.new("ShaderNodeVectorMath")  # so that the emission is baked
            scale.operation = "SCALE"
            tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
            tree.links.new(node.outputs["Color"], scale.inputs[0])
            tree.links.new(scale.outputs[0], scenes.socket(shader, "Emission"))
            scenes.socket(shader, "Emission_Strength").default_value = 1
        made = self.material_of(nodes)["gltf"]
        # Cycles multiplies the file's encoded sRGB values. The product 0.25 is 0.0509 when decoded.
        for field in ("base_color_texture", "emissive_texture"):
            self.assertLess(abs(self.texels(made[field]) - (0.0509, 0.0509, 0)).max(), 0.002, field)

        def with_alpha(tree, shader):
            nodes(tree, shader)
            tree.links.new(tree.nodes["Image Texture"].outputs["Alpha"], shader.inputs["Alpha"])
        self.assertLess(abs(self.texels(self.material_of(with_alpha)["gltf"]["base_color_texture"]) - (1, 1, 0)).max(), 0.005)

    def test_visibility_settings_without_effect_cause_warnings(self):
        self.render()
        self.assertEqual(self.told(), "")
        thing = scenes.cube((0, 0, 1), 1, scenes.diffuse(1, 0, 0))
        thing.is_shadow_catcher = thing.is_holdout = True
        rays = ("camera", "diffuse", "glossy", "transmission", "volume_scatter", "shadow")
        for kind in rays:
            setattr(thing, "visible_" + kind, False)
        self.scene.world.cycles_visibility.camera = False
        self.scene.camera.data.clip_start = 1
        self.render()
        told = self.told()
        for words in ("shadow catcher", "holdout", "by the camera", "diffuse rays", "glossy rays", "transmitted", "volumes scatter", "casts shadows"):
            self.assertEqual(len([line for line in told.splitlines() if line.startswith('"Cube" ') and words in line]), 1, told)
        self.assertIn("Ray Visibility", told)
        self.assertIn("Clip Start", told)

    def test_fire_in_a_grid_causes_a_warning(self):
        fire = scenes.only("VolumePrincipled", Blackbody_Intensity=1.0)
        tree = fire.node_tree
        end = tree.nodes["Material Output"]
        tree.links.new(end.inputs["Surface"].links[0].from_socket, end.inputs["Volume"])
        tree.links.remove(end.inputs["Surface"].links[0])
        grid = scenes.link(bpy.data.objects.new("flame", bpy.data.volumes.new("flame")))
        grid.data.materials.append(fire)
        grid.data.filepath = os.path.join(self.folder.name, "flame.vdb")
        with open(grid.data.filepath, "wb") as file:
            file.write(b"not a grid, so the volume is empty")
        self.render()
        self.assertIn('the volume "flame": fire', self.told())

    def test_two_million_triangles_are_converted_without_added_vertices(self):
        geometry = sys.modules["bandsaw_blender.geometry"]
        mesh = bpy.data.meshes.new("big")
        n = 1001
        y, x = np.divmod(np.arange(n * n), n)
        mesh.vertices.add(n * n)
        mesh.vertices.foreach_set("co", np.stack([x, y, np.sin(x * 0.1)], axis=1).astype(np.float32).reshape(-1))
        k = np.arange((n - 1) ** 2)
        corner = k // (n - 1) * n + k % (n - 1)
        quads = np.stack([corner, corner + 1, corner + n + 1, corner + n], axis=1)
        mesh.loops.add(quads.size)
        mesh.loops.foreach_set("vertex_index", quads.astype(np.int32).reshape(-1))
        mesh.polygons.add(len(quads))
        mesh.polygons.foreach_set("loop_start", np.arange(0, quads.size, 4, dtype=np.int32))
        if bpy.app.version < (3, 6, 0):
            mesh.polygons.foreach_set("loop_total", np.full(len(quads), 4, dtype=np.int32))
        mesh.polygons.foreach_set("use_smooth", np.ones(len(quads), dtype=bool))
        mesh.update(calc_edges=True)
        mesh.uv_layers.new().data.foreach_set("uv", np.stack([x, y], axis=1).astype(np.float32)[quads.reshape(-1)].reshape(-1))
        before = time.process_time()
        found = geometry.triangles_of(mesh, [""])
        data = geometry.glb(found[0])
        print(f"2,000,000 triangles in {time.process_time() - before:.2f} s of CPU, {len(data) >> 20} MiB")
        self.assertEqual(len(found[0].indices), 2_000_000)
        self.assertEqual(len(found[0].positions), n * n)  # no seam: no vertex was added


result = unittest.main(argv=["addon_test", "-v"] + sys.argv[sys.argv.index("--") + 2:], exit=False).result
sys.stdout.flush()
os._exit(0 if result.wasSuccessful() else 1)
