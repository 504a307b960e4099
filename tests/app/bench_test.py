"""`marrow bench` runs on tiny pictures, and says what it measured."""
import json
import os
import shutil
import signal
import subprocess
import unittest

from marrow_program import POINT, PROGRAM, ProgramTest

TINIEST = ("--size", "16", "--rounds", "1", "--mesh", "0", "--no-processes")
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
        for figure in ("evaluations_per_ray", "uncertified_rays", "bounce_evaluations_per_ray"):
            self.assertIsNone(cones[figure])
        self.assertGreater(w1["cells"], 0)
        self.assertGreater(w1["memory_bytes"], 0)
        for figure in ("read_wall_seconds", "build_wall_seconds", "file_to_first_ray_wall_seconds"):
            self.assertGreater(w1[figure], 0)
        # Of so small a picture most of these are too short to tell, and nothing that is told is below nothing
        self.assertEqual(w1["rules"][0]["alpha"], "contact")
        for cost in (w1["further_sample"], w1["further_sample_over_round_cones"], w1["rules"][0]["over_plain_sum"]):
            for figure in cost.values():
                self.assertTrue(figure is None or figure > 0, cost)
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

    def test_an_interruption_leaves_nothing_behind(self):
        self.write("one.txt", "pt 0 0 0 1\n")
        for number in (signal.SIGINT, signal.SIGTERM):
            # The rounds would take minutes
            with subprocess.Popen([PROGRAM, "bench", "one.txt", "--size", "256", "--rounds", "900", "--mesh", "0",
                                   "--no-processes"], cwd=self.folder, env=self.environment(TMPDIR=str(self.folder)),
                                  stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
                for line in process.stderr:
                    if line.startswith("one: frames"):
                        break
                process.send_signal(number)
                self.assertIn("interrupted; nothing was finished\n", process.stderr.read())
                self.assertEqual(process.wait(timeout=60), 75)
            self.assertEqual(self.files(), ["one.txt"])

    def test_what_was_finished_before_an_interruption_is_told(self):
        self.write("one.txt", "pt 0 0 0 1\n")
        self.write("two.txt", "pt 0 0 0 2\n")
        with subprocess.Popen([PROGRAM, "bench", "one.txt", "two.txt", "--size", "16", "--rounds", "10", "--mesh", "0",
                               "--json"], cwd=self.folder, env=self.environment(TMPDIR=str(self.folder)),
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            for line in process.stderr:
                if line.startswith("two: whole"):
                    process.send_signal(signal.SIGTERM)  # also the process that it waits for
                    break
            out, err = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 75)
        self.assertIn("interrupted; finished one\n", err)
        out = json.loads(out)
        self.assertEqual((out["interrupted"], [w["name"] for w in out["workloads"]]), (True, ["one"]))
        self.assertEqual(self.files(), ["one.txt", "two.txt"])

    def test_povray_is_labelled_with_what_it_takes(self):
        if not shutil.which("povray"):
            self.skipTest("no povray")
        self.write("one.txt", "pt 0 0 0 1\n")
        out = json.loads(self.expect(0, "bench", "one.txt", "--size", "16", "--rounds", "1", "--mesh", "0", "--long",
                                     "--json", timeout=240).stdout)
        processes = out["workloads"][0]["processes"]
        self.assertEqual([(p["name"], p["samples_per_pixel"]) for p in processes],
                         [("marrow", 1), ("povray blob", 1), ("marrow", 16), ("marrow", 17), ("povray blob", 17)])
        self.assertGreater(processes[-1]["this_over_marrow"]["wall"], 0)

    def test_a_frame_too_short_to_tell(self):
        self.write("one.txt", "pt 0 0 0 1\n")
        done = self.expect(0, "bench", "one.txt", *TINIEST, timeout=240)
        self.assertIn("too short", done.stdout)  # 256 rays of round cones take some microseconds
        self.assertNotIn("-0.", done.stdout)
        self.assertIn("one: 1 point of one.txt\n", done.stdout)

    def test_a_view_without_hits(self):
        self.write("miss.txt", "cam 0 0 20 0.2\npt 50 0 0 1\n")
        self.assertIn("no hits", self.expect(0, "bench", "miss.txt", *TINIEST, timeout=240).stdout)
        out = json.loads(self.expect(0, "bench", "miss.txt", *TINIEST, "--json", timeout=240).stdout)
        for engine in out["workloads"][0]["engines"]:
            self.assertEqual((engine["frame_hits"], engine["bounce_ray"]), (0, None))

    # An eye below the plane z = 0, and one on it
    def test_scenes_and_frames_look_the_same_way(self):
        for name, eye in (("below.txt", -20), ("on.txt", 0)):
            self.write(name, f"cam 0 0 {eye} 0.5\npt 0 0 {eye - 3} 1\npt 0 0 {eye + 3} .1\n")
            out = json.loads(self.expect(0, "bench", name, *TINIEST, "--json", timeout=240).stdout)
            hits = out["workloads"][0]["engines"][0]["frame_hits"]
            scene = "scenes/" + name.replace("txt", "yaml")
            self.expect(0, "bench", name, "--write", "scenes")
            self.expect(0, "check", scene)
            self.expect(0, "render", scene, "--spp", "1", "-o", "a.exr", "-D", "film.size=[16, 16]")
            self.assertGreater(hits, 60)  # the large ball; the small one is behind
            self.assertIn(f"to: [0, 0, {eye - 1}]", (self.folder / scene).read_text())

    def test_workloads_can_be_written_and_rendered(self):
        done = self.expect(0, "bench", "w1", "--write", "scenes", "--size", "16", "--scaling", "1000")
        self.assertEqual(done.stderr, "wrote scenes/w1.yaml\nwrote scenes/strands-1000.yaml\nwrote scenes/tufts-1000.yaml\n")
        self.assertEqual(sorted(p.name for p in (self.folder / "scenes").iterdir()), ["strands-1000.yaml", "tufts-1000.yaml", "w1.yaml"])
        self.expect(0, "render", "scenes/w1.yaml", "--spp", "1", "-o", "w1.exr")

    def test_an_interruption_leaves_whole_scenes(self):
        with subprocess.Popen([PROGRAM, "bench", "w1", "--write", "scenes", "--scaling", "1000000"], cwd=self.folder,
                              env=self.environment(), stderr=subprocess.PIPE, text=True) as process:
            told = [process.stderr.readline()]
            process.send_signal(signal.SIGINT)
            told += process.stderr.readlines()
            self.assertEqual(process.wait(timeout=60), 75)
        self.assertEqual(told.pop(), "interrupted; the others are not written\n")
        scenes = [line.removeprefix("wrote ").strip() for line in told]
        self.assertEqual(sorted("scenes/" + p.name for p in (self.folder / "scenes").glob("*.yaml")), sorted(scenes))
        for scene in scenes:
            self.expect(0, "check", scene)

    def test_a_file_is_no_folder(self):
        self.write("keep.png", "")
        self.assertIn("`keep.png` is a file, not a folder", self.expect(73, "bench", "w3", "--write", "keep.png").stderr)

    def test_wrong_names_are_told(self):
        self.assertIn("w1", self.expect(2, "bench", "w9").stderr)
        for missing in ("missing.swc", "missing.yaml", "no such/folder"):
            self.assertIn("No such file", self.expect(66, "bench", missing).stderr)
        self.assertIn("is a folder", self.expect(66, "bench", str(self.folder)).stderr)
        scene = self.write("scene.yaml", POINT)
        self.assertIn("marrow render scene.yaml", self.expect(2, "bench", scene).stderr)
        self.assertIn(".swc", self.expect(2, "bench", self.write("README.md", "")).stderr)

    def test_options_that_mean_nothing_are_refused(self):
        for wrong in (["--mesh", "nan"], ["--mesh", "inf"], ["--mesh", "-1"], ["--long", "--no-processes"]):
            with self.subTest(wrong):
                self.assertIn(wrong[0], self.expect(2, "bench", "w3", *wrong).stderr)

    def test_a_grid_that_fits_in_no_memory_is_refused_with_one_that_fits(self):
        self.write("one.txt", "pt 0 0 0 1\n")
        for spacing in ("1e-9", "1e-300", "0.001"):
            error = self.expect(2, "bench", "w3", "one.txt", "--size", "16", "--mesh", spacing).stderr
            self.assertRegex(error, "--mesh: a grid of .* too fine for w3\\n.* --mesh [0-9.]+;")
            self.assertRegex(error, "too fine for one\\n.* --mesh 0.0031;")

    def test_folders_that_cannot_be_used_are_told_with_the_reason(self):
        error = self.expect(73, "bench", "w3", *TINIEST, TMPDIR=str(self.folder / "nowhere")).stderr
        self.assertRegex(error, "temporary files: .+\\n.*TMPDIR")
        (self.folder / "w3.yaml").mkdir()
        self.assertIn("w3.yaml: error: cannot write: is a folder", self.expect(73, "bench", "w3", "--write", ".").stderr)

    def test_a_full_disk_leaves_what_was_there(self):
        scene = self.folder / "w3.yaml"
        scene.write_text("old")
        # As on a disk with room for 1000 bytes; Python ignores the signal of such a limit, and so does its child.
        done = subprocess.run(["prlimit", "--fsize=1000", PROGRAM, "bench", "w3", "--write", "."], cwd=self.folder,
                              capture_output=True, text=True, check=False, restore_signals=False)
        self.assertEqual(done.returncode, 73)
        self.assertIn("File too large", done.stderr)
        self.assertEqual(scene.read_text(), "old")
        self.assertEqual(os.listdir(self.folder), ["w3.yaml"])

    def test_a_skeleton_of_which_no_scene_can_be_made(self):
        self.write("thin.txt", "seg 0 0 0 1e-300  1 0 0 1e-300\n")
        self.assertIn("thin: error: no scene can be made of it: ", self.expect(65, "bench", "thin.txt", *TINIEST).stderr)

    def test_warnings_of_skeletons_are_told(self):
        self.write("thin.swc", "1 0 0 0 0 0 -1\n2 0 2 0 0 1 1\n")
        done = self.expect(0, "bench", "thin.swc", "--write", "scenes")
        self.assertIn("thin.swc: warning: 1 of 2 nodes have the radius 0", done.stderr)

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
