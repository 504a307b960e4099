#!/usr/bin/env python3
"""Checks that includes follow the arrows: who may include whom, and where a third-party header may appear.

  layering.py check ROOT       exits 1 and names every include against the arrows
  layering.py self-test ROOT   exits 1 if the check does not notice wrong includes
"""
import pathlib
import re
import sys
import tempfile

BELOW_BLEND = ["field/base", "field/math", "field/number", "field/description", "field/kernel", "field/skeleton"]
BELOW_TRACE = BELOW_BLEND + ["field/blend", "field/tree", "field/program"]
BELOW_APP = ["field", "materials", "renderer/output", "renderer/slice", "renderer/scene", "renderer/geometry",
             "renderer/transport", "renderer/bench"]

# A folder may include the folders named here and itself, with all in it that may not include the folder. A trailing file
# name opens that file only.
ARROWS = {
    "field/base": [],
    "field/math": ["field/base"],
    "field/number": ["field/base", "field/math"],
    "field/description": ["field/base", "field/math"],
    "field/kernel": ["field/base", "field/math", "field/description"],
    "field/skeleton": ["field/base", "field/math", "field/number", "field/description", "field/kernel"],
    "field/blend/correction": BELOW_BLEND,
    "field/blend/angle": BELOW_BLEND + ["field/blend/correction"],
    "field/blend/sources": BELOW_BLEND,
    "field/blend": BELOW_BLEND,
    "field/blend/bounds/sum": BELOW_BLEND + ["field/blend/blend_field.h", "field/blend/primitive_bounds.h",
                                             "field/blend/primitive_visit.h", "field/blend/sources"],
    "field/blend/bounds/correction": BELOW_BLEND + ["field/blend/blend_field.h", "field/blend/correction"],
    "field/blend/bounds/angle": BELOW_BLEND + ["field/blend/angle", "field/blend/blend_field.h",
                                               "field/blend/gather.h", "field/blend/primitive_bounds.h",
                                               "field/blend/primitive_visit.h", "field/blend/radius_marks.h",
                                               "field/blend/bounds/sum"],
    "field/blend/bounds": BELOW_BLEND + ["field/blend/correction", "field/blend/blend_field.h"],
    "field/blend/local": BELOW_BLEND + ["field/blend/correction", "field/blend/blend_field.h",
                                        "field/blend/primitive_visit.h", "field/blend/radius_marks.h",
                                        "field/blend/angle", "field/blend/sources", "field/blend/bounds"],
    "field/tree": BELOW_BLEND + ["field/blend"],
    "field/program": BELOW_BLEND + ["field/blend", "field/tree"],
    "field/trace/curve": BELOW_TRACE,
    "field/trace/kernels": BELOW_TRACE + ["field/trace/curve"],
    "field/trace/sources": BELOW_TRACE + ["field/trace/kernels"],
    "field/trace/levels": BELOW_TRACE + ["field/trace/kernels", "field/trace/sources"],
    "field/trace/shares": BELOW_TRACE + ["field/trace/kernels", "field/trace/sources", "field/trace/levels"],
    "field/trace/cells": BELOW_TRACE + ["field/trace/curve", "field/trace/kernels", "field/trace/sources",
                                        "field/trace/levels", "field/trace/shares"],
    "field/trace": BELOW_TRACE,
    "field/trace/general": BELOW_TRACE + ["field/trace/cells", "field/trace/blend_tracer.h"],
    "materials": ["field/base", "field/math"],
    "renderer/output": ["field/base", "field/math"],
    "renderer/slice": ["field/base", "field/math", "renderer/output"],
    "renderer/scene": ["field/base", "field/math", "field/description", "field/number", "field/kernel/inverse_family.h",
                       "field/tree/any_node.h", "field/tree/node_info.h",
                       "field/skeleton/curve_graph.h", "materials"],
    "renderer/geometry": ["field", "materials/rgb.h", "renderer/scene/scene_description.h"],
    "renderer/transport": ["field/base", "field/math", "materials", "renderer/scene/scene_description.h",
                           "renderer/geometry/surfaces.h", "renderer/output"],
    "renderer/bench": ["field", "renderer/scene", "renderer/geometry", "renderer/transport"],
    "renderer/app/text": BELOW_APP,
    "renderer/app/command_line": BELOW_APP + ["renderer/app/text"],
    "renderer/app/machine": BELOW_APP + ["renderer/app/command_line"],
    "renderer/app/report": BELOW_APP + ["renderer/app/text", "renderer/app/command_line"],
    "renderer/app/input": BELOW_APP + ["renderer/app/text", "renderer/app/command_line", "renderer/app/report"],
    "renderer/app/picture": BELOW_APP + ["renderer/app/command_line", "renderer/app/report", "renderer/app/input"],
    "renderer/app/commands": BELOW_APP + ["renderer/app/text", "renderer/app/command_line", "renderer/app/machine",
                                          "renderer/app/report", "renderer/app/input", "renderer/app/picture"],
    "renderer/app": BELOW_APP,
    "tests": ["field", "materials", "renderer"],
}

# A library's headers appear only where the library is adapted.
LIBRARIES = {
    r"embree3/": ["renderer/geometry/", "renderer/bench/embree_engine.cpp"],
    r"(tbb|oneapi)/": ["field/trace/", "renderer/"],
    r"(OpenEXR|Imath)/|Imf|Imath|half\.h": ["renderer/output/read_exr.cpp", "renderer/output/write_exr.cpp"],
    r"libdeflate": ["renderer/output/exr_zip.cpp"],
    r"OpenImageIO/": ["renderer/output/image_codecs.cpp"],
    r"OpenColorIO/": ["renderer/output/display.cpp"],
    r"cairo": ["renderer/slice/", "renderer/output/"],
    r"yaml-cpp/": ["renderer/scene/"],
    r"nlohmann/": ["renderer/scene/", "renderer/app/", "tests/"],
    r"CLI/": ["renderer/app/command_line/options.cpp"],
    r"xxhash": ["renderer/scene/"],
    r"sleef": ["field/math/"],
    r"boost/": ["field/trace/general/crossing.cpp"],
    r"fmt/": ["field/", "materials/", "renderer/", "tests/"],
    r"(gtest|gmock)/": ["tests/"],
}

# What has a folder or an ending is no header of C++: it is POSIX, or a library that LIBRARIES tells the place of.
NOT_CPP = re.compile(r"[/.]")
POSIX = re.compile(r"sys/|(unistd|fcntl|spawn|pthread|dlfcn)\.h")

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def folder_of(path):
    """The entry of ARROWS that holds the file, or None."""
    inside = [name for name in ARROWS if path.startswith(name + "/")]
    return max(inside, key=len, default=None)


def leads_to(other, home):
    """Whether a folder other than `home` may include `home`, or a file of it."""
    return other not in (None, home) and any(folder_of(name + "/") == home for name in ARROWS[other])


def may_include(path, target):
    home = folder_of(path)
    allowed = [home] + ARROWS[home]
    return (any(target == name or target.startswith(name + "/") for name in allowed)
            and not leads_to(folder_of(target), home))


def may_use_library(path, header):
    for pattern, places in LIBRARIES.items():
        if re.match(pattern, header):
            in_tests = path.startswith("tests/")
            return in_tests or (any(path.startswith(place) for place in places) and path.endswith(".cpp"))
    return not NOT_CPP.search(header) or POSIX.match(header) is not None


def complaints_of(path, text):
    if folder_of(path) is None:
        yield f"{path}: its folder has no entry in ARROWS of tests/layering.py"
        return
    for kind, target in INCLUDE.findall(text):
        if kind == '"' and not may_include(path, target):
            yield f'{path}: #include "{target}" is against the arrows'
        if kind == "<" and not may_use_library(path, target):
            yield f"{path}: #include <{target}> belongs into the one .cpp that adapts the library (LIBRARIES)"


def complaints(root):
    for top in ("field", "materials", "renderer", "tests"):
        for file in sorted((root / top).rglob("*")):
            if file.suffix in (".h", ".cpp"):
                yield from complaints_of(file.relative_to(root).as_posix(), file.read_text(encoding="utf-8"))


def self_test():
    wrong = {
        "field/math/a.h": '#include "field/program/field_program.h"\n',
        "field/blend/a.h": '#include "field/blend/bounds/blend_bounds.h"\n',
        "field/blend/bounds/sum/a.h": '#include "field/blend/gather.h"\n',
        "field/trace/sources/a.h": '#include "field/trace/cells/tile.h"\n',
        "field/program/b.cpp": '#include "renderer/scene/scene_description.h"\n',
        "materials/c.h": '#include "field/blend/correction/correction.h"\n',
        "renderer/output/d.h": "#include <OpenEXR/ImfHeader.h>\n",
        "renderer/app/e.cpp": "#include <embree3/rtcore.h>\n",
        "renderer/app/input/f.h": '#include "renderer/app/picture/finish_render.h"\n',
        "field/unknown/f.h": "",
        "field/math/g.cpp": "#include <eigen3/Eigen/Core>\n",
    }
    right = {
        "field/blend/bounds/a.cpp": '#include "field/blend/bounds/sum/sum_bounds.h"\n',
        "field/blend/g.cpp": '#include "field/blend/correction/correction.h"\n',
        "field/trace/a.cpp": '#include "field/trace/cells/tile.h"\n',
        "field/program/g.cpp": '#include <vector>\n#include <sys/mman.h>\n#include "field/math/vec3.h"\n',
        "renderer/geometry/h.cpp": '#include <embree3/rtcore.h>\n#include "renderer/scene/scene_description.h"\n',
        "renderer/app/main.cpp": '#include "renderer/app/command_line/options.h"\n',
        "tests/field/i.cpp": '#include <gtest/gtest.h>\n#include "renderer/app/command_line/options.h"\n',
    }
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in (wrong | right).items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        found = sorted(complaint.split(":")[0] for complaint in complaints(root))
    if found != sorted(wrong):
        print(f"expected complaints about {sorted(wrong)}, got {found}")
        return 1
    return 0


def main(mode, root):
    if mode == "self-test":
        return self_test()
    found = list(complaints(pathlib.Path(root)))
    print("\n".join(found) if found else "all includes follow the arrows")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
