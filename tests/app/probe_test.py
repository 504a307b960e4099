"""Numbers of a field, against a closed form: a point of radius 1 and degree 4 has f = (1/d)^3."""
import json
import math
import unittest

from marrow_program import POINT, SLOW, TWO_OBJECTS, ProgramTest

POINTS = [(0.5, 0, 0), (0, 2, 0), (1, 1, 1), (-3, 0.25, 1e-3)]
BASIC = ["point", "value", "gradient", "iso", "inside"]
OF_BLEND = ["sum", "sum_gradient", "si_gradient", "si_norm", "alpha", "corrected", "corrected_gradient"]

OF_CURVATURE = ["sum_hessian", "hessian", "mean_curvature", "gaussian_curvature"]


class ProbeTest(ProgramTest):
    def probe(self, scene, points, *arguments):
        text = "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in points)
        return json.loads(self.expect(0, "probe", scene, "--points", "-", *arguments, stdin=text).stdout)

    def assert_near(self, found, wanted):
        self.assertLessEqual(abs(found - wanted), 1e-13 * abs(wanted), f"{found} is not {wanted}")

    def test_a_single_point_is_the_closed_form(self):
        answers = self.probe(self.write("point.yaml", POINT), POINTS, "--object", "ball", "--format", "json")
        self.assertEqual(len(answers), len(POINTS))
        for point, answer in zip(POINTS, answers):
            distance = math.sqrt(sum(x * x for x in point))
            self.assertEqual(list(answer), BASIC + OF_BLEND)
            self.assertEqual(answer["point"], list(point))
            self.assert_near(answer["sum"], distance**-3)
            self.assertEqual(answer["value"], answer["corrected"])
            self.assertEqual(answer["gradient"], answer["corrected_gradient"])
            self.assertEqual(answer["inside"], answer["value"] > answer["iso"])
            along = sum(g * x for g, x in zip(answer["sum_gradient"], point)) / distance
            self.assert_near(along, -3 * distance**-4)

    def test_curvature_is_that_of_a_ball(self):
        for point, answer in zip(POINTS, self.probe(self.write("point.yaml", POINT), POINTS, "--curvature")):
            self.assertEqual(list(answer), BASIC + OF_BLEND + OF_CURVATURE)
            distance = math.sqrt(sum(x * x for x in point))
            self.assertAlmostEqual(answer["mean_curvature"] * distance, 1, 11)
            self.assertAlmostEqual(answer["gaussian_curvature"] * distance**2, 1, 11)
            # f = 1/d^3: the trace of its Hessian is 6 / d^5
            self.assertAlmostEqual(sum(answer["sum_hessian"][k][k] for k in range(3)) * distance**5 / 6, 1, 9)

    def test_curvature_of_any_field(self):
        answer = self.probe(self.write("two.yaml", TWO_OBJECTS), [(2, 0.5, 0)], "--object", "other", "--curvature")[0]
        self.assertEqual(list(answer), BASIC + OF_CURVATURE[1:])
        self.assertAlmostEqual(answer["mean_curvature"] * 0.5, 1, 9)

    def test_materials_share_the_field(self):
        two = POINT.replace("  skin:", "  moss: {diffuse: {color: 0.2}}\n  skin:")
        two += "          - point: {at: [2, 0, 0], radius: 1, material: moss}\n"
        middle, near = self.probe(self.write("two.yaml", two), [(1, 1, 0), (0.5, 0, 0)], "--materials")
        self.assertEqual(list(middle), BASIC + OF_BLEND + ["materials"])
        self.assert_near(middle["materials"]["skin"], 0.5)
        self.assert_near(middle["materials"]["moss"], 0.5)
        self.assert_near(near["materials"]["skin"], 0.5**-3 / (0.5**-3 + 1.5**-3))

    def test_numbers_survive_the_text(self):
        scene = self.write("point.yaml", POINT)
        self.assertEqual(self.probe(scene, POINTS), self.probe(scene, POINTS))
        self.assertEqual(self.probe(scene, []), [])

    def test_a_union_has_no_blend_to_tell_of(self):
        answer = self.probe(self.write("two.yaml", TWO_OBJECTS), POINTS[:1], "--object", "other")[0]
        self.assertEqual(list(answer), BASIC)

    def test_on_the_skeleton_the_answer_is_still_json(self):
        answer = self.probe(self.write("point.yaml", POINT), [(0, 0, 0)])[0]
        self.assertEqual(answer["sum"], math.inf)
        self.assertTrue(answer["inside"])

    def test_on_a_skeleton_under_an_operator_slopes_are_zero(self):
        ball = "{blend: {of: [{point: {at: [0, 0, 0], radius: 0.3}}]}}"
        for operator in ("restricted_blend", "sharp_union", "soft_union", "sum", "ricci", "contact"):
            for of in (f"{ball}, {{sphere: {{center: [0.1, 0, 0], radius: 0.4}}}}", f"{ball}, {ball}"):
                scene = self.write("pole.yaml", f"marrow: 1\nobjects:\n  - field: {{{operator}: {{of: [{of}]}}}}\n")
                answer, = self.probe(scene, [(0, 0, 0)])
                self.assertEqual((answer["value"], answer["gradient"]), (math.inf, [0, 0, 0]), operator)

    def test_an_interrupted_list_is_still_json(self):
        self.write("points.txt", "".join(f"{0.001 * k} 0.37 0.1\n" for k in range(200000)))
        out, told = self.interrupted("probe", self.write("rings.yaml", SLOW), "--points", "points.txt", "--curvature")
        self.assertLess(len(json.loads(out)), 200000)
        self.assertIn("of 200000 points", told)

    def test_the_answer_does_not_depend_on_threads(self):
        scene = self.write("two.yaml", TWO_OBJECTS)
        points = [(0.001 * k, 0.5, 0.1) for k in range(5000)]
        one, two = (self.probe(scene, points, "--object", "other", "-t", n) for n in "12")
        self.assertEqual(one, two)
        self.assertEqual([answer["point"] for answer in one], [list(p) for p in points])

    def test_bad_lines_are_all_told(self):
        scene = self.write("point.yaml", POINT)
        self.write("points.txt", "# x y z\n0 0 1\n\n1 two 3\n1 2\n1 2 3 4\nnan 0 0\n")
        done = self.expect(65, "probe", scene, "--object", "ball", "--points", "points.txt")
        for line in (4, 5, 6, 7):
            self.assertIn(f"points.txt:{line}:", done.stderr)
        self.assertEqual(done.stdout, "")

    def test_objects_are_chosen_by_name(self):
        scene = self.write("two.yaml", TWO_OBJECTS)
        self.assertIn("`other`", self.expect(2, "probe", scene, "--object", "othr", "--points", "-").stderr)
        self.assertIn("not a field", self.expect(2, "probe", scene, "--object", "floor", "--points", "-").stderr)
        self.expect(2, "probe", scene, "--points", "-")
        self.assertIn("gone.txt", self.expect(66, "probe", scene, "--object", "ball", "--points", "gone.txt").stderr)


if __name__ == "__main__":
    unittest.main()
