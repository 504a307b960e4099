"""A wrong command line is told in one breath, with code 2, and help needs no scene."""
import subprocess
import unittest

from marrow_program import POINT, PROGRAM, ProgramTest


class UsageTest(ProgramTest):
    def test_help_and_version_end_well(self):
        self.assertRegex(self.expect(0, "--version").stdout, r"^marrow \d+\.\d+\.\d+\n$")
        self.assertIn("render", self.expect(0, "--help").stdout)
        for command in ("render", "check", "schema", "probe", "trace", "info", "slice", "bench"):
            self.assertIn("Example", self.expect(0, command, "--help").stdout)

    def test_an_unknown_command_names_the_nearest(self):
        self.assertIn("`render`", self.expect(2, "rendre", "x.yaml").stderr)

    def test_no_command_at_all_is_answered_with_help(self):
        self.assertIn("render", self.expect(2).stderr)

    def test_an_unknown_option_names_the_nearest(self):
        self.assertIn("did you mean --spp?", self.expect(2, "render", "x.yaml", "--sppp", "3").stderr)

    def test_a_misspelt_option_is_told_before_what_is_missing(self):
        self.assertIn("did you mean --version?", self.expect(2, "--verson").stderr)
        self.assertIn("did you mean --quiet?", self.expect(2, "render", "--queit").stderr)
        self.assertIn("'-z'", self.expect(2, "render", "--", "x.yaml", "-z").stderr)

    def test_an_option_that_is_given_twice(self):
        error = self.expect(2, "render", "x.yaml", "--spp", "1", "--spp", "2", "-D", "a=1", "-D", "b=2").stderr
        self.assertIn("--spp is given 2 times; once is enough", error)

    def test_help_is_a_command_too(self):
        self.assertEqual(self.expect(0, "help").stdout, self.expect(0, "--help").stdout)
        self.assertEqual(self.expect(0, "help", "slice").stdout, self.expect(0, "slice", "--help").stdout)
        self.assertIn("did you mean `slice`?", self.expect(2, "help", "slices").stderr)

    def test_numbers_are_told_what_they_should_be(self):
        for option in (["render", "x.yaml", "--spp", "1e3"], ["render", "x.yaml", "--spp", "0"],
                       ["slice", "x.yaml", "--width", "wide"], ["bench", "--rounds", "0"]):
            self.assertIn(f"{option[-2]}: a whole number from 1 to ", self.expect(2, *option).stderr)
        self.assertIn("--mesh: a number from 0 to 1e+15; found 'nan'", self.expect(2, "bench", "--mesh", "nan").stderr)

    def test_outputs_that_lead_nowhere(self):
        scene = self.write("point.yaml", POINT)
        (self.folder / "loop.png").symlink_to("loop.png")
        self.assertIn("Too many levels", self.expect(73, "render", scene, "-o", "loop.png").stderr)
        (self.folder / "lost.png").symlink_to("missing/picture.png")
        self.assertIn("there is no folder", self.expect(73, "render", scene, "-o", "lost.png").stderr)
        self.assertIn("name too long", self.expect(73, "render", scene, "-o", "x" * 300 + ".png").stderr)

    def test_a_slice_too_large_is_told_the_width_that_fits(self):
        scene = self.write("point.yaml", POINT)
        slice_of = ("slice", scene, "--plane", "z=0", "--window", "0,0,1,1", "--width")
        self.assertIn("a width of 8192 fits", self.expect(2, *slice_of, "8193").stderr)

    def test_a_slice_beside_the_surface_says_so(self):
        scene = self.write("point.yaml", POINT)
        slice_of = ("slice", scene, "-o", "slice.png", "--width", "16")
        self.assertEqual(self.expect(0, *slice_of, "--plane", "z=0").stderr, "")
        self.assertIn("does not meet this window: there the field is at most 0.0",
                      self.expect(0, *slice_of, "--plane", "z=4").stderr)
        self.assertIn("there the field is at least",
                      self.expect(0, *slice_of, "--plane", "z=0", "--window=-0.01,-0.01,0.01,0.01").stderr)
        self.assertIn("slice.png", self.files())

    def test_a_picture_too_large_for_memory(self):
        scene = self.write("point.yaml", POINT)
        done = subprocess.run(["prlimit", "--as=2000000000", PROGRAM, "render", scene, "-D", "film.size=[32768, 32768]"],
                              cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 70)
        self.assertIn("not enough memory", done.stderr)

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
        for command in (["render"], ["check"], ["info"], ["slice", "--plane", "z=0"], ["probe", "--points", "-"],
                        ["trace", "--rays", "-"]):
            with self.subTest(command):
                self.assertIn("missing.yaml", self.expect(66, *command, "missing.yaml").stderr)


if __name__ == "__main__":
    unittest.main()
