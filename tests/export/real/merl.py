"""The value that a reader of the MERL database looks up, the cell's that a pair of directions falls in:

    merl.py FILE.binary < rows

Each row begins with theta_i, phi_i, theta_o, phi_o in degrees. Prints f_r, R G B, one line a row. The file: three int32
(90 cells of theta_half, 90 of theta_diff, 180 of phi_diff), then doubles, R before G before B, theta_half slowest.
theta_half goes by its square root, phi_diff to 180 degrees; values are in units of 1/1500, 1.15/1500, 1.66/1500.
"""

import array
import math
import sys

import lobes

HALF, DIFF, AZIMUTH = 90, 90, 180
UNITS = (1 / 1500, 1.15 / 1500, 1.66 / 1500)


def read(path):
    with open(path, "rb") as file:
        sizes, cells = array.array("i"), array.array("d")
        sizes.fromfile(file, 3)
        if list(sizes) != [HALF, DIFF, AZIMUTH]:
            sys.exit(f"a table of {list(sizes)}")
        cells.fromfile(file, 3 * HALF * DIFF * AZIMUTH)
    return cells


def cell(wi, wo):
    half = [a + b for a, b in zip(wi, wo)]
    length = math.sqrt(sum(x * x for x in half))
    half = [x / length for x in half]
    sine = math.hypot(half[0], half[1])
    cos_phi, sin_phi = (half[0] / sine, half[1] / sine) if sine > 0 else (1, 0)
    # The light in the frame where the half vector is the pole: turned back by its azimuth, then by its polar angle.
    x, y = cos_phi * wi[0] + sin_phi * wi[1], cos_phi * wi[1] - sin_phi * wi[0]
    x, z = half[2] * x - sine * wi[2], sine * x + half[2] * wi[2]
    theta_half, theta_diff, phi_diff = math.atan2(sine, half[2]), math.atan2(math.hypot(x, y), z), math.atan2(y, x)
    right = math.pi / 2
    return (
        min(int(HALF * math.sqrt(theta_half / right)), HALF - 1),
        min(int(DIFF * theta_diff / right), DIFF - 1),
        min(int(AZIMUTH * (phi_diff % math.pi) / math.pi), AZIMUTH - 1),
    )


def main(path):
    cells = read(path)
    for line in sys.stdin:
        theta_i, phi_i, theta_o, phi_o = (float(field) for field in line.split()[:4])
        half, diff, azimuth = cell(lobes.direction(theta_i, phi_i), lobes.direction(theta_o, phi_o))
        place = (half * DIFF + diff) * AZIMUTH + azimuth
        print(*(f"{unit * cells[k * HALF * DIFF * AZIMUTH + place]:.9g}" for k, unit in enumerate(UNITS)))


main(sys.argv[1])
