"""slice and info: windows into a scene."""
import json
import signal
import subprocess
import unittest

from marrow_program import POINT, PROGRAM, TWO_OBJECTS, ProgramTest


class SliceTest(ProgramTest):
    def test_an_interrupted_slice_leaves_old_pictures_alone(self):
        scene = self.write("two.yaml", TWO_OBJECTS)
        self.write("slice.png", "old")
        for number in (signal.SIGINT, signal.SIGTERM):
            with subprocess.Popen([PROGRAM, "slice", scene, "--plane", "z=0", "--width", "8000", "-t", "1"],
                                  cwd=self.folder, env=self.environment(), stderr=subprocess.PIPE, text=True) as process:
                self.wait_until_caught(process, number)
                process.send_signal(number)
                self.assertEqual(process.stderr.read(), "interrupted; nothing was written\n")
                self.assertEqual(process.wait(timeout=30), 75)
            self.assertEqual((self.folder / "slice.png").read_text(), "old")
            self.assertEqual(self.files(), ["slice.png", scene])

    def test_a_slice_is_a_picture_or_numbers(self):
        scene = self.write("point.yaml", POINT)
        self.expect(0, "slice", scene, "--plane", "z=0", "--width", "64")
        self.expect(0, "slice", scene, "--plane", "y=-0.5", "-o", "field.exr", "--width", "64", "--window", "-2,-2,2,2")
        self.assertEqual((self.folder / "slice.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertIn(b"field.value", (self.folder / "field.exr").read_bytes())

    def test_all_fields_or_one(self):
        scene = self.write("two.yaml", TWO_OBJECTS)
        self.expect(0, "slice", scene, "--plane", "z=0", "--width", "32", "--object", "other", "--range", "0:2")
        self.expect(0, "slice", scene, "--plane", "z=0", "--width", "32")
        self.expect(2, "slice", scene, "--plane", "z=0", "--object", "nobody")
        self.expect(73, "slice", scene, "--plane", "z=0", "-o", "no/slice.png")


class InfoTest(ProgramTest):
    def test_a_scene_is_counted(self):
        info = json.loads(self.expect(0, "info", self.write("two.yaml", TWO_OBJECTS), "--json").stdout)
        self.assertEqual([o["name"] for o in info["objects"]], ["ball", "other", "floor"])
        self.assertEqual([o["kind"] for o in info["objects"]], ["field", "field", "plane"])
        self.assertEqual([o.get("primitives") for o in info["objects"]], [1, 2, None])
        self.assertEqual(info["lights"], ["constant"])
        self.assertRegex(info["hash"], r"^[0-9a-f]{32}$")
        for key in ("primitives", "tiles", "memory_bytes"):
            self.assertGreater(info[key], 0)
        self.assertLess(info["bounds"]["lower"][0], info["bounds"]["upper"][0])

    def test_what_is_slow_is_told(self):
        slow = POINT.replace("kernel: {inverse: 4}", "kernel: {cauchy: 4}")
        told = json.loads(self.expect(0, "info", self.write("slow.yaml", slow), "--json").stdout)
        self.assertEqual([part["parts"] for part in told["objects"][0]["general_tracer"]], [1])
        self.assertIn("cauchy", told["objects"][0]["general_tracer"][0]["because"])
        quick = json.loads(self.expect(0, "info", self.write("point.yaml", POINT), "--json").stdout)
        self.assertEqual(quick["objects"][0]["general_tracer"], [])

    def test_a_cut_through_many_skeletons_is_not_slow(self):
        line = "[" + ", ".join(f"[{i / 40 - 0.5}, 0, 0]" for i in range(41)) + "]"
        blend = f"blend: {{of: [{{polyline: {{points: {line}, radius: 0.2}}}}]}}"
        plane = "plane: {point: [0, 0, 0], normal: [0, 0, 1]}"
        head = POINT[:POINT.index("    field:")] + "    field: "
        for field, parts in ((f"{{difference: {{of: [{{{blend}}}, {{{plane}}}]}}}}", []),
                             (f"{{twist: {{angle: 90, of: {{{blend}}}}}}}", [1])):
            scene = self.write("cut.yaml", head + field + "\n")
            told = json.loads(self.expect(0, "info", scene, "--json").stdout)
            self.assertEqual([part["parts"] for part in told["objects"][0]["general_tracer"]], parts)

    def test_people_get_text(self):
        text = self.expect(0, "info", self.write("point.yaml", POINT)).stdout
        for word in ("ball", "primitives", "tiles", "memory", "bounds", "constant", "diffuse"):
            self.assertIn(word, text)


if __name__ == "__main__":
    unittest.main()
