# Blender's glTF importer and Cycles on an exported file:
#   blender -b --factory-startup --python blender.py -- FILE.gltf OUT.csv
# Small squares of the material lie in many directions before an orthographic camera, under one sun without extent at
# a time: each square is one pair of directions. OUT.csv is a measurement of them: what Cycles shows over the cosine.
# Half of the half vectors are near the normal. The same squares, white and diffuse, say what the sun is worth.
import math
import os
import random
import sys
import tempfile

import bpy
import numpy
from mathutils import Vector

if not hasattr(numpy, "bool"):
    numpy.bool = bool  # the importer of Blender 3.4 asks for it, which newer numpy has no more

SIDE = 24  # squares a side of the picture
PIXELS = 5  # a side of a square's cell
LEAST = math.cos(math.radians(87))
VIEW = Vector((0, 0, 1))
SUNS = [Vector((math.sin(math.radians(a)), 0, math.cos(math.radians(a)))) for a in (4, 20, 40, 60, 80, 100, 120, 140, 160)]


def frame(rng, sun):
    """Axes x, y, z of a square that both directions see."""
    half = (VIEW + sun).normalized()
    near = rng.random() < 0.5
    while True:
        z = Vector([rng.gauss(0, 1) for _ in range(3)]).normalized()
        if near:
            z = (half + 10 ** rng.uniform(-3, -0.3) * z).normalized()
        if z.dot(VIEW) > LEAST and z.dot(sun) > LEAST:
            break
    x, turn = z.orthogonal().normalized(), rng.uniform(0, 2 * math.pi)
    x = math.cos(turn) * x + math.sin(turn) * z.cross(x)
    return x, z.cross(x), z


def squares(frames, material):
    vertices, uvs = [], []
    for k, (x, y, z) in enumerate(frames):
        centre = Vector((k % SIDE + 0.5 - SIDE / 2, k // SIDE + 0.5 - SIDE / 2, 0))
        across = VIEW.cross(z)
        across = across.normalized() if across.length > 1e-6 else x
        along = z.cross(across) / z.dot(VIEW)  # a square as the camera sees it
        for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            vertex = 0.4 * (a * across + b * along)
            vertices.append(centre + vertex)
            uvs.append((vertex.dot(x), vertex.dot(y)))
    mesh = bpy.data.meshes.new("squares")
    mesh.from_pydata(vertices, [], [range(4 * k, 4 * k + 4) for k in range(len(frames))])
    layer = mesh.uv_layers.new(name="UVMap")
    for loop, uv in zip(layer.data, uvs):
        loop.uv = uv
    mesh.materials.append(material)
    thing = bpy.data.objects.new("squares", mesh)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def shown(frames, material, folder):
    """R, G, B at the middle of each square."""
    thing = squares(frames, material)
    bpy.context.scene.render.filepath = os.path.join(folder, "picture.exr")
    bpy.ops.render.render(write_still=True)
    bpy.data.objects.remove(thing)
    picture = bpy.data.images.load(os.path.join(folder, "picture.exr"))
    pixels = numpy.array(picture.pixels[:]).reshape(SIDE * PIXELS, SIDE * PIXELS, -1)
    bpy.data.images.remove(picture)
    middle = PIXELS // 2
    return pixels[middle::PIXELS, middle::PIXELS, :3].reshape(-1, 3)


def white():
    material = bpy.data.materials.new("white")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    diffuse.inputs["Color"].default_value = (1, 1, 1, 1)
    material.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    return material


def set_up():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.max_bounces, scene.cycles.use_denoising = 1, 0, False
    scene.cycles.use_adaptive_sampling, scene.cycles.pixel_filter_type = False, "BOX"
    # Without the threshold dim light is not dropped at random.
    scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = scene.cycles.light_sampling_threshold = 0
    scene.render.resolution_x = scene.render.resolution_y = SIDE * PIXELS
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale, camera.data.clip_end = "ORTHO", SIDE, 200
    camera.location = (0, 0, 100)
    light = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    light.data.angle, light.data.energy, light.data.cycles.cast_shadow = 0, 1, False
    light.rotation_mode = "QUATERNION"
    for thing in (camera, light):
        scene.collection.objects.link(thing)
    scene.camera = camera
    return light


def polar(direction, axes):
    x, y, z = (direction.dot(axis) for axis in axes)
    return math.degrees(math.acos(min(z, 1))), math.degrees(math.atan2(y, x)) % 360


def main(path, out):
    light, rng = set_up(), random.Random(1)
    before = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=os.path.abspath(path))
    swatch = [thing for thing in bpy.data.objects if thing not in before]
    material = next(thing.data.materials[0] for thing in swatch if thing.type == "MESH")
    for thing in swatch:
        bpy.data.objects.remove(thing)
    reference = white()
    with tempfile.TemporaryDirectory() as folder, open(out, "w") as rows:
        rows.write("theta_i,phi_i,theta_o,phi_o,R,G,B\n")
        for sun in SUNS:
            light.rotation_quaternion = sun.to_track_quat("Z", "Y")
            frames = [frame(rng, sun) for _ in range(SIDE * SIDE)]
            of_material, of_white = shown(frames, material, folder), shown(frames, reference, folder)
            for axes, rgb, one in zip(frames, of_material, of_white):
                values = [f"{value / (math.pi * white_value):.9g}" for value, white_value in zip(rgb, one)]
                angles = [f"{angle:.9g}" for angle in polar(sun, axes) + polar(VIEW, axes)]
                rows.write(",".join(angles + values) + "\n")


main(*sys.argv[sys.argv.index("--") + 1 :])
