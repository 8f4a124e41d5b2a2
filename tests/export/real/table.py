"""What a program shows over the fit's f_r, in the lobe and off it, by the polar angle of the viewer:

    table.py MATERIAL.material.json FIT.csv VALUES [EXPORT.json TARGET]

FIT.csv is a measurement of the fit; VALUES has R G B of the program, a line for each of its rows. With EXPORT.json the
error is set beside the one that the export states.
"""

import json
import sys

import lobes
import values

BANDS = ((0, 60), (60, 80), (80, 84), (84, 88.01))


def main(material, fit, shown, report=None, target=None):
    shapes, (rows, shown) = lobes.of_material(material), values.read(fit, shown)
    ratios, errors = {}, {True: [], False: []}
    for row, rgb in zip(rows, shown):
        wi, wo = lobes.direction(*row[:2]), lobes.direction(*row[2:4])
        inside = any(lobes.is_within(shape, wi, wo) for shape in shapes)
        band = next(k for k, (low, high) in enumerate(BANDS) if low <= row[2] < high)
        for reference, one in values.pairs(row, rgb):
            errors[inside].append(values.relative(reference, one))
            if reference > values.FLOOR:
                ratios.setdefault((not inside, band), []).append(one / reference)
    print("          viewer   values     1 %    10 %    50 %    90 %    99 %")
    for (off, band), found in sorted(ratios.items()):
        levels = "".join(f" {values.quantile(found, share):7.3f}" for share in (0.01, 0.1, 0.5, 0.9, 0.99))
        print(f"{'off ' if off else 'lobe'} {BANDS[band][0]:5.0f} to {BANDS[band][1]:2.0f} {len(found):8d} {levels}")
    stated = {}
    if report:
        with open(report, encoding="utf-8") as file:
            stated = next(row for row in json.load(file)["targets"] if row["target"] == target)["relative_error"]
    for inside, name, key in ((True, "lobe", "in_lobe"), (False, "off", "off_lobe")):
        if not errors[inside]:
            continue
        found = [values.quantile(errors[inside], share) for share in (0.5, 0.9)]
        text = f"error, {name}: median {found[0]:.2%}, 90 % {found[1]:.2%}"
        if stated and stated[key]["median"] is not None:
            text += f"; stated {stated[key]['median']:.2%}, {stated[key]['percentile_90']:.2%}"
        print(text)


main(*sys.argv[1:])
