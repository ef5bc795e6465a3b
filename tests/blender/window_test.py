"""In Blender's window: prepares a scene, and tells in a file what has happened at the coordinator: ready, quarter, half, cancelled."""

import os
import sys
import threading
import time

import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
sys.dont_write_bytecode = True
sys.path[:0] = [HERE, os.path.join(HERE, "..", "python")]
import fake_farm  # noqa: E402
import scenes  # noqa: E402

addon, state = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.preferences.addon_install(filepath=addon)
scenes.build("gradient")
bpy.ops.preferences.addon_enable(module="bandsaw_blender")
fake = fake_farm.FakeFarm(12)
bpy.context.preferences.addons["bandsaw_blender"].preferences.farm = fake.string
bpy.context.preferences.view.render_display_type = "SCREEN"
made = bpy.context.scene
made.render.engine = "BANDSAW"
made.render.resolution_x, made.render.resolution_y = 600, 400


def tell(word):
    with open(state, "a") as file:
        file.write(word + "\n")


def watch():
    for share, word in ((0.25, "quarter"), (0.5, "half")):
        while not any(fake.fraction(job) >= share and job["looks"] > 1 for job in list(fake.jobs.values())):
            time.sleep(0.05)
        time.sleep(1)  # the next preview reaches the window
        tell(word)
    while not any(job["state"] == "cancelled" for job in list(fake.jobs.values())):
        time.sleep(0.05)
    tell("cancelled")


threading.Thread(target=watch, daemon=True).start()
bpy.app.timers.register(lambda: tell("ready"), first_interval=2)
