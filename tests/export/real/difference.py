"""The relative difference between a measurement and what a program shows at its rows, over all channels:

    difference.py FIT.csv VALUES
"""

import sys

import values


def main(fit, shown):
    found = [values.relative(*pair) for row, rgb in zip(*values.read(fit, shown)) for pair in values.pairs(row, rgb)]
    levels = ", ".join(f"{name} {values.quantile(found, share):.1e}"
                       for name, share in (("median", 0.5), ("90 %", 0.9), ("99 %", 0.99), ("largest", 1)))
    print(f"relative difference of {len(found)} values: {levels}")


main(*sys.argv[1:])
