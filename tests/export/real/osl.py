"""Two shaders that evaluate an exported one at rows of directions, one a point of testshade's grid of N x 1:

    osl.py OUT_FOLDER < rows

Each row begins with theta_i, phi_i, theta_o, phi_o in degrees. rows.osl gives wi and wo, show.osl prints the place of
the row and f_r. Prints N.
"""

import sys

import lobes

ROWS = """shader rows(vector light[{count}] = {{ {light} }}, vector viewer[{count}] = {{ {viewer} }},
            output vector wi = 0, output vector wo = 0) {{
  int k = int(u * {last} + 0.5);
  wi = light[k];
  wo = viewer[k];
}}
"""
SHOW = """shader show(color f_r = 0) {{
  printf("row %d %.9g %.9g %.9g\\n", int(u * {last} + 0.5), f_r[0], f_r[1], f_r[2]);
}}
"""


def main(folder):
    angles = [[float(field) for field in line.split()[:4]] for line in sys.stdin]
    light, viewer = (
        ", ".join("vector({:.9g}, {:.9g}, {:.9g})".format(*lobes.direction(*row[k : k + 2])) for row in angles)
        for k in (0, 2)
    )
    count = {"count": len(angles), "last": len(angles) - 1}
    with open(f"{folder}/rows.osl", "w", encoding="utf-8") as file:
        file.write(ROWS.format(**count, light=light, viewer=viewer))
    with open(f"{folder}/show.osl", "w", encoding="utf-8") as file:
        file.write(SHOW.format(**count))
    print(len(angles))


main(sys.argv[1])
