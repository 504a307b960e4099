"""Every mistake of a scene is told, with its place; a good scene is counted."""
import json
import unittest

from marrow_program import BAD, POINT, SOURCE, ProgramTest

NO_SURFACE = """marrow: 1
lights: [constant: {}]
objects:
  - field: {plane: {normal: [0, 1, 0]}}
  - field: {union: {of: [{sphere: {radius: 1}}, {plane: {normal: [0, 1, 0]}}]}}
  - field: {intersection: {of: [{sphere: {radius: 1}}, {plane: {normal: [0, 1, 0]}}]}}
  - field: {blend: {cavity: false, alpha: 0.1, of: [{point: {at: [0, 0, 0], radius: 1}}]}}
  - field: {blend: {cavity: false, alpha: 0.9, of: [{point: {at: [0, 0, 0], radius: 1}}]}}
"""


class CheckTest(ProgramTest):
    def test_a_good_scene_is_counted(self):
        done = self.expect(0, "check", self.write("point.yaml", POINT))
        self.assertRegex(done.stdout, r"^point\.yaml: ok: 1 object .*1 material, 1 light\n$")
        self.assertEqual(done.stderr, "")

    def test_all_mistakes_are_told_with_line_and_caret(self):
        told = self.expect(65, "check", self.write("bad.yaml", BAD)).stderr
        lines = BAD.splitlines()
        for word in ("alpah", "-1"):
            line = next(i for i, text in enumerate(lines, 1) if word in text)
            self.assertIn(f"bad.yaml:{line}:", told)
            self.assertIn(lines[line - 1], told)
        self.assertIn("^", told)
        self.assertIn("alpha", told)

    def test_editors_get_json(self):
        found = json.loads(self.expect(65, "check", self.write("bad.yaml", BAD), "--format", "json").stdout)
        self.assertGreaterEqual(len(found), 2)
        for problem in found:
            self.assertEqual(problem["file"], "bad.yaml")
            self.assertGreater(problem["line"], 0)
            self.assertGreater(problem["column"], 0)
        good = self.expect(0, "check", self.write("point.yaml", POINT), "--format", "json").stdout
        self.assertEqual(json.loads(good), [])

    def test_editors_get_the_name_of_a_scene_that_is_not_there(self):
        found = json.loads(self.expect(66, "check", "gone.yaml", "--format", "json").stdout)
        self.assertEqual([problem["file"] for problem in found], ["gone.yaml"])

    def test_what_rays_cannot_meet_is_refused_as_by_render(self):
        self.write("ends.yaml", NO_SURFACE)
        told = self.expect(65, "check", "ends.yaml").stderr
        self.assertIn("3 errors", told)
        for line in (4, 5, 7):
            self.assertIn(f"ends.yaml:{line}:", told)
        self.assertEqual(told, self.expect(65, "render", "ends.yaml", "--quiet").stderr)

    def test_a_light_whose_picture_is_none_is_a_mistake_of_the_scene(self):
        self.write("sky.exr", "not a picture")
        scene = self.write("sky.yaml", POINT.replace("constant: {radiance: [1, 1, 1]}", "image: {file: sky.exr}"))
        for command in (["check"], ["render", "-o", "x.png"]):
            told = self.expect(65, command[0], scene, *command[1:]).stderr
            self.assertIn("sky.yaml:6:", told)
            self.assertIn("sky.exr", told)

    def test_a_picture_of_nothing_is_warned_of(self):
        dark = self.write("dark.yaml", POINT.replace("  - constant: {radiance: [1, 1, 1]}\n", "").replace("lights:\n", ""))
        for command in (["check"], ["render", "-o", "x.png"]):
            self.assertIn("nothing shines", self.expect(0, command[0], dark, *command[1:]).stderr)
        for quiet in ("render.integrator=normals", "materials.skin.diffuse.emission=1"):
            self.assertEqual(self.expect(0, "check", dark, "-D", quiet).stderr, "")
        self.assertIn("no object", self.expect(0, "check", self.write("empty.yaml", "marrow: 1\n")).stderr)

    def test_a_limit_in_degrees_is_allowed_itself(self):
        for angle in ("1e9", "-1e9", "1e9deg"):
            turned = POINT[:POINT.index("    field:")] + f"    field: {{twist: {{angle: {angle}, of: {{box: {{}}}}}}}}\n"
            self.expect(0, "check", self.write("turned.yaml", turned))
        self.expect(65, "check", self.write("turned.yaml", turned.replace("1e9deg", "1.001e9")))

    def test_overrides_are_checked_like_the_file(self):
        scene = self.write("point.yaml", POINT)
        self.expect(0, "check", scene, "-D", "camera.fov=20", "-D", "render.spp=9")
        self.assertIn("-D", self.expect(65, "check", scene, "-D", "camera.fow=20").stderr)

    def test_each_ugly_scene_is_refused_with_a_place(self):
        for scene in sorted((SOURCE / "scenes" / "bad").glob("*.yaml")):
            with self.subTest(scene.name):
                self.assertRegex(self.expect(65, "check", str(scene)).stderr, r"error: ")

    def test_each_gallery_scene_is_good(self):
        for scene in sorted((SOURCE / "scenes" / "gallery").glob("*.yaml")):
            with self.subTest(scene.name):
                self.expect(0, "check", str(scene))

    def test_a_skeleton_is_no_scene(self):
        told = self.expect(65, "check", self.write("tree.swc", "1 1 0 0 0 1 -1\n2 1 1 0 0 1 1\n")).stderr
        self.assertIn("tree.swc: error: this is a skeleton, not a scene", told)
        self.assertIn("`skeleton: {file: tree.swc}`", told)
        self.assertIn("missing.swc", self.expect(66, "check", "missing.swc").stderr)

    def test_what_goes_on_in_further_lines_is_underlined_to_the_end_of_the_first(self):
        told = self.expect(65, "check", self.write("words.yaml", "one two\nthree four\nfive\n")).stderr
        self.assertIn("| ^~~~~~~\n", told)


class SchemaTest(ProgramTest):
    def test_the_schema_is_json_schema(self):
        text = self.expect(0, "schema").stdout
        self.assertIn("draft-07", json.loads(text)["$schema"])
        self.assertIn('"objects"', text)

    def test_readers_get_text(self):
        self.assertIn("objects", self.expect(0, "schema", "--markdown").stdout)


if __name__ == "__main__":
    unittest.main()
