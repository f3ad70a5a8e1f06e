# SPDX-License-Identifier: MIT
# Makes cryptomatte.exr and cryptomatte_mattes.exr:
#   blender --background --factory-startup --python cryptomatte.py -- FOLDER
# Four objects with three materials, out of focus and moving, so that pixels are shared by several of them. The second file holds what
# Blender's own Cryptomatte node makes of the first: the masks to compare with. (Blender 3.4, Debian 12.)
import math
import os
import struct
import sys

import bpy

OBJECTS = {"Suzanne": "Bronze", "Kugel groß": "Glass, red", "Lamp.001": "Bronze", 'The "floor"': "Stone"}
MATTES = {
    "suzanne": ("CryptoObject", ["Suzanne"]),
    "ball": ("CryptoObject", ["Kugel groß"]),
    "two": ("CryptoObject", ["Kugel groß", "Lamp.001"]),
    "bronze": ("CryptoMaterial", ["Bronze"]),
    "floor": ("CryptoObject", ['The "floor"']),
    "red": ("CryptoMaterial", ["Glass, red"]),
    "stone": ("CryptoMaterial", ["Stone"]),
}

folder = sys.argv[sys.argv.index("--") + 1]
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene

materials = {}
for index, name in enumerate(sorted(set(OBJECTS.values()))):
    material = materials[name] = bpy.data.materials.new(name)
    material.use_nodes = True
    color = [(0.6, 0.3, 0.1, 1), (0.7, 0.02, 0.02, 1), (0.3, 0.3, 0.35, 1)][index]
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = color

bpy.ops.mesh.primitive_monkey_add(size=1.6, location=(-1.3, 0, 0.9), rotation=(-0.3, 0, 0.4))
bpy.context.object.name = "Suzanne"
bpy.ops.mesh.primitive_uv_sphere_add(radius=0.8, location=(0.6, -0.6, 0.8))
bpy.context.object.name = "Kugel groß"
bpy.ops.mesh.primitive_cylinder_add(radius=0.12, depth=3, location=(0.1, 0.6, 1.5))
bpy.context.object.name = "Lamp.001"
bpy.ops.mesh.primitive_plane_add(size=7)
bpy.context.object.name = 'The "floor"'
for name, material in OBJECTS.items():
    bpy.data.objects[name].data.materials.append(materials[material])

moving = bpy.data.objects["Kugel groß"]
for frame, x in ((0, 0.3), (2, 0.9)):
    moving.location.x = x
    moving.keyframe_insert("location", frame=frame)

sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
sun.rotation_euler = (0.6, 0.3, 0)
sun.data.energy = 4
scene.collection.objects.link(sun)
camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
camera.location, camera.rotation_euler = (0, -7, 2.6), (math.radians(78), 0, 0)
camera.data.dof.use_dof, camera.data.dof.focus_distance, camera.data.dof.aperture_fstop = True, 6.3, 0.25
scene.collection.objects.link(camera)
scene.camera = camera

scene.frame_set(1)
scene.render.engine = "CYCLES"
scene.render.use_motion_blur = True
scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.seed = 64, False, 1
scene.render.film_transparent = True
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 96, 54, 100
view_layer = scene.view_layers[0]
view_layer.use_pass_cryptomatte_object = view_layer.use_pass_cryptomatte_material = True
view_layer.pass_cryptomatte_depth = 6
settings = scene.render.image_settings
settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR_MULTILAYER", "16", "ZIP"
scene.render.filepath = folder + "/cryptomatte.exr"
bpy.ops.render.render(write_still=True)

def id_of(name):
    # Names beyond ASCII, or with commas and quotes, go by their ids, which the manifest has: the node of Blender 3.4 hashes bytes above
    # 127 as negative ones, and Cycles does not. <float> is how the node takes an id.
    if name.isascii() and not set(name) & set(',"'):
        return name
    with open(folder + "/cryptomatte.exr", "rb") as file:
        data = file.read()
    key = b'"' + name.encode() + b'":"'
    at = data.index(key) + len(key)
    return "<%.9g>" % struct.unpack(">f", bytes.fromhex(data[at : at + 8].decode()))


# The mattes, from the file: composited from what it holds, without rendering again.
image = bpy.data.images.load(folder + "/cryptomatte.exr")
scene.use_nodes = True
tree = scene.node_tree
tree.nodes.clear()
output = tree.nodes.new("CompositorNodeOutputFile")
output.base_path = folder + "/cryptomatte_mattes"
output.format.file_format, output.format.color_depth, output.format.exr_codec = "OPEN_EXR_MULTILAYER", "32", "ZIP"
output.layer_slots.clear()
for name, (layer, members) in MATTES.items():
    node = tree.nodes.new("CompositorNodeCryptomatteV2")
    node.source, node.image, node.layer_name = "IMAGE", image, "ViewLayer." + layer
    node.matte_id = ", ".join(id_of(member) for member in members)
    output.layer_slots.new(name)
    tree.links.new(node.outputs["Matte"], output.inputs[-1])
composite = tree.nodes.new("CompositorNodeComposite")
tree.links.new(tree.nodes[1].outputs["Matte"], composite.inputs["Image"])
bpy.ops.render.render()
os.replace(folder + "/cryptomatte_mattes0001.exr", folder + "/cryptomatte_mattes.exr")
