"""Whatever the JSON Schema refuses, the loader refuses; what the loader takes, the schema takes.

Takes good scenes, changes them at random (seed printed), and asks both. Scenes are written as JSON, which is YAML.
"""
import copy
import json
import os
import random
import subprocess
import sys
import tempfile

import jsonschema

TOOL, SOURCE = sys.argv[1:3]
SEED = 7
DATA = os.path.join(SOURCE, "scenes", "data")

BALL = {"point": {"at": [0, 0, 0], "radius": 1}}
GOOD = {
    "marrow": 1, "units": "um", "up": "z",
    "camera": {"type": "perspective", "from": [0, 1, 6], "to": [0, 0, 0], "up": [0, 1, 0], "fov": "35deg", "height": 2},
    "film": {"size": [64, 48]},
    "render": {"integrator": "path", "spp": 4, "seed": 1, "max_depth": 3},
    "lights": [
        {"constant": {"radiance": [1, 1, 1]}},
        {"sun": {"direction": [0, 1, 0], "irradiance": {"kelvin": 5600, "luminance": 2}, "angle": 0.53}},
        {"rectangle": {"center": [0, 4, 0], "normal": [0, -1, 0], "size": [2, 2], "radiance": 10}},
        {"point": {"at": [0, 1, 0], "intensity": "#ffeedd"}},
    ],
    "materials": {
        "skin": {"diffuse": {"color": [0.8, 0.5, 0.4]}},
        "gold": {"conductor": {"metal": "gold", "roughness": 0.1}},
        "coat": {"coated": {"color": 0.5, "roughness": 0.1, "ior": 1.5}},
    },
    "defs": {"ball": BALL},
    "objects": [
        {"name": "body", "material": "skin", "field": {"blend": {
            "kernel": {"inverse": 4}, "alpha": "contact", "cavity": True, "projection": "exact", "model": "integral",
            "of": [BALL,
                   {"segment": {"from": [0, 0, 0], "to": [1, 0, 0], "radius": [0.5, 0.2], "alpha": 0.9,
                                "material": "gold", "model": "distance"}},
                   {"polyline": {"points": [[0, 0, 0], [1, 0, 0]], "radius": 0.1}},
                   {"curve": {"points": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "radius": 0.1, "levels": 2,
                              "branches": [[0, 1], [1, 2, 0]]}},
                   {"skeleton": {"file": os.path.join(DATA, "tree.swc"), "scale": 2, "min_radius": 0.01,
                                 "simplify": 0.01, "subdivision": "cubic", "levels": 1, "radius_scale": 2}},
                   {"skeleton": {"file": os.path.join(DATA, "1crn.pdb"), "format": "pdb", "elements": ["C", "N"],
                                 "bonds": 0.2, "radius": 0.5}}]}}},
        {"name": "rest", "field": {"union": {"of": [
            {"use": "ball"},
            {"transform": {"translate": [1, 0, 0], "rotate": {"axis": [0, 1, 0], "angle": 90}, "scale": 2,
                           "of": {"use": "ball"}}}]}}},
        {"name": "floor", "material": "coat", "plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}},
    ],
}


def places(value, path=()):
    """Every map and list inside, as paths."""
    if isinstance(value, (dict, list)):
        yield path
        for key in (value if isinstance(value, dict) else range(len(value))):
            yield from places(value[key], path + (key,))


def mutant(rng):
    scene = copy.deepcopy(GOOD)
    path = rng.choice(list(places(scene)))
    parent = scene
    for step in path:
        parent = parent[step]
    key = rng.choice(list(parent) if isinstance(parent, dict) else range(len(parent)))
    junk = rng.choice([0, -1, 2, 0.5, 1e20, 1.5, "word", "#abcdef", "20deg", True, None, [], {}, [1, 2], [1, 2, 3],
                       {"x": 1}, [[0, 0, 0]], "gold", 3])
    action = rng.randrange(4)
    if action == 0:
        del parent[key]
    elif action == 1 and isinstance(parent, dict):
        parent["x" + key] = parent.pop(key)
    elif action == 2 and isinstance(parent, dict):
        parent["extra"] = junk
    else:
        parent[key] = junk
    return scene


def main():
    schema = json.loads(subprocess.run([TOOL, "schema"], check=True, capture_output=True, text=True).stdout)
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    rng = random.Random(SEED)
    scenes = [GOOD, {"marrow": 1}] + [mutant(rng) for _ in range(600)]
    with tempfile.TemporaryDirectory() as folder:
        names = []
        for i, scene in enumerate(scenes):
            names.append(os.path.join(folder, f"{i}.yaml"))
            with open(names[-1], "w", encoding="utf-8") as file:
                json.dump(scene, file)
        answer = subprocess.run([TOOL, "check"], input="\n".join(names), check=True, capture_output=True, text=True)
    loads = [line == "ok" for line in answer.stdout.split()]
    assert len(loads) == len(scenes)
    assert loads[0] and loads[1], "the good scenes must load"
    valid = [validator.is_valid(scene) for scene in scenes]
    wrong = [i for i in range(len(scenes)) if loads[i] and not valid[i]]
    for i in wrong[:5]:
        print("loads, but the schema refuses it:", [e.message for e in validator.iter_errors(scenes[i])][:2])
    print(f"seed {SEED}: {sum(loads)} of {len(scenes)} load, {sum(valid)} are valid, {len(wrong)} disagree")
    agree = sum(load == is_valid for load, is_valid in zip(loads, valid)) / len(scenes)
    print(f"same answer for {100 * agree:.1f} %; the rest are mistakes that no schema can say (names, zero vectors)")
    assert 50 < sum(valid) < len(scenes) - 50 and agree > 0.85
    return 1 if wrong else 0


sys.exit(main())
