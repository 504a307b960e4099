"""The picture, with every channel, is the same bytes however the work is done."""
import pathlib
import unittest

from marrow_program import ProgramTest

# Two blends that rays see past each other, a floor that reflects, lights of three kinds: paths take many ways.
SCENE = """\
marrow: 1
camera: {from: [0.4, 1.5, 7], to: [0, 0, 0], fov: 34}
film: {size: [72, 40]}
render: {spp: 16, seed: 5}
lights:
  - constant: {radiance: [0.4, 0.45, 0.5]}
  - sun: {direction: [0.4, 0.8, 0.5], irradiance: 2}
  - rectangle: {center: [2, 4, 3], normal: [-0.4, -0.8, -0.6], size: [2, 2], radiance: [12, 11, 10]}
materials:
  skin: {coated: {color: [0.8, 0.5, 0.4]}}
  gold: {conductor: {metal: gold, roughness: 0.3}}
  floor: {diffuse: {color: 0.6}}
objects:
  - name: branches
    material: skin
    field:
      blend:
        alpha: contact
        of:
          - point: {at: [-1, 0, 0], radius: 0.8}
          - segment: {from: [0.5, -0.4, 0], to: [2.2, 0.6, 0], radius: [0.5, 0.2]}
          - segment: {from: [-0.4, 0.1, 0.3], to: [1.4, 1.1, -0.3], radius: [0.3, 0.1]}
          - polyline: {points: [[-2, -1, 0.2], [-1.6, 0.9, 0.5], [0.2, 0.9, 0.9]], radius: 0.15}
  - name: sum
    material: gold
    field:
      transform:
        scale: [1, 1.4, 0.8]
        of: {blend: {alpha: sum, of: [{point: {at: [0, -0.7, 1.2], radius: 0.3}},
                                      {segment: {from: [0.4, -0.6, 1.4], to: [1.1, -0.4, 1.6], radius: 0.15}}]}}
  - name: floor
    material: floor
    plane: {point: [0, -1.2, 0], normal: [0, 1, 0]}
"""


def instruction_sets():
    flags = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")
    return ["sse4"] + [name for name, flag in (("avx2", " avx2 "), ("avx512", " avx512bw ")) if flag in flags]


class SameBitsTest(ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.expected = None

    def picture(self, *arguments):
        self.write("scene.yaml", SCENE)
        self.expect(0, "render", "scene.yaml", "-o", "a.exr", "--png", "a.png", "-q", *arguments, SOURCE_DATE_EPOCH="1")
        return (self.folder / "a.exr").read_bytes(), (self.folder / "a.png").read_bytes()

    def compare(self, ways):
        if self.expected is None:
            type(self).expected = self.picture("-t", "1")
        for way in ways:
            with self.subTest(way):
                self.assertTrue(self.picture(*way) == self.expected, f"{way} changes the picture")

    def test_threads(self):
        self.compare([["-t", n] for n in ("1", "2", "7")])

    def test_tiles(self):
        self.compare([["--tile", n] for n in ("1", "5", "32", "4096")])

    def test_cells_made_at_once_or_when_a_ray_needs_them(self):
        self.compare([["--eager"], ["--eager", "-t", "7", "--tile", "7"]])

    def test_instruction_sets_of_the_fields_and_of_embree(self):
        sets = instruction_sets()
        self.assertGreaterEqual(len(sets), 2, "nothing to compare on this machine")
        self.compare([["--isa", ours, "--embree-isa", embree] for ours in sets for embree in sets])

    def test_another_seed_is_another_picture(self):
        self.compare([])
        self.assertNotEqual(self.picture("--seed", "6")[0], self.expected[0])


if __name__ == "__main__":
    unittest.main()
