"""The Blender add-on of Bandsaw, a render farm. This file has the add-on's preferences, settings and panels, and registers the add-on. The
rendering is in engine.py."""

bl_info = {
    "name": "Bandsaw", "description": "Renders on all machines of a Bandsaw farm", "author": "Bandsaw", "version": (0, 1, 0), "blender": (3, 4, 0),
    "location": "Render Engine > Bandsaw", "category": "Render",
}

import bpy  # noqa: E402

from . import bandsaw, engine  # noqa: E402


class BandsawPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    farm: bpy.props.StringProperty(
        name="Farm", subtype="PASSWORD",
        description="The users' join string (bsw1-f-…): the line in the file `farm` of the coordinator's data folder, or the name of a file that contains the string")
    web: bpy.props.StringProperty(
        name="Dashboard", description="HOST:PORT of the coordinator's dashboard. Empty: the address in the farm's string")

    def draw(self, context):
        column = self.layout.column()
        column.prop(self, "farm")
        column.prop(self, "web")
        column.operator(BANDSAW_OT_check.bl_idname)


class BANDSAW_OT_check(bpy.types.Operator):
    """Asks the farm for its version and its workers"""

    bl_idname = "bandsaw.check_farm"
    bl_label = "Check the Farm"

    def execute(self, context):
        try:
            kept = engine.preferences()
            farm = bandsaw.Farm(engine.farm_string(), web=(kept.web.strip() or None) if kept is not None else None)
            version, workers = farm.check(), farm.workers()
        except bandsaw.BandsawError as error:
            self.report({"ERROR"}, f"Bandsaw: {error}")
            return {"CANCELLED"}
        self.report({"INFO"}, f"Bandsaw {version}: the farm answers; workers: {', '.join(worker['name'] for worker in workers) or 'none'}")
        return {"FINISHED"}


class BandsawSettings(bpy.types.PropertyGroup):
    stop: bpy.props.EnumProperty(
        name="Until", items=(("SAMPLES", "Samples", "A number of samples for each pixel"), ("ERROR", "Error", "The image has at most this error")))
    samples: bpy.props.IntProperty(name="Samples", default=64, min=1, max=1 << 30, description="Samples for each pixel")
    error: bpy.props.FloatProperty(name="Error", default=2.0, min=0.01, max=100.0, subtype="PERCENTAGE", description="Error of the image in percent, before it is denoised")
    denoise: bpy.props.BoolProperty(
        name="Denoise", default=True,
        description="Remove the noise of the finished image. The image as rendered is kept in the pass Noisy Image, and the estimated errors of both images are reported")
    pass_samples: bpy.props.BoolProperty(
        name="Sample Count Pass", description="Add the pass Debug Sample Count: the number of samples of each pixel, which is the same for all pixels")


class BANDSAW_PT_sampling(bpy.types.Panel):
    bl_label = "Bandsaw"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {"BANDSAW"}

    @classmethod
    def poll(cls, context):
        return context.engine == "BANDSAW"

    def draw(self, context):
        layout, settings = self.layout, context.scene.bandsaw
        layout.use_property_split = True
        layout.prop(settings, "stop")
        layout.prop(settings, "samples" if settings.stop == "SAMPLES" else "error")
        layout.prop(settings, "denoise")
        layout.prop(settings, "pass_samples")
        layout.prop(context.scene.render, "film_transparent")
        layout.prop(context.scene.render, "use_motion_blur")
        layout.prop(context.scene.render, "motion_blur_shutter")
        if not engine.farm_string():
            layout.label(text="Paste the farm's string in the add-on's preferences", icon="ERROR")
        layout.operator(BANDSAW_OT_check.bl_idname)


# Lists the warnings of the last render: the things that Bandsaw does not show as Blender does.
class BANDSAW_PT_omitted(bpy.types.Panel):
    bl_label = "Not Shown as in Blender"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {"BANDSAW"}

    @classmethod
    def poll(cls, context):
        return context.engine == "BANDSAW" and bool(engine.last_warnings)

    def draw(self, context):
        for warning in engine.last_warnings:
            for number, line in enumerate(_lines(warning, 60)):
                self.layout.label(text=line, icon="INFO" if number == 0 else "BLANK1")


# Yields the words of a text as lines of at most `width` characters.
def _lines(text, width):
    words, line = text.split(), ""
    for word in words:
        if line and len(line) + 1 + len(word) > width:
            yield line
            line = word
        else:
            line = f"{line} {word}".strip()
    yield line


def compatible_panels():
    """Returns Blender's own panels that this engine uses: those of materials, lights, the world,
    cameras and output."""
    left_out = {"RENDER_PT_eevee_sampling", "VIEWLAYER_PT_filter", "RENDER_PT_simplify", "RENDER_PT_freestyle", "VIEWLAYER_PT_layer_passes"}
    return [panel for panel in bpy.types.Panel.__subclasses__()
            if "BLENDER_RENDER" in getattr(panel, "COMPAT_ENGINES", ()) and panel.__name__ not in left_out]


def eevee_panels():
    """Returns the panels of EEVEE and Cycles whose settings this engine uses too: a material's
    surface, a light's power, the world's nodes, and passes."""
    names = {"EEVEE_MATERIAL_PT_surface", "EEVEE_MATERIAL_PT_volume", "EEVEE_MATERIAL_PT_context_material", "DATA_PT_EEVEE_light", "EEVEE_WORLD_PT_surface",
             "EEVEE_WORLD_PT_volume", "DATA_PT_light", "DATA_PT_spot", "DATA_PT_camera_dof", "VIEWLAYER_PT_eevee_layer_passes_data"}
    return [panel for panel in bpy.types.Panel.__subclasses__() if panel.__name__ in names and hasattr(panel, "COMPAT_ENGINES")]


CLASSES = (BANDSAW_OT_check, BandsawPreferences, BandsawSettings, BANDSAW_PT_sampling, BANDSAW_PT_omitted, engine.BandsawEngine)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.bandsaw = bpy.props.PointerProperty(type=BandsawSettings)
    for panel in compatible_panels() + eevee_panels():
        panel.COMPAT_ENGINES.add("BANDSAW")


def unregister():
    for panel in compatible_panels() + eevee_panels():
        panel.COMPAT_ENGINES.discard("BANDSAW")
    del bpy.types.Scene.bandsaw
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
