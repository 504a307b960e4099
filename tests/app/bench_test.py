"""`marrow bench` runs on tiny pictures, and says what it measured."""
import json
import shutil
import unittest

from marrow_program import ProgramTest

TINY = ("--size", "32", "--rounds", "1", "--mesh", "0.2", "-t", "2")


class BenchTest(ProgramTest):
    def test_figures_for_programs(self):
        out = json.loads(self.expect(0, "bench", "w1", *TINY, "--json", timeout=240).stdout)
        self.assertEqual(out["size_pixels"], 32)
        (w1,) = out["workloads"]
        self.assertEqual((w1["name"], w1["primitives"]), ("w1", 867))
        marrow, cones, triangles = w1["engines"]
        self.assertEqual([marrow["name"], cones["name"], triangles["name"]],
                         ["marrow", "embree round cones", "embree triangles"])
        for engine in w1["engines"]:
            self.assertEqual(engine["frame_rays"], 32 * 32)
            self.assertGreater(engine["rays_per_second"], 0)
        # The same shape for all: they meet about as many pixels
        for peer in (cones, triangles):
            self.assertLess(abs(peer["frame_hits"] / marrow["frame_hits"] - 1), 0.25)
        self.assertGreater(marrow["evaluations_per_ray"], 0)
        self.assertGreater(marrow["bounce_evaluations_per_ray"], 0)
        self.assertEqual(cones["evaluations_per_ray"], 0)
        self.assertGreater(w1["cells"], 0)
        self.assertGreater(w1["memory_bytes"], 0)
        for figure in ("read_wall_seconds", "build_wall_seconds", "file_to_first_ray_wall_seconds"):
            self.assertGreater(w1[figure], 0)
        self.assertIn("cpu", w1["further_sample_over_round_cones"])  # a difference: noise in so small a picture
        self.assertEqual(w1["rules"][0]["alpha"], "contact")
        self.assertGreater(w1["rules"][0]["over_plain_sum"]["cpu"], 0)
        names = [process["name"] for process in w1["processes"]]
        self.assertEqual(names, ["marrow", "povray blob"] if shutil.which("povray") else ["marrow"])
        self.assertGreater(w1["processes"][0]["peak_memory_bytes"], 1 << 20)

    def test_figures_for_people(self):
        done = self.expect(0, "bench", "w3", *TINY, "--no-processes", timeout=240)
        for words in ("w3: 200 points", "one further sample", "embree round cones", "Mray/s"):
            self.assertIn(words, done.stdout)
        self.assertIn("w3: ", done.stderr)

    def test_nothing_is_left_behind(self):
        self.expect(0, "bench", "w3", *TINY, "--no-processes", timeout=240, TMPDIR=str(self.folder))
        self.assertEqual(self.files(), [])

    def test_workloads_can_be_written_and_rendered(self):
        self.expect(0, "bench", "w1", "--write", "scenes", "--size", "16", "--scaling", "1000")
        self.assertEqual(sorted(p.name for p in (self.folder / "scenes").iterdir()), ["strands-1000.yaml", "tufts-1000.yaml", "w1.yaml"])
        self.expect(0, "render", "scenes/w1.yaml", "--spp", "1", "-o", "w1.exr")

    def test_wrong_names_are_told(self):
        self.assertIn("w1", self.expect(2, "bench", "w9").stderr)
        self.expect(66, "bench", "missing.swc")

    def test_skeletons_of_ones_own(self):
        (self.folder / "two balls.txt").write_text("pt 0 0 0 1\npt 1.5 0 0 1\n")
        (self.folder / "bad.txt").write_text("pt 0 0 0 1\npt 0 0 zero 1\n")
        out = json.loads(self.expect(0, "bench", "two balls.txt", *TINY, "--no-processes", "--json", timeout=240).stdout)
        (balls,) = out["workloads"]
        self.assertEqual((balls["name"], balls["primitives"]), ("two_balls", 2))
        self.assertGreater(balls["engines"][0]["frame_hits"], 100)
        self.assertIn("bad.txt:2:8", self.expect(65, "bench", "bad.txt").stderr)
        self.expect(65, "bench", "w1", "bad.txt", "w9", "--write", "scenes")
        self.assertFalse((self.folder / "scenes").exists())


if __name__ == "__main__":
    unittest.main()
