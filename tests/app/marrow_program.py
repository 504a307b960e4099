"""Runs the program in a folder of its own, and scenes small enough to render in a blink."""
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ["MARROW_PROGRAM"]
SOURCE = pathlib.Path(os.environ["MARROW_SOURCE_DIR"])

POINT = """marrow: 1
camera: {from: [0, 0, 6], to: [0, 0, 0], fov: 35}
film: {size: [24, 16]}
render: {spp: 4, seed: 7}
lights:
  - constant: {radiance: [1, 1, 1]}
materials:
  skin: {diffuse: {color: [0.8, 0.5, 0.4]}}
objects:
  - name: ball
    material: skin
    field:
      blend:
        kernel: {inverse: 4}
        alpha: sum
        of:
          - point: {at: [0, 0, 0], radius: 1}
"""

# Bounds tell little of it, so that rays take milliseconds.
SLOW = """marrow: 1
materials:
  skin: {diffuse: {color: 0.5}}
objects:
  - name: rings
    material: skin
    field:
      blend:
        kernel: {compact: 3}
        of:
          - circle: {axes: [[1, 0, 0], [0, 1, 0]], radius: 0.3}
          - circle: {center: [0.5, 0, 0], axes: [[1, 0, 0], [0, 0.2, 1]], radius: 0.3}
"""

TWO_OBJECTS = POINT + """  - name: other
    material: skin
    field:
      union:
        of:
          - blend: {of: [{point: {at: [2, 0, 0], radius: 0.5}}]}
          - blend: {of: [{point: {at: [3, 0, 0], radius: 0.5}}]}
  - name: floor
    material: skin
    plane: {point: [0, -1, 0], normal: [0, 1, 0]}
"""

BAD = POINT.replace("radius: 1", "radius: -1").replace("alpha: sum", "alpah: sum")


class ProgramTest(unittest.TestCase):
    """Each test has a fresh folder, which is the program's current one."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return name

    def environment(self, **variables):
        keep = {name: value for name, value in os.environ.items() if name not in ("OCIO", "SOURCE_DATE_EPOCH")}
        return keep | variables

    def run_marrow(self, *arguments, stdin="", timeout=60, **variables):
        return subprocess.run([PROGRAM, *arguments], cwd=self.folder, input=stdin, text=True, capture_output=True,
                              timeout=timeout, env=self.environment(**variables))

    def expect(self, code, *arguments, **keywords):
        """Runs, checks the exit code, and returns the finished process."""
        done = self.run_marrow(*arguments, **keywords)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def wait_until_caught(self, process, number):
        """Until the program has a handler of its own for the signal."""
        caught = 0
        while not caught >> (number - 1) & 1:
            time.sleep(0.01)
            self.assertIsNone(process.poll(), "it ended before")
            status = pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="utf-8")
            caught = int(re.search(r"SigCgt:\s*(\w+)", status)[1], 16)

    def interrupted(self, *arguments):
        """What a command wrote to both streams that was asked to stop as soon as it would."""
        process = subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, env=self.environment(),
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.wait_until_caught(process, signal.SIGINT)
        process.send_signal(signal.SIGINT)
        out, told = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 75, told)
        return out, told

    def files(self):
        return sorted(path.name for path in self.folder.iterdir())
