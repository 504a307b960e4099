"""Rays of a list, against closed forms: a ball of radius 1 at the origin, a plane at y = -1."""
import json
import math
import unittest
from random import Random

from marrow_program import POINT, SLOW, TWO_OBJECTS, ProgramTest

OF_HIT = ["origin", "direction", "hit", "t", "position", "normal", "outside", "object", "material", "evaluations",
          "certified"]
OF_MISS = ["origin", "direction", "hit", "evaluations", "certified"]


def rows(rays):
    return "".join(" ".join(repr(number) for number in ray) + "\n" for ray in rays)


class TraceTest(ProgramTest):
    def trace(self, scene, rays, *arguments):
        return json.loads(self.expect(0, "trace", scene, "--rays", "-", *arguments, stdin=rows(rays)).stdout)

    def ball(self):
        return self.write("ball.yaml", POINT)

    def test_a_ball_is_met_where_it_is(self):
        hit, half, miss, inside = self.trace(
            self.ball(), [(0, 0, 6, 0, 0, -1), (0, 0.6, 6, 0, 0, -2), (0, 1.01, 6, 0, 0, -1), (0, 0, 0.5, 0, 1, 0)])
        self.assertEqual([list(answer) for answer in (hit, half, miss, inside)], [OF_HIT, OF_HIT, OF_MISS, OF_HIT])
        self.assertTrue(all(answer["certified"] for answer in (hit, half, miss, inside)))
        self.assertAlmostEqual(hit["t"], 5, 6)
        self.assertEqual((hit["object"], hit["material"]), ("ball", "skin"))
        self.assertAlmostEqual(half["t"], (6 - 0.8) / 2, 6)  # in lengths of the direction
        for found, wanted in zip(half["normal"], (0, 0.6, 0.8)):
            self.assertAlmostEqual(found, wanted, 6)
        self.assertGreater(math.hypot(*half["outside"]), 1)
        self.assertAlmostEqual(inside["t"], math.sqrt(0.75), 6)  # where it leaves

    def test_the_range_of_t_counts_in_lengths_of_the_direction(self):
        before, up_to, behind, endless = self.trace(
            self.ball(), [(0, 0, 6, 0, 0, -2, 0, 2.4), (0, 0, 6, 0, 0, -2, 0, 2.6), (0, 0, 6, 0, 0, -2, 2.6, 9),
                          (0, 0, 6, 0, 0, -2, 2.4, 1e308)])
        self.assertEqual([answer["hit"] for answer in (before, up_to, behind, endless)], [False, True, True, True])
        self.assertAlmostEqual(behind["t"], 3.5, 6)
        done = self.expect(0, "trace", "ball.yaml", "--rays", "-", stdin="0 0 6 0 0 -1 5.5 inf\n")
        self.assertAlmostEqual(json.loads(done.stdout)[0]["t"], 7, 6)

    def test_a_range_that_ends_where_the_ray_hits_holds_the_hit(self):
        random = Random(20261127)
        rays = [(0, 0, 0.5, *(random.gauss(0, 3) for _ in range(3))) for _ in range(500)]
        found = [answer["t"] for answer in self.trace(self.ball(), rays)]
        again = self.trace("ball.yaml", [(*ray, 0, t) for ray, t in zip(rays, found)])
        self.assertEqual([answer.get("t") for answer in again], found)
        below = [math.nextafter(t, 0) for t in found]
        for answer, end in zip(self.trace("ball.yaml", [(*ray, 0, t) for ray, t in zip(rays, below)]), below):
            self.assertLessEqual(answer.get("t", 0), end)

    def test_a_segment_of_millions_of_radii_is_met_where_it_is(self):
        self.write("long.yaml", """marrow: 1
objects:
  - name: wire
    field: {segment: {from: [-1e6, 0, 0], to: [1e6, 0, 0], radius: 0.01}}
""")
        beside = [0.0099 * (i - 50) / 50 for i in range(101)]
        rays = [(9e5 * math.sin(i), y, 5, 0, 0, -1) for i, y in enumerate(beside)]
        for answer, y in zip(self.trace("long.yaml", rays), beside):
            self.assertTrue(answer["hit"] and answer["certified"])
            self.assertAlmostEqual(answer["t"], 5 - math.sqrt(1e-4 - y * y), 7)

    def test_all_objects_of_the_scene_are_met(self):
        rays = [(0, 0, 6, 0, 0, -1), (2, 0, 6, 0, 0, -1), (9, 0, 0, 0, -1, 0), (9, 0, 0, 0, 1, 0)]
        scene = self.write("two.yaml", TWO_OBJECTS)
        self.assertEqual([a.get("object") for a in self.trace(scene, rays)], ["ball", "other", "floor", None])
        self.assertEqual([a["occluded"] for a in self.trace(scene, rays, "--occluded")], [True, True, True, False])
        self.assertEqual(self.trace(scene, []), [])

    def test_bits_depend_neither_on_threads_nor_on_instruction_sets_nor_on_company(self):
        scene = self.write("two.yaml", TWO_OBJECTS)
        rays = [(x / 7 - 2, y / 7 - 2, 6, 0.01 * y, 0, -1) for x in range(40) for y in range(40)]
        answers = self.trace(scene, rays)
        self.assertEqual(self.trace(scene, rays, "-t", "1"), answers)
        self.assertEqual([self.trace(scene, [ray])[0] for ray in rays[::197]], answers[::197])
        for name in ("sse4", "avx2", "avx512"):
            done = self.run_marrow("trace", scene, "--rays", "-", "--isa", name, stdin=rows(rays))
            self.assertIn(done.returncode, (0, 69))  # 69: this machine does not have it
            if done.returncode == 0:
                self.assertEqual(json.loads(done.stdout), answers)

    def test_what_is_not_proved_is_told(self):
        far = rows([(0, 0, 1e12, 0, 0, -1), (0, 0, 6, 0, 0, -1)])
        done = self.expect(0, "trace", self.ball(), "--rays", "-", stdin=far)
        self.assertEqual([answer["certified"] for answer in json.loads(done.stdout)], [False, True])
        self.assertIn("1 ray", done.stderr)
        self.expect(1, "trace", "ball.yaml", "--rays", "-", "--strict", stdin=far)

    def test_nothing_is_proved_where_rounding_moves_a_ray_past_a_body(self):
        far = rows([(0, 0, 9e12, 0, 0, -1), (0, 0, 100, 0, 0, -1), (0, 0, 100, 0, 0, 1)])
        done = self.expect(0, "trace", self.ball(), "--rays", "-", "-D", "objects.0.field.blend.of.0.point.radius=1e-6",
                           stdin=far)
        self.assertEqual([answer["certified"] for answer in json.loads(done.stdout)], [False, True, True])

    def test_bad_lines_are_all_told(self):
        lines = ["# ox oy oz dx dy dz", "0 0 6 0 0 -1", "0 0 6 0 0 0", "0 0 6 0 0 -1 2", "0 0 6 0 0 -1 -1 2",
                 "0 0 6 0 0 -1 3 2", "0 0 six 0 0 -1", "0 0 6 0 0 -1 inf 2", "0 0 3e16 0 0 -1"]
        self.write("rays.txt", "\n".join(lines))
        done = self.expect(65, "trace", self.ball(), "--rays", "rays.txt")
        for line in range(3, 10):
            self.assertIn(f"rays.txt:{line}:", done.stderr)
        self.assertNotIn("rays.txt:2:", done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertIn("gone.txt", self.expect(66, "trace", "ball.yaml", "--rays", "gone.txt").stderr)
        self.expect(2, "trace", "ball.yaml")

    def test_an_interrupted_list_is_still_json(self):
        self.write("rays.txt", rows([(0.001 * k, 0.37, 4, 0, 0.01, -1) for k in range(200000)]))
        out, told = self.interrupted("trace", self.write("rings.yaml", SLOW), "--rays", "rays.txt")
        self.assertLess(len(json.loads(out)), 200000)
        self.assertIn("of 200000 rays", told)


if __name__ == "__main__":
    unittest.main()
