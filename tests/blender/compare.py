"""Renders scenes of scenes.py by Cycles or by the add-on, or exports them. judge.sh compares the
images. If no SCENE is given, all scenes are used.

    blender -b --factory-startup --python compare.py -- ADDON.zip FOLDER cycles|bandsaw|export SCENE…

`cycles` and `bandsaw` write FOLDER/SCENE.ENGINE.exr and .png. `bandsaw` renders on the farm whose join
string is in BANDSAW_FARM. `export` writes the scene's files to FOLDER/SCENE/."""

import os
import sys

import bpy

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scenes  # noqa: E402

CYCLES_SAMPLES = 512
BANDSAW_SAMPLES = 256


def set_cycles(made):
    """Selects Cycles for the scene `made`, without the settings that change the expected image."""
    made.render.engine = "CYCLES"
    cycles = made.cycles
    cycles.device, cycles.samples = "CPU", CYCLES_SAMPLES
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.light_sampling_threshold = cycles.blur_glossy = 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    for kind in ("max", "diffuse", "glossy", "transmission", "volume", "transparent_max"):
        setattr(cycles, kind + "_bounces", 32)


def main():
    addon, folder, engine, *names = sys.argv[sys.argv.index("--") + 1:]
    sys.path.insert(0, addon)
    for name in names or scenes.SCENES:
        scenes.build(name)
        made = bpy.context.scene
        made.render.image_settings.file_format = "OPEN_EXR"
        made.render.image_settings.color_depth = "32"
        made.render.filepath = os.path.join(folder, f"{name}.{engine}.exr")
        if engine == "export":
            from bandsaw_blender import headless
            os.makedirs(os.path.join(folder, name), exist_ok=True)
            headless.main(os.path.join(folder, name))
            continue
        if engine == "cycles":
            set_cycles(made)
        else:
            import bandsaw_blender
            if not hasattr(bpy.types.Scene, "bandsaw"):
                bandsaw_blender.register()
            made.render.engine = "BANDSAW"
            made.bandsaw.samples = BANDSAW_SAMPLES
            made.bandsaw.denoise = False
        bpy.ops.render.render(write_still=True)
        made.render.image_settings.file_format = "PNG"
        made.render.image_settings.color_depth = "8"
        bpy.data.images["Render Result"].save_render(made.render.filepath[:-3] + "png", scene=made)


main()
