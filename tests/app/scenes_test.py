"""Every scene that is shipped loads without a word, and the page of figures shows each of its figures."""
import re
import unittest

from marrow_program import SOURCE, ProgramTest

SCENES = SOURCE / "scenes"
PAGE = SOURCE / "docs" / "figures.md"


def scenes(folder):
    """All but what others include: a file of materials and definitions has no objects."""
    return [path for path in sorted((SCENES / folder).glob("*.yaml"))
            if re.search(r"^objects:", path.read_text("utf-8"), re.M)]


class ScenesTest(ProgramTest):
    def test_every_scene_is_without_mistakes_and_warnings(self):
        for folder in ("figures", "gallery", "regression"):
            all_of_it = scenes(folder)
            self.assertTrue(all_of_it, folder)
            for path in all_of_it:
                with self.subTest(scene=path.name):
                    done = self.expect(0, "check", str(path))
                    self.assertRegex(done.stdout, r": ok: ")
                    self.assertEqual(done.stderr, "")

    def test_the_page_shows_every_figure_with_a_command_that_names_it(self):
        page = PAGE.read_text("utf-8")
        for path in scenes("figures"):
            with self.subTest(scene=path.name):
                self.assertIn(f"scenes/figures/{path.name}", page)
                pictures = re.findall(rf"\(figures/({path.stem}\w*\.jpg)\)", page)
                self.assertTrue(pictures, "no picture of it")
                for picture in pictures:
                    self.assertLess((PAGE.parent / "figures" / picture).stat().st_size, 30_000, picture)

    def test_every_figure_says_where_it_is_from(self):
        for path in scenes("figures"):
            with self.subTest(scene=path.name):
                self.assertRegex(path.read_text("utf-8"), r"\A# (Zanni|Cani|Angelidis|De Groot).* (2001|2002|2003|2015), Fig\. ")


if __name__ == "__main__":
    unittest.main()
