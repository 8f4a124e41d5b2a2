"""The scene XML that says what an exported dictionary for `mi.load_dict` says, so that Mitsuba without Python shows it:

    mitsuba_dict.py NAME.mitsuba.py > OUT.xml

mi and numpy, which the file's function takes, are stood in for: a bitmap of one pixel is the colour of it.
"""

import runpy
import sys
import types
from xml.sax.saxutils import quoteattr

TEXTURES = ("bitmap",)


def attributes(**values):
    return "".join(f" {name}={quoteattr(str(value))}" for name, value in values.items())


def element(name, value):
    if isinstance(value, dict) and "bitmap" in value:
        return f"<rgb{attributes(name=name, value=', '.join(map(repr, value['bitmap'])))}/>"
    if isinstance(value, dict) and value["type"] in ("rgb", "spectrum"):
        numbers = (f"{v[0]}:{v[1]}" if isinstance(v, tuple) else repr(v) for v in value["value"])
        return f"<{value['type']}{attributes(name=name, value=', '.join(numbers))}/>"
    if isinstance(value, dict):
        tag = "texture" if value["type"] in TEXTURES else "bsdf"
        inner = "".join(element(key, each) for key, each in value.items() if key != "type")
        return f"<{tag}{attributes(type=value['type'], name=name)}>{inner}</{tag}>"
    if isinstance(value, bool):
        return f"<boolean{attributes(name=name, value=str(value).lower())}/>"
    return f"<{'string' if isinstance(value, str) else 'float'}{attributes(name=name, value=value)}/>"


def main(path):
    mi = types.SimpleNamespace(__version__="3.7.1", Bitmap=lambda pixels: list(pixels[0][0]))
    np = types.SimpleNamespace(array=lambda values, dtype: values, float32=None)
    bsdf = element("bsdf", runpy.run_path(path)["material"](mi, np))
    print(f'<scene version="3.0.0"><shape type="rectangle">{bsdf}</shape></scene>')


main(sys.argv[1])
