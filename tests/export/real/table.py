"""What a program shows over the fit's f_r, in the lobe and off it, by the polar angle of the viewer:

    table.py MATERIAL.material.json FIT.csv VALUES [EXPORT.json TARGET]

FIT.csv is a measurement of the fit; VALUES has R G B of the program, a line for each of its rows. With EXPORT.json the
error is set beside the one that the export states.
"""

import json
import math
import sys

import lobes

BANDS = ((0, 60), (60, 80), (80, 84), (84, 88.01))
FLOOR = 1e-4 / math.pi  # of a relative error, as the export has it


def numbers(line, separator=None):
    return [float(field) for field in line.split(separator)]


def quantile(values, share):
    return sorted(values)[min(int(share * len(values)), len(values) - 1)]


def read(fit, values):
    with open(fit, encoding="utf-8") as file:
        rows = [numbers(line, ",") for line in file if line[:1].isdigit()]
    with open(values, encoding="utf-8") as file:
        shown = [numbers(line) for line in file]
    if len(shown) != len(rows):
        sys.exit(f"{len(shown)} values for {len(rows)} rows")
    return rows, shown


def main(material, fit, values, report=None, target=None):
    shapes, (rows, shown) = lobes.of_material(material), read(fit, values)
    ratios, errors = {}, {True: [], False: []}
    for row, rgb in zip(rows, shown):
        wi, wo = lobes.direction(*row[:2]), lobes.direction(*row[2:4])
        inside = any(lobes.is_within(shape, wi, wo) for shape in shapes)
        band = next(k for k, (low, high) in enumerate(BANDS) if low <= row[2] < high)
        fitted = row[4:7] if len(row) > 6 else [row[4]] * 3
        for one, reference in zip(rgb, fitted):
            errors[inside].append(abs(one - reference) / max(abs(reference), FLOOR))
            if reference > FLOOR:
                ratios.setdefault((not inside, band), []).append(one / reference)
    print("          viewer   values     1 %    10 %    50 %    90 %    99 %")
    for (off, band), found in sorted(ratios.items()):
        levels = "".join(f" {quantile(found, share):7.3f}" for share in (0.01, 0.1, 0.5, 0.9, 0.99))
        print(f"{'off ' if off else 'lobe'} {BANDS[band][0]:5.0f} to {BANDS[band][1]:2.0f} {len(found):8d} {levels}")
    stated = {}
    if report:
        with open(report, encoding="utf-8") as file:
            stated = next(row for row in json.load(file)["targets"] if row["target"] == target)["relative_error"]
    for inside, name, key in ((True, "lobe", "in_lobe"), (False, "off", "off_lobe")):
        if not errors[inside]:
            continue
        found = [quantile(errors[inside], share) for share in (0.5, 0.9)]
        text = f"error, {name}: median {found[0]:.2%}, 90 % {found[1]:.2%}"
        if stated and stated[key]["median"] is not None:
            text += f"; stated {stated[key]['median']:.2%}, {stated[key]['percentile_90']:.2%}"
        print(text)


main(*sys.argv[1:])
