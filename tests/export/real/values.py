"""A measurement of the fit beside what a program shows at its rows."""

import math
import sys

FLOOR = 1e-4 / math.pi  # of a relative error, as the export has it


def numbers(line, separator=None):
    return [float(field) for field in line.split(separator)]


def quantile(values, share):
    return sorted(values)[min(int(share * len(values)), len(values) - 1)]


def read(fit, values):
    """Rows of the CSV file `fit` (four angles, then a value a channel), and R G B of each from `values`."""
    with open(fit, encoding="utf-8") as file:
        rows = [numbers(line, ",") for line in file if line[:1].isdigit()]
    with open(values, encoding="utf-8") as file:
        shown = [numbers(line) for line in file]
    if len(shown) != len(rows):
        sys.exit(f"{len(shown)} values for {len(rows)} rows")
    return rows, shown


def pairs(row, rgb):
    """(reference, shown) of each channel; a grey reference stands for all three."""
    return zip(row[4:7] if len(row) > 6 else [row[4]] * 3, rgb)


def relative(reference, shown):
    return abs(shown - reference) / max(abs(reference), FLOOR)
