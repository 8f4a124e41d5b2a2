"""Pairs of directions to 88 degrees, in the proportions by which `lobefit export` takes its errors: three uniform over
the solid angle for one in each lobe of the material.

    rows.py MATERIAL.material.json > OUT.csv
"""

import math
import random
import sys

import lobes

ROWS = 4000  # of a material with one lobe
LEAST = math.cos(math.radians(88))


def uniform(rng):
    z, phi = 1 - rng.random() * (1 - LEAST), 2 * math.pi * rng.random()
    s = math.sqrt(1 - z * z)
    return (s * math.cos(phi), s * math.sin(phi), z)


def reflected(wi, m):
    d = sum(a * b for a, b in zip(wi, m))
    return tuple(2 * d * b - a for a, b in zip(wi, m)) if d > 0 else (0, 0, -1)


def angles(w):
    return f"{math.degrees(math.acos(min(w[2], 1))):.9g},{math.degrees(math.atan2(w[1], w[0])):.9g}"


def main(path):
    rng, shapes = random.Random(1), lobes.of_material(path)
    print("theta_i,phi_i,theta_o,phi_o,R,G,B")
    parts = 3 + len(shapes)
    for k in range(ROWS // 4 * parts):
        while True:
            wi = uniform(rng)
            if k % parts < 3:
                wo = uniform(rng)
                break
            shape = shapes[k % parts - 3]
            wo = reflected(wi, lobes.normal(shape, 0.9 * rng.random(), 2 * math.pi * rng.random()))
            if wo[2] >= LEAST:
                break
        print(f"{angles(wi)},{angles(wo)},0,0,0")


main(sys.argv[1])
