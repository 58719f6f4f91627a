"""Jobs and specimens: from files, text and dictionaries, with the program's own messages; cells as arrays."""

import os
import tempfile
import tomllib
import unittest
from pathlib import Path

import numpy as np

import feldspar
from small import rock


class Jobs(unittest.TestCase):
    def test_is_the_same_from_file_text_and_dictionary(self):
        of_dictionary = feldspar.job(rock(test=[{"kind": "biaxial", "sigma3": ["2 MPa", "4 MPa"]}, {"kind": "direct-tension"}], run={"seeds": [3, 4]}))
        of_text = feldspar.job(of_dictionary.text)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "job.toml")
            file.write_text(of_dictionary.text)
            of_file = feldspar.job(file)
        self.assertEqual(of_dictionary.resolved(), of_text.resolved())
        self.assertEqual(of_dictionary.resolved(), of_file.resolved())
        self.assertEqual([t["title"] for t in of_file.tests], ["biaxial at 2 MPa", "biaxial at 4 MPa", "direct-tension"])
        self.assertEqual(of_file.seeds, [3, 4])
        self.assertEqual(len(of_file.runs), 6)
        self.assertIs(feldspar.job(of_file), of_file)

    def test_every_template_can_be_written_as_a_dictionary_and_read_again(self):
        for kind in feldspar.template_kinds():
            text = feldspar.job_template(kind)
            self.assertEqual(feldspar.job(tomllib.loads(text), name="template.toml").resolved(), feldspar.Job.parse(text, "template.toml").resolved(), kind)

    def test_tells_all_mistakes_at_once(self):
        wrong = rock()
        wrong["material"]["contact"]["Kn"] = "18e4 GPa"
        wrong["specimen"]["hight"] = wrong["specimen"].pop("height")
        mistakes = feldspar.validate(wrong)
        keys = [m.key for m in mistakes]
        self.assertIn("material.contact.Kn", keys)
        self.assertIn("specimen.hight", keys)
        self.assertTrue(all(m.file == "<dict>" and m.line > 0 for m in mistakes if m.key in ("material.contact.Kn", "specimen.hight")))
        self.assertIn("height", next(m for m in mistakes if m.key == "specimen.hight").suggestion)
        with self.assertRaises(feldspar.InputError) as caught:
            feldspar.job(wrong)
        self.assertEqual(list(caught.exception.mistakes), mistakes)
        self.assertIsInstance(caught.exception, ValueError)
        self.assertIn("material.contact.Kn", str(caught.exception))
        self.assertEqual(feldspar.validate(rock()), [])

    def test_what_toml_cannot_hold_is_a_mistake_with_its_key(self):
        with self.assertRaises(feldspar.InputError) as caught:
            feldspar.job(rock(numerics={"accuracy": object()}))
        self.assertEqual(caught.exception.mistakes[0].key, "numerics.accuracy")

    def test_settings_go_over_file_text_and_dictionary(self):
        job = feldspar.job(rock(), settings={"material.contact.tau": "31 MPa", "test.UCS.plate_mu": 0.3})
        self.assertIn('tau = "3.1e+07 Pa"', job.resolved())
        self.assertEqual(job.resolved(), feldspar.job(feldspar.job(rock()).text.replace("29.75 MPa", "31 MPa"), settings=["test.plate_mu=0.3"], name="<dict>").resolved())
        with self.assertRaises(feldspar.InputError) as caught:
            feldspar.job(rock(), settings={"material.contact.taw": 1})
        self.assertIn("tau", str(caught.exception))
        with self.assertRaises(feldspar.InputError):
            feldspar.job(job, settings={"numerics.accuracy": "1 %"})

    def test_a_missing_file_is_an_input_error(self):
        with self.assertRaises(feldspar.InputError):
            feldspar.job("no-such-job.toml")

    def test_picks_tests_by_kind_title_and_number(self):
        job = feldspar.job(rock(test=[{"kind": "biaxial", "sigma3": ["2 MPa", "4 MPa"]}, {"kind": "direct-tension"}]))
        self.assertEqual([t["title"] for t in job.part(["biaxial at 4 MPa"]).tests], ["biaxial at 4 MPa"])
        self.assertEqual([t["title"] for t in job.part([-1]).tests], ["direct-tension"])
        with self.assertRaises(feldspar.InputError) as caught:
            job.part(["biaxal"])
        self.assertIn("biaxial", caught.exception.mistakes[0].suggestion)
        with self.assertRaises(feldspar.InputError) as caught:
            feldspar.run(job, "biaxial")
        self.assertIn("biaxial at 2 MPa", caught.exception.mistakes[0].allowed)

    def test_reads_quantities_as_jobs_do(self):
        self.assertEqual(feldspar.parse_quantity("25.8 GPa", "stress"), 25.8e9)
        with self.assertRaises(feldspar.InputError):
            feldspar.parse_quantity("25.8 GPa", "length")
        with self.assertRaises(feldspar.InputError):
            feldspar.parse_quantity("25.8 GPa", "colour")

    def test_knows_methods_and_first_parameters(self):
        self.assertIn("brazilian", feldspar.methods())
        text, warnings = feldspar.first_job("uniaxial-compression", {"UCS": "120 MPa", "E": "30 GPa", "BTS": "9 MPa"})
        self.assertEqual(feldspar.job(text).laboratory["UCS"], 120e6)
        self.assertIsInstance(warnings, list)


class Specimens(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.job = feldspar.job(rock())
        cls.specimen = cls.job.specimen()

    def test_cells_fill_the_outline(self):
        s = self.specimen
        self.assertEqual(len(s), len(s.polygons))
        self.assertAlmostEqual(s.areas.sum() / (0.018 * 0.036), 1.0, places=12)
        self.assertAlmostEqual(s.area, 0.018 * 0.036, places=12)
        for polygon, cell in zip(s.polygons, s.cells):
            np.testing.assert_array_equal(polygon, s.vertices[cell])
        x, y = s.polygons[0].T
        self.assertAlmostEqual(0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / s.areas[0], 1.0, places=9)

    def test_neighbours_are_mutual(self):
        neighbours = self.specimen.neighbours
        for cell, others in enumerate(neighbours):
            for other in others[others >= 0]:
                self.assertIn(cell, neighbours[other])
        self.assertEqual(len(self.specimen.contacts), sum((n >= 0).sum() for n in neighbours) // 2)

    def test_triangles_fill_the_cells(self):
        s = self.specimen
        a, b, c = (s.nodes[s.triangles[:, k]] for k in range(3))
        areas = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
        self.assertTrue((areas > 0.0).all())
        np.testing.assert_allclose(np.bincount(s.triangle_cells, weights=areas), s.areas, rtol=1e-9)

    def test_arrays_are_views_that_cannot_be_written_and_outlive_the_specimen(self):
        s = self.job.specimen()
        for array in (s.vertices, s.nodes, s.triangles, s.neighbours[0], s.disc_centres, s.disc_radii):
            self.assertFalse(array.flags.owndata)
            self.assertFalse(array.flags.writeable)
        self.assertEqual(s.nodes.ctypes.data, s.nodes.ctypes.data)
        nodes, copy = s.nodes, s.nodes.copy()
        del s
        np.testing.assert_array_equal(nodes, copy)
        with self.assertRaises(ValueError):
            nodes[0, 0] = 1.0

    def test_the_same_seed_gives_the_same_bits_without_a_job_too(self):
        alone = feldspar.specimen(rock()["specimen"], seed=1)
        np.testing.assert_array_equal(alone.nodes, self.specimen.nodes)
        other = feldspar.specimen(rock()["specimen"], seed=2)
        self.assertFalse(np.array_equal(other.nodes, self.specimen.nodes))
        with self.assertRaises(feldspar.InputError):
            feldspar.specimen(shape="rectangle", width="1 mm", height="36 mm", grains={"diameter": {"distribution": "uniform", "minimum": "2 mm", "maximum": "4 mm"}})

    def test_phases_are_the_minerals_of_the_job(self):
        self.assertEqual(self.specimen.phase_names, ["rock"])
        with Path(os.environ["FELDSPAR_SOURCE_DIR"], "examples/granite/job.toml").open("rb") as file:
            granite = tomllib.load(file)
        granite["specimen"].update(width="30 mm", height="60 mm")
        s = feldspar.job(granite).specimen("uniaxial-compression")
        self.assertEqual(s.phase_names, ["quartz", "K-feldspar", "plagioclase", "biotite"])
        shares = np.bincount(s.phases, weights=s.areas, minlength=4) / s.area
        np.testing.assert_allclose(shares, [0.31, 0.27, 0.38, 0.04], atol=0.05)   # to within a grain or two of some 150

    def test_is_saved_for_other_programs(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("cells.tess", "cells.msh", "cells.csv", "packing.txt"):
                self.specimen.save(os.path.join(folder, name))
                self.assertGreater(os.path.getsize(os.path.join(folder, name)), 500)
            again = feldspar.specimen(shape="rectangle", width="18 mm", height="36 mm", grains={"file": os.path.join(folder, "cells.tess"), "unit": "1 m"})
            self.assertEqual(len(again), len(self.specimen))
            with self.assertRaises(feldspar.InputError):
                self.specimen.save(os.path.join(folder, "cells.docx"))
            with self.assertRaises(feldspar.OutputError):
                self.specimen.save(os.path.join(folder, "no", "cells.csv"))


if __name__ == "__main__":
    unittest.main()
