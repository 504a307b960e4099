"""From a scene file to picture files: the same bytes each time, and nothing lost when something is wrong."""
import os
import pathlib
import resource
import signal
import subprocess
import time
import unittest

from marrow_program import BAD, POINT, PROGRAM, ProgramTest

BLEND = """\
marrow: 1
camera: {from: [0, 1.5, 7], to: [0, 0, 0], fov: 35}
film: {size: [96, 54]}
render: {spp: 4}
lights:
  - constant: {radiance: [0.4, 0.45, 0.5]}
  - rectangle: {center: [2, 4, 3], normal: [-0.4, -0.8, -0.6], size: [2, 2], radiance: [12, 11, 10]}
materials:
  skin: {coated: {color: [0.8, 0.5, 0.4]}}
  floor: {diffuse: {color: 0.6}}
objects:
  - name: pair
    material: skin
    field:
      blend:
        kernel: {inverse: 4}
        alpha: contact
        of:
          - point: {at: [-1, 0, 0], radius: 1}
          - segment: {from: [0.7, 0, 0], to: [2.2, 0.6, 0], radius: [0.7, 0.3]}
  - name: floor
    material: floor
    plane: {point: [0, -1.2, 0], normal: [0, 1, 0]}
"""

EXR = b"\x76\x2f\x31\x01"
PNG = b"\x89PNG\r\n\x1a\n"


class RenderTest(ProgramTest):
    def bytes_of(self, *arguments, scene="point.yaml"):
        self.expect(0, "render", scene, "-o", "a.exr", "--png", "a.png", *arguments, SOURCE_DATE_EPOCH="1")
        return (self.folder / "a.exr").read_bytes(), (self.folder / "a.png").read_bytes()

    def test_the_default_outputs_have_the_name_of_the_scene(self):
        (self.folder / "scenes").mkdir()
        self.write("scenes/point.yaml", POINT)
        done = self.expect(0, "render", "scenes/point.yaml")
        self.assertEqual(self.files(), ["point.exr", "point.png", "scenes"])
        self.assertEqual((self.folder / "point.exr").read_bytes()[:4], EXR)
        self.assertEqual((self.folder / "point.png").read_bytes()[:8], PNG)
        self.assertEqual(done.stdout, "")
        self.assertIn("point.exr", done.stderr)

    def test_only_what_is_asked_for_is_written(self):
        scene = self.write("point.yaml", POINT)
        for arguments, name in ((["-o", "x.png"], "x.png"), (["--png", "y.png"], "y.png"), (["-o", "z.exr"], "z.exr")):
            self.assertEqual(self.expect(0, "render", scene, "--quiet", *arguments).stderr, "")
            self.assertEqual(self.files(), [scene, name])
            (self.folder / name).unlink()

    def test_the_same_bytes_again_and_for_any_number_of_threads(self):
        self.write("point.yaml", POINT)
        first = self.bytes_of("-t", "1")
        self.assertEqual(self.bytes_of("-t", "1"), first)
        self.assertEqual(self.bytes_of("-t", "2"), first)
        self.assertNotEqual(self.bytes_of("--seed", "8")[0], first[0])

    def test_the_same_bytes_for_every_instruction_set_of_this_machine(self):
        self.write("blend.yaml", BLEND)
        best = self.bytes_of(scene="blend.yaml")
        flags = pathlib.Path("/proc/cpuinfo").read_text()
        sets = ["sse4"] + [name for name, flag in (("avx2", " avx2 "), ("avx512", " avx512bw ")) if flag in flags]
        print("instruction sets compared:", *sets)
        for name in sets:
            self.assertEqual(self.bytes_of("--isa", name, "-t", "1", scene="blend.yaml"), best, name)

    def test_an_instruction_set_that_is_not_there_is_told_once(self):
        self.write("blend.yaml", BLEND)
        flags = pathlib.Path("/proc/cpuinfo").read_text()
        has_all = " avx512bw " in flags
        for option in ("--isa", "--embree-isa"):
            done = self.expect(0 if has_all else 69, "render", "blend.yaml", option, "avx512", "-q", "-o", "set.exr")
            if has_all: continue
            self.assertEqual(done.stderr.count("error"), 1, done.stderr)
            self.assertIn("this machine does not have avx512, but sse4", done.stderr)
            self.assertEqual(self.files(), ["blend.yaml"])

    def test_a_bad_scene_leaves_old_pictures_alone(self):
        self.write("bad.yaml", BAD)
        self.write("bad.exr", "old")
        self.assertIn("bad.yaml:", self.expect(65, "render", "bad.yaml").stderr)
        self.assertEqual((self.folder / "bad.exr").read_text(), "old")
        self.assertEqual(self.files(), ["bad.exr", "bad.yaml"])

    def test_outputs_are_tried_before_the_work(self):
        scene = self.write("point.yaml", POINT)
        for output in ("no/such/folder.exr", "/proc/picture.exr"):
            start = time.monotonic()
            done = self.expect(73, "render", scene, "--spp", "1000000", "-o", output)
            self.assertIn(output, done.stderr)
            self.assertLess(time.monotonic() - start, 10)
        self.assertEqual(self.files(), [scene])

    def test_what_the_scene_is_made_from_is_not_replaced(self):
        scene = self.write("point.yaml", POINT)
        self.expect(0, "render", scene, "--spp", "1", "-o", "sky.exr")
        lit = self.write("sky.yaml", POINT.replace("lights:", "lights:\n  - image: {file: sky.exr}"))
        before = (self.folder / "sky.exr").read_bytes()
        self.assertIn("sky.exr", self.expect(73, "render", lit, "--spp", "1").stderr)
        self.assertEqual((self.folder / "sky.exr").read_bytes(), before)
        (self.folder / "scene.png").write_text(POINT)
        self.expect(73, "render", "scene.png", "--spp", "1")
        self.expect(73, "slice", "scene.png", "--plane", "z=0", "-o", "scene.png")
        self.assertEqual((self.folder / "scene.png").read_text(), POINT)

    def test_a_view_that_there_is_not_is_told_though_no_png_is_written(self):
        scene = self.write("point.yaml", POINT)
        self.assertIn("nope", self.expect(2, "render", scene, "-o", "point.exr", "--view", "nope").stderr)
        self.assertEqual(self.files(), [scene])

    def test_a_full_disk_is_an_error(self):
        scene = self.write("point.yaml", POINT)
        self.assertIn("/dev/full", self.expect(74, "render", scene, "-o", "/dev/full").stderr)
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run([PROGRAM, "schema"], stdout=full, stderr=subprocess.PIPE, check=False)
        self.assertEqual(done.returncode, 74)

    def test_a_limit_of_file_sizes_is_an_error_and_leaves_nothing(self):
        scene = self.write("point.yaml", POINT)

        def allow_a_kilobyte():
            resource.setrlimit(resource.RLIMIT_FSIZE, (1024, 1024))
        done = subprocess.run([PROGRAM, "render", scene, "-D", "film.size=[64, 64]", "-o", "large.exr"],
                              cwd=self.folder, preexec_fn=allow_a_kilobyte, capture_output=True, check=False)
        self.assertEqual(done.returncode, 74)
        self.assertEqual(self.files(), [scene])

    def test_a_signal_keeps_what_there_is(self):
        scene = self.write("point.yaml", POINT)
        for number in (signal.SIGINT, signal.SIGTERM):
            with subprocess.Popen([PROGRAM, "render", scene, "--spp", "10000000", "-o", "a.exr", "--progress", "json"],
                                  cwd=self.folder, env=self.environment(), stderr=subprocess.PIPE, text=True) as process:
                for line in process.stderr:
                    if '"render"' in line:
                        break
                process.send_signal(number)
                process.stderr.read()
                self.assertEqual(process.wait(timeout=30), 75)
            self.assertEqual((self.folder / "a.exr").read_bytes()[:4], EXR)
            (self.folder / "a.exr").unlink()

    def test_a_time_limit_ends_a_render_well(self):
        scene = self.write("point.yaml", POINT)
        start = time.monotonic()
        self.expect(0, "render", scene, "--spp", "10000000", "--time", "0.5s", "-o", "a.exr")
        self.assertLess(time.monotonic() - start, 20)

    def test_progress_is_one_line_at_a_time_without_a_terminal(self):
        scene = self.write("point.yaml", POINT)
        plain = self.expect(0, "render", scene, "-o", "a.exr").stderr
        self.assertIn("render 100.0 %", plain)
        self.assertNotIn("\r", plain)

    def test_a_terminal_gets_a_bar_that_is_wiped(self):
        scene = self.write("point.yaml", POINT)
        terminal, end = os.openpty()
        process = subprocess.Popen([PROGRAM, "render", scene, "--time", "1s", "--spp", "10000000", "-o", "a.exr"],
                                   cwd=self.folder, env=self.environment(), stderr=end)
        os.close(end)
        text = b""
        try:
            while chunk := os.read(terminal, 4096):
                text += chunk
        except OSError:
            pass  # the other end of a terminal is closed: Linux says EIO
        self.assertEqual(process.wait(timeout=30), 0)
        os.close(terminal)
        self.assertRegex(text, rb"\[#*\.*\] +\d+ %.*left")
        self.assertIn(b"\r\x1b[Kwrote a.exr", text)


if __name__ == "__main__":
    unittest.main()
