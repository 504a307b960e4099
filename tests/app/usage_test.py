"""A wrong command line is told in one breath, with code 2, and help needs no scene."""
import unittest

from marrow_program import POINT, ProgramTest


class UsageTest(ProgramTest):
    def test_help_and_version_end_well(self):
        self.assertRegex(self.expect(0, "--version").stdout, r"^marrow \d+\.\d+\.\d+\n$")
        self.assertIn("render", self.expect(0, "--help").stdout)
        for command in ("render", "check", "schema", "probe", "info", "slice", "bench"):
            self.assertIn("Example", self.expect(0, command, "--help").stdout)

    def test_an_unknown_command_names_the_nearest(self):
        self.assertIn("`render`", self.expect(2, "rendre", "x.yaml").stderr)

    def test_no_command_at_all_is_answered_with_help(self):
        self.assertIn("render", self.expect(2).stderr)

    def test_an_unknown_option_names_the_nearest(self):
        self.assertIn("did you mean --spp?", self.expect(2, "render", "x.yaml", "--sppp", "3").stderr)

    def test_values_that_mean_nothing_are_refused(self):
        scene = self.write("point.yaml", POINT)
        for wrong in (["--spp", "0"], ["--spp", "many"], ["--time", "soon"], ["--crop", "1,2,3"], ["-t", "0"],
                      ["--crop", "5,5,5,9"], ["-o", "picture.jpg"], ["--view", "no such view"], ["--isa", "mmx"],
                      ["--progress", "loud"], ["-o", "a.png", "--png", "b.png"], ["--seed", "-1"], ["--seed", "1.5"]):
            with self.subTest(wrong):
                self.assertNotEqual(self.expect(2, "render", scene, *wrong).stderr, "")
        self.expect(2, "slice", scene)
        self.assertIn("z=0", self.expect(2, "slice", scene, "--plane", "w=0").stderr)
        self.expect(2, "slice", scene, "--plane", "z=0", "--range", "2:1")
        self.expect(2, "probe", scene)
        self.assertEqual(self.files(), [scene])

    def test_the_largest_seed_is_a_seed(self):
        self.expect(0, "render", self.write("point.yaml", POINT), "--seed", str(2**64 - 1))

    def test_input_that_is_not_there(self):
        for command in (["render"], ["check"], ["info"], ["slice", "--plane", "z=0"], ["probe", "--points", "-"]):
            with self.subTest(command):
                self.assertIn("missing.yaml", self.expect(66, *command, "missing.yaml").stderr)


if __name__ == "__main__":
    unittest.main()
