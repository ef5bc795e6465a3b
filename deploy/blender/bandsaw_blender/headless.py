"""Makes a scene folder of a .blend file, for `bandsaw submit FILE.blend`:

    blender -b -Y FILE.blend --python-expr "import sys; sys.path.insert(0, ZIP); from bandsaw_blender import headless; headless.main(FOLDER, NAME, FRAME)"

FRAME is the number of the frame to export. Without FRAME, the frame that is saved in the .blend file is exported. If FRAME is "-", the numbers
of frames are read from standard input, one a line. For each frame, the files of the previous frame are removed from FOLDER, the frame is
exported, and the line "bandsaw: done" is written to standard output.

The export writes the scene file FOLDER/NAME.json, the files to which the scene file refers, and FOLDER/warnings with a line for each thing
that Bandsaw does not show as Blender does. If the export fails, it writes FOLDER/error with one line instead."""

import os
import shutil
import sys
import traceback

import bpy

from . import engine, scene as scenes

_folder, _name = [""], ["scene"]  # FOLDER and NAME of the export in progress, for ExportEngine


class ExportEngine(bpy.types.RenderEngine):
    """Renders nothing, but writes the scene's files. It is a render engine, because only a render
    engine gets a dependency graph in render mode."""

    bl_idname = "BANDSAW_EXPORT"
    bl_label = "Bandsaw (scene files)"

    def render(self, depsgraph):
        # Blender calls this for each view layer, but a scene file holds one: the first.
        layers = [layer.name for layer in depsgraph.scene.view_layers if layer.use]
        if depsgraph.view_layer.name != layers[0]:
            return
        try:
            size = (self.resolution_x, self.resolution_y)
            made = scenes.build(depsgraph, depsgraph.scene, size, engine.region_of(depsgraph.scene.render, size), None, self.frame_set)
            if len(layers) > 1:
                made.warn(f'only the view layer "{layers[0]}" is rendered')
            write(_folder[0], made)
        except Exception as error:
            traceback.print_exc()
            fail(_folder[0], str(error) or type(error).__name__)


# Writes the files and the warnings of a scene.Scene into the folder.
def write(folder, made):
    for name, content in {**made.files, _name[0] + ".json": made.text().encode()}.items():
        if isinstance(content, str):
            shutil.copyfile(content, os.path.join(folder, name))
            continue
        with open(os.path.join(folder, name), "wb") as file:
            file.write(content)
    with open(os.path.join(folder, "warnings"), "w", encoding="utf-8") as file:
        file.writelines(warning.replace("\n", " ") + "\n" for warning in made.warnings)


# Writes the message of an error to FOLDER/error.
def fail(folder, message):
    with open(os.path.join(folder, "error"), "w", encoding="utf-8") as file:
        file.write(message.replace("\n", " ") + "\n")


# Removes the files of the previous frame, but not the add-on, which lies in the same folder.
def remove_results(folder, addon="bandsaw_blender.zip"):
    for name in os.listdir(folder):
        if name != addon:
            os.remove(os.path.join(folder, name))


# Exports one frame or, if `frame` is "-", the frames whose numbers come from standard input.
def main(folder, name="scene", frame=None):
    if frame != "-":
        export(folder, name, frame)
        return
    while True:
        line = sys.stdin.readline()
        if not line:
            return
        remove_results(folder)
        export(folder, name, line)
        os.write(1, b"\nbandsaw: done\n")


# Writes the scene's files by a render with ExportEngine. `frame`: a number as text; None: the
# present frame.
def export(folder, name, frame):
    _folder[0], _name[0] = folder, name
    if not ExportEngine.is_registered:
        bpy.utils.register_class(ExportEngine)
    scene = bpy.context.scene
    scene.render.engine = ExportEngine.bl_idname
    if frame is not None:
        scene.frame_set(int(frame))
    scene.render.use_compositing = scene.render.use_sequencer = scene.render.use_single_layer = False
    if scene.camera is None:
        fail(folder, "the scene has no camera")
    else:
        bpy.ops.render.render(write_still=False)
    sys.stdout.flush()
