"""The render engine "Bandsaw": renders Blender's scene on a farm, and shows the picture while
samples arrive."""

import os
import time

import bpy
import numpy as np

from . import bandsaw, scene as scenes

# The passes that the farm can render. Each entry has, in this order: Blender's setting that
# switches the pass on, the name of the pass, the number of channels, the letters of the channels,
# the type of the pass, and the kind of the layer that the farm renders for the pass
# (bandsaw.Job.layer).
PASSES = (("use_pass_z", "Depth", 1, "Z", "VALUE", "depth"), ("use_pass_normal", "Normal", 3, "XYZ", "VECTOR", "normals"),
          ("use_pass_diffuse_color", "DiffCol", 3, "RGB", "COLOR", "albedo"))
SAMPLES = "Debug Sample Count"  # the pass with the number of samples of each pixel; named as that of Cycles
NOISY = "Noisy Image"  # the pass that keeps the image as rendered if the image is denoised; Cycles has a pass of the same name
PATIENCE = 60.0  # seconds for which the engine tries to reach a lost coordinator

last_warnings = []  # warnings of the last render, for the panel


def preferences():
    """Returns the add-on's preferences; None if the add-on runs without being installed
    (headless)."""
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon is not None else None


def farm_string():
    """Returns the farm's join string from the preferences, or else from the environment's BANDSAW_FARM; empty: there is none."""
    kept = preferences()
    text = kept.farm.strip() if kept is not None else ""
    return text or os.environ.get("BANDSAW_FARM", "").strip()


def region_of(render, size):
    """Returns the region to render, (x0, y0, x1, y1) in pixels from the lower left; None: the whole image. `size`: (width, height)."""
    if not render.use_border:
        return None
    width, height = size
    x0, x1 = int(render.border_min_x * width), int(render.border_max_x * width)
    y0, y1 = int(render.border_min_y * height), int(render.border_max_y * height)
    return (x0, y0, max(x1, x0 + 1), max(y1, y0 + 1))


class Stopped(Exception):
    """The user pressed Esc."""


# Blender calls update_render_passes() and render(). In the methods, `made` is the scene.Scene that
# is sent.
class BandsawEngine(bpy.types.RenderEngine):
    bl_idname = "BANDSAW"
    bl_label = "Bandsaw"
    bl_use_preview = False
    bl_use_postprocess = True
    bl_use_shading_nodes_custom = False
    bl_use_eevee_viewport = True  # the viewport's "Material Preview" and "Rendered" are drawn by EEVEE

    # Tells Blender which passes a view layer has.
    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        if scene.bandsaw.denoise:
            self.register_pass(scene, renderlayer, NOISY, 4, "RGBA", "COLOR")
        if scene.bandsaw.pass_samples:
            self.register_pass(scene, renderlayer, SAMPLES, 1, "X", "VALUE")
        for setting, name, channels, letters, kind, _ in PASSES:
            if getattr(renderlayer, setting, False):
                self.register_pass(scene, renderlayer, name, channels, letters, kind)

    # Renders one view layer. Errors are reported to the user.
    def render(self, depsgraph):
        try:
            self.render_on_farm(depsgraph)
        except Stopped:
            pass
        except (bandsaw.BandsawError, RuntimeError) as error:
            self.fail(error)
        except MemoryError:
            self.fail("the memory of this machine does not suffice to send the scene; close other programs, or hide or simplify large meshes")
        except OSError as error:
            self.fail(f"the scene's files cannot be written: {error}")

    def fail(self, message):
        self.report({"ERROR"}, f"Bandsaw: {message}")
        if bpy.app.version < (4, 3):
            # From version 4.3 on, error_set() would show the message a second time.
            self.error_set(f"Bandsaw: {message}")

    # Does the work of render(). Raises Stopped, bandsaw.BandsawError, RuntimeError, MemoryError or
    # OSError.
    def render_on_farm(self, depsgraph):
        scene = depsgraph.scene
        size = (self.resolution_x, self.resolution_y)
        string = farm_string()
        if not string:
            raise bandsaw.WrongString("there is no farm yet: paste its string into Edit > Preferences > Add-ons > Bandsaw")
        kept = preferences()
        farm = bandsaw.Farm(string, web=(kept.web.strip() or None) if kept is not None else None)
        farm.check()
        self.update_stats("", "Reading the scene")
        last_warnings.clear()
        made = scenes.build(depsgraph, scene, size, region_of(scene.render, size), self.camera_override, self.frame_set)
        self.tell_warnings(made.warnings)
        self.stop_if_asked()
        job = self.submit(farm, scene, made)
        try:
            self.follow(depsgraph, job, made)
        except Stopped:
            job.cancel()
            raise

    def tell_warnings(self, warnings):
        for warning in warnings:
            if warning not in last_warnings:
                last_warnings.append(warning)
                self.report({"WARNING"}, f"Bandsaw: {warning}")

    def stop_if_asked(self):
        if self.test_break():
            raise Stopped()

    # Sends the scene `made` to the farm and returns its bandsaw.Job. `scene`: Blender's scene with
    # the settings.
    def submit(self, farm, scene, made):
        def on_progress(sent, total):
            self.stop_if_asked()
            self.update_stats("", f"Sending the scene: {sent >> 20} of {-(-total >> 20)} MiB")

        wanted = {"error": scene.bandsaw.error / 100} if scene.bandsaw.stop == "ERROR" else {"samples": scene.bandsaw.samples}
        name = os.path.splitext(os.path.basename(bpy.data.filepath))[0] or "untitled"
        self.update_stats("", "Sending the scene")
        files = dict(made.files)
        job = farm.submit(made.text(), name=scenes.Scene.MAIN, files=files, on_progress=on_progress, title=f"{name} {scene.frame_current}", **wanted)
        self.tell_warnings(job.warnings)
        return job

    # Shows previews until the job is done, then the finished image and the passes. The time between
    # previews grows with the time that a preview takes, so that previews do not slow the render.
    def follow(self, depsgraph, job, made):
        width, height = made.scene["image"]["width"], made.scene["image"]["height"]
        result = self.begin_result(0, 0, width, height, layer=depsgraph.view_layer.name)
        done = False
        try:
            shown, wait = -1, 0.0
            for progress in job.progress(interval=0.3, patience=PATIENCE, stop=self.test_break):
                self.show_progress(progress)
                now = time.monotonic()
                if progress.state == "running" and progress.samples_done > max(shown, 0) and now >= wait:
                    began = time.monotonic()
                    if self.show_preview(job, result, width, height):
                        shown = progress.samples_done
                    wait = time.monotonic() + max(0.4, 4 * (time.monotonic() - began))
            self.stop_if_asked()
            image = with_alpha(job.image().array())
            self.set_pixels(result, "Combined", image)
            self.update_result(result)
            done = True  # from here on, Esc and errors leave the image as it is
            if depsgraph.scene.bandsaw.denoise:
                self.denoise(job, result, image)
            if depsgraph.scene.bandsaw.pass_samples:
                self.set_pixels(result, SAMPLES, np.full(image.shape[:2] + (1,), progress.samples, dtype=np.float32))
            self.add_passes(depsgraph, job, result, made.scene["camera"])
            self.update_result(result)
        finally:
            self.end_result(result, cancel=not done and self.test_break(), do_merge_results=done)

    def denoise(self, job, result, image):
        """Shows the image of a finished job without its noise. `image` (height, width, 4): the image as rendered, which the pass NOISY keeps. If
        the image cannot be denoised, a warning tells why, and the image as rendered stays."""
        self.set_pixels(result, NOISY, image)
        last = {}

        def on_state(state):
            last.update(state)
            self.update_stats("", f"Rendering what the denoiser needs: {100 * state['fraction']:.0f} %" if state["state"] == "guides" else "Denoising")

        try:
            clean = job.clean(on_state, patience=PATIENCE, stop=self.test_break)
            self.stop_if_asked()
        except bandsaw.BandsawError as error:
            self.tell_warnings([f"the image is not denoised: {error}"])
            return
        self.set_pixels(result, "Combined", with_alpha(clean.array()))
        self.report({"INFO"}, f"Bandsaw: the estimated error is {100 * last['error_raw']:.2g} % as rendered, {100 * last['error_clean']:.2g} % denoised")

    def show_progress(self, progress):
        self.update_progress(progress.fraction)
        omitted = f" | {len(last_warnings)} things are not shown as in Blender: see Render Properties" if last_warnings else ""
        self.update_stats("", str(progress) + omitted)

    def show_preview(self, job, result, width, height):
        """Shows the job's present picture. Returns False if the job has no picture yet, or if the farm
        does not answer."""
        try:
            picture = job.preview(max(width, height) if width * height <= 4_000_000 else 1024)
        except bandsaw.NoFarm:
            return False  # the next request to the farm reports the error
        if picture is None:
            return False
        pixels = picture.array()
        if pixels.shape[:2] != (height, width):
            pixels = pixels[np.arange(height) * pixels.shape[0] // height][:, np.arange(width) * pixels.shape[1] // width]
        self.set_pixels(result, "Combined", with_alpha(pixels))
        self.update_result(result)
        return True

    def set_pixels(self, result, name, pixels):
        """Gives Blender the pixels of the pass `name`: (height, width, channels), rows from the top."""
        found = result.layers[0].passes.get(name)
        if found is None:
            return
        rows = np.ascontiguousarray(pixels[::-1], dtype=np.float32).reshape(-1, pixels.shape[2])
        try:
            found.rect.foreach_set(rows)  # Blender 3.4 expects one row for each pixel
        except TypeError:
            found.rect.foreach_set(rows.reshape(-1))  # later versions expect one flat row of values

    # Submits a job for each pass that the view layer wants, waits for it, and gives its pixels to
    # Blender. `camera`: the message Camera of the scene.
    def add_passes(self, depsgraph, job, result, camera):
        wanted = [entry for entry in PASSES if getattr(depsgraph.view_layer, entry[0], False)]
        jobs = [(entry, job.layer(entry[5])) for entry in wanted]
        for (_, name, channels, _, _, kind), layer in jobs:
            for progress in layer.progress(interval=0.2, patience=PATIENCE, stop=self.test_break):
                self.update_stats("", f"{name}: {progress}")
            if self.test_break():
                for _, submitted in jobs:
                    submitted.cancel()  # has no effect on a job that is done
                raise Stopped()
            self.set_pixels(result, name, pass_pixels(kind, layer.image().array(), camera))


# Returns pixels (height, width, 3) with a fourth channel, alpha, that is 1 everywhere.
def with_alpha(pixels):
    return np.concatenate([pixels, np.ones(pixels.shape[:2] + (1,), dtype=np.float32)], axis=2)


def pass_pixels(kind, pixels, camera):
    """Returns the pixels of a layer of the farm (`kind`: as in PASSES) in the form of Blender's pass. `camera`: the message Camera of the scene."""
    if kind == "normals":
        hit = pixels.any(axis=2, keepdims=True)
        n = np.where(hit, 2 * pixels - 1, 0)
        return np.stack([n[:, :, 0], -n[:, :, 2], n[:, :, 1]], axis=2)  # from y up to z up
    if kind == "depth":
        # The farm's depth is the distance along the ray. Blender's depth is the distance along the
        # camera's axis, and 1e10 if the ray hits nothing.
        depth = pixels[:, :, :1] if "orthographic" in camera else pixels[:, :, :1] / ray_lengths(camera["window"], *pixels.shape[:2])
        return np.where(pixels[:, :, :1] > 0, depth, 1e10)
    return pixels


def ray_lengths(window, height, width):
    """Returns the distances from a perspective camera to the pixels' centres on its `window` (left,
    right, bottom, top), which is at distance 1: an array (height, width, 1), rows from the top."""
    left, right, bottom, top = window
    x = left + (np.arange(width) + 0.5) / width * (right - left)
    y = top - (np.arange(height) + 0.5) / height * (top - bottom)
    return np.sqrt(1 + x[None, :, None] ** 2 + y[:, None, None] ** 2)
