#!/usr/bin/env python3
"""parse_strictly.py FOLDER: reads every file of the folder as the strictest program would that is to take it.

JSON, glTF, XML, MaterialX, Python, CSV and HTML must be UTF-8 and well-formed, and a page must have no element or
attribute that a name of the measurement brought into it. Prints one line a fault; the exit code says whether there is one.
"""
import ast
import csv
import html.parser
import json
import pathlib
import sys
import xml.dom.minidom


class Elements(html.parser.HTMLParser):
    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name.startswith("on") or (value or "").strip().lower().startswith("javascript:"):
                raise ValueError(f"<{tag}> has {name}={value!r}")


def check_csv(text):
    rows = [row for row in csv.reader(line for line in text.splitlines() if not line.startswith("#"))]
    if len({len(row) for row in rows}) > 1:
        raise ValueError("rows of several lengths")


CHECKS = {
    ".json": json.loads,
    ".gltf": json.loads,
    ".xml": lambda text: xml.dom.minidom.parseString(text.encode()),
    ".mtlx": lambda text: xml.dom.minidom.parseString(text.encode()),
    ".py": ast.parse,
    ".csv": check_csv,
    ".html": lambda text: Elements().feed(text),
    ".pbrt": lambda text: None,
    ".glsl": lambda text: None,
    ".osl": lambda text: None,
}

faults = 0
checked = 0
for path in sorted(pathlib.Path(sys.argv[1]).rglob("*")):
    check = CHECKS.get(path.suffix)
    if check is None or not path.is_file():
        continue
    checked += 1
    try:
        check(path.read_bytes().decode())
    except Exception as error:  # whatever a parser throws is a fault of the file
        faults += 1
        print(f"{str(path).encode('utf-8', 'replace')}: {error}")
print(f"{checked} files")
sys.exit(1 if faults else 0)
