"""Trees that are deep, wide or shared, from the file to the picture, on a stack of 256 KiB.

MARROW_DEEP_COUNT sets the number of nodes; the whole count, a million, takes some minutes.
"""
import os
import random
import resource
import subprocess
import unittest

from marrow_program import PROGRAM, ProgramTest

COUNT = int(os.environ.get("MARROW_DEEP_COUNT", "10000"))
STACK = 256 * 1024
HEAD = """marrow: 1
camera: {from: [0, 0, 5], to: [0, 0, 0], fov: 40}
film: {size: [16, 16]}
render: {spp: 1}
lights:
  - constant: {radiance: [1, 1, 1]}
"""


def balls(kind):
    """COUNT small balls in a cube, as the scene format writes them, from a fixed seed."""
    numbers = random.Random(1)
    radius = round(0.6 * COUNT ** (-1 / 3), 5)
    for _ in range(COUNT):
        x, y, z = (round(numbers.uniform(-1, 1), 4) for _ in range(3))
        if kind == "point":
            yield f"{{point: {{at: [{x}, {y}, {z}], radius: {radius}}}}}"
        else:
            yield (f"{{sphere: {{center: [{x}, {y}, {z}], radius: {radius}, "
                   f"potential: {{wyvill: {{range: {radius}}}}}}}}}")


def wide(operator, kind):
    rows = "".join(f"          - {ball}\n" for ball in balls(kind))
    return f"{HEAD}objects:\n  - field:\n      {operator}:\n        of:\n{rows}"


LAST = f"{{use: n{COUNT - 1}}}"


def chain(first, step, field=LAST):
    """Named nodes, each of which uses the one before it: step(i) writes the i-th."""
    rows = [f"  n0: {first}\n"]
    rows += [f"  n{i}: {step(i)}\n" for i in range(1, COUNT)]
    return f"{HEAD}defs:\n{''.join(rows)}objects:\n  - field: {field}\n"


def deep(operator, kind, first=None):
    rest = balls(kind)
    return chain(first or next(rest), lambda i: f"{{{operator}: {{of: [{{use: n{i - 1}}}, {next(rest)}]}}}}")


class DeepTest(ProgramTest):
    def render(self, scene):
        """Renders on a small stack; the picture must show something."""
        self.write("scene.yaml", scene)
        done = subprocess.run([PROGRAM, "render", "scene.yaml"], cwd=self.folder, text=True, capture_output=True,
                              timeout=1500, env=self.environment(),
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_STACK, (STACK, STACK)))
        self.assertEqual(done.returncode, 0, done.stderr[-2000:])
        self.assertNotIn("not proved", done.stdout + done.stderr)
        self.assertGreater((self.folder / "scene.png").stat().st_size, 300, "the picture is empty")

    def test_a_chain_of_unions(self):
        self.render(deep("union", "point"))

    def test_a_chain_of_sums(self):
        self.render(deep("sum", "sphere"))

    def test_a_chain_of_cuts(self):
        self.render(deep("difference", "sphere", "{sphere: {}}"))

    def test_a_chain_of_placements(self):
        self.render(chain("{sphere: {}}", lambda i: f"{{transform: {{translate: [1e-7, 0, 0], of: {{use: n{i - 1}}}}}}}"))

    def test_a_chain_of_different_operators(self):
        operators = ["sum", "soft_union", "difference", "ricci", "union"]
        rest = balls("sphere")
        self.render(chain("{sphere: {}}",
                          lambda i: f"{{{operators[i % 5]}: {{of: [{{use: n{i - 1}}}, {next(rest)}]}}}}"))

    def test_a_wide_union(self):
        self.render(wide("union", "point"))

    def test_a_wide_sum(self):
        self.render(wide("sum", "sphere"))

    def test_a_wide_blend(self):
        self.render(wide("blend", "point"))

    def test_copies_of_a_deep_subtree_share_it(self):
        rest = balls("sphere")
        half = min(50, 2_000_000 // COUNT)  # a scene may place ten million nodes
        copies = ", ".join(f"{{transform: {{translate: [{i}, 0, -9], of: {LAST}}}}}" for i in range(-half, half))
        scene = chain(next(rest), lambda i: f"{{sum: {{of: [{{use: n{i - 1}}}, {next(rest)}]}}}}",
                      f"{{union: {{of: [{copies}]}}}}")
        self.write("scene.yaml", scene)
        check = subprocess.Popen([PROGRAM, "check", "scene.yaml"], cwd=self.folder, env=self.environment(),
                                 stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(check.pid, 0)
        check.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(check.returncode, 0)
        self.assertLess(usage.ru_maxrss, 400 * 1024 + COUNT * 10, "each copy would take as much again")

    def test_too_deep_a_text_is_told_the_way_around(self):
        for depth in (200, 100_000):
            self.write("scene.yaml", HEAD + "objects:\n  - field: " + "{ricci: {of: [" * depth + "{sphere: {}}" +
                       "]}}" * depth)
            done = self.expect(65, "check", "scene.yaml")
            self.assertIn("nested deeper than 384 levels", done.stderr)
            self.assertIn("defs", done.stderr)


if __name__ == "__main__":
    unittest.main()
