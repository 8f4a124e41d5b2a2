"""Mitsuba's XML with 1 for every number of eta and k above it; how many there are goes to standard error.

    mitsuba_clamped.py < IN.xml > OUT.xml
"""

import re
import sys

above = 0


def clamp(number):
    global above
    above += float(number) > 1
    return str(min(float(number), 1))


def numbers(match):
    return f'{match[1]}"{", ".join(map(clamp, match[2].split(",")))}"'


print(re.sub(r'(<rgb name="(?:eta|k)" value=)"([^"]*)"', numbers, sys.stdin.read()))
print(f"{above} numbers are above 1", file=sys.stderr)
