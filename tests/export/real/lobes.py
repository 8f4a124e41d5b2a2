"""The lobes of a material document in slope space, as the errors of `lobefit export` take them."""

import json
import math

LEVEL = 9.0  # squared radius, in widths, that holds 90 % of a GGX lobe's slopes


def of_material(path):
    with open(path, encoding="utf-8") as file:
        rows = json.load(file)["slope_space"]
    return [[row[key] for key in ("slope_x", "slope_y", "slope_alpha_x", "slope_alpha_y", "slope_r")] for row in rows]


def direction(theta_deg, phi_deg):
    theta, phi = math.radians(theta_deg), math.radians(phi_deg)
    return (math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))


def is_within(lobe, wi, wo):
    """Whether the half vector is among those that hold 90 % of the lobe's slopes."""
    x, y, alpha_x, alpha_y, r = lobe
    hx, hy, hz = (a + b for a, b in zip(wi, wo))
    u, v = (-hx / hz - x) / alpha_x, (-hy / hz - y) / alpha_y
    return (u * u - 2 * r * u * v + v * v) / (1 - r * r) <= LEVEL


def normal(lobe, level, psi):
    """The normal at the slope where `level` of the slopes are nearer to the lobe's centre."""
    x, y, alpha_x, alpha_y, r = lobe
    radius = math.sqrt(level / (1 - level))
    u, v = radius * math.cos(psi), radius * math.sin(psi)
    sx, sy = x + alpha_x * u, y + alpha_y * (r * u + math.sqrt(1 - r * r) * v)
    length = math.sqrt(1 + sx * sx + sy * sy)
    return (-sx / length, -sy / length, 1 / length)
