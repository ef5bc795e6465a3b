"""The part of a test of the add-on that runs inside Blender, in the window that window.sh opens.

This script prepares a scene and a fake farm. window.sh then presses F12, which starts a render.
While the farm renders, the picture in the window must grow. At the end window.sh presses Escape,
which must cancel the job at the farm. This script tells window.sh what has happened by appending
words to the file `state`: "ready" (Blender accepts keys), "looked" (Blender has been given a
preview), "cancelled" (the job is cancelled)."""

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
fake = fake_farm.FakeFarm(120)  # a render takes 120 seconds
bpy.context.preferences.addons["bandsaw_blender"].preferences.farm = fake.string
bpy.context.preferences.view.render_display_type = "SCREEN"
bpy.context.preferences.view.show_splash = False  # the splash screen would receive the keys
made = bpy.context.scene
made.render.engine = "BANDSAW"
made.render.resolution_x, made.render.resolution_y = 600, 400


def tell(word):
    with open(state, "a") as file:
        file.write(word + "\n")


def wait_for(holds):
    while not holds():
        time.sleep(0.05)


def watch():
    # The add-on requests the next preview only after it has given the last one to Blender. So when the second request arrives, Blender has
    # the first preview.
    wait_for(lambda: sum(job["looks"] for job in list(fake.jobs.values())) >= 2)
    tell("looked")
    wait_for(lambda: any(job["state"] == "cancelled" for job in list(fake.jobs.values())))
    tell("cancelled")


threading.Thread(target=watch, daemon=True).start()
bpy.app.timers.register(lambda: tell("ready"), first_interval=2)
