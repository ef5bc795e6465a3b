"""Saves a scene of scenes.py as a .blend file: blender -b --factory-startup --python save.py -- FILE SCENE"""

import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scenes  # noqa: E402

path, name = sys.argv[sys.argv.index("--") + 1:]
scenes.build(name)
bpy.ops.wm.save_as_mainfile(filepath=path)
