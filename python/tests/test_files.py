"""Results of earlier runs and of studies, as tables and frames."""

import json
import os
import tempfile
import unittest
from pathlib import Path

import numpy as np

import feldspar
from small import rock

try:
    import pandas
except ImportError:
    pandas = None
try:
    import h5py
except ImportError:
    h5py = None
try:
    import pyvista
except ImportError:
    pyvista = None


class Runs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.place = os.path.join(cls.folder.name, "out")
        cls.job = feldspar.job(rock())
        cls.live = feldspar.run_job(cls.job, cls.place)
        cls.run_ = feldspar.read_run(cls.place)

    def test_a_history_is_that_of_the_live_result(self):
        theirs, ours = self.run_.test("uniaxial-compression").history, self.live[0].history
        for name in ours:
            np.testing.assert_array_equal(theirs[name], ours[name], err_msg=name)
            self.assertEqual((theirs.unit(name), theirs.meaning(name)), (ours.unit(name), ours.meaning(name)))
        events = self.run_.test("uniaxial-compression").events
        self.assertEqual(events.rows, self.live[0].emission["events"].rows)

    def test_knows_properties_job_and_verdict(self):
        self.assertTrue(self.run_.complete)
        self.assertTrue(self.run_.report.is_file())
        self.assertEqual(self.live.report, self.run_.report)
        self.assertAlmostEqual(self.run_.properties["UCS_MPa"]["median"], self.live.properties["UCS_MPa"]["median"], places=9)
        self.assertEqual(self.run_.job.resolved(), self.job.resolved())
        self.assertEqual(self.run_.tests[0].verdict, self.live[0].verdict)
        self.assertEqual(self.run_.tests[0].grade, self.live[0].grade)

    def test_what_is_not_there_is_told_with_what_is(self):
        with self.assertRaises(feldspar.InputError) as caught:
            self.run_.test("brazilian")
        self.assertIn("uniaxial-compression (seed 1)", str(caught.exception))
        with self.assertRaises(feldspar.InputError):
            feldspar.read_run(self.folder.name)

    @unittest.skipIf(pandas is None, "pandas is not installed")
    def test_frames_of_pandas(self):
        frame = self.run_.frame()
        self.assertEqual(list(frame["kind"]), ["uniaxial-compression"])
        self.assertAlmostEqual(frame["peak_stress_MPa"][0], self.live[0].properties["strength_MPa"], places=9)
        history = self.run_.histories()
        self.assertEqual(len(history), self.live[0].history.rows)
        self.assertEqual(list(history.columns[:3]), ["test", "variant", "seed"])
        self.assertEqual(self.live[0].history.frame().attrs["units"]["axial_stress_MPa"], "MPa")
        self.assertIn("place_x", self.live[0].cracks.frame().columns)
        self.assertEqual(list(self.live.frame()["seed"]), [1])
        self.assertIn("UCS_MPa", self.live.properties_frame().index)

    @unittest.skipIf(h5py is None, "h5py is not installed")
    def test_cracks_of_the_archive_are_those_of_the_live_result(self):
        theirs, ours = self.run_.tests[0].cracks, self.live[0].cracks
        for name in ours:
            np.testing.assert_array_equal(theirs[name], ours[name], err_msg=name)
        with self.run_.tests[0].archive() as archive:
            self.assertIn("snapshots", archive)

    def test_meshes_of_pyvista_or_a_clear_word(self):
        from feldspar.meshes import mesh

        if pyvista is None:
            with self.assertRaises(feldspar.MissingPackage) as caught:
                mesh(self.live[0])
            self.assertIn("pip install pyvista", str(caught.exception))
            self.assertIsInstance(caught.exception, ImportError)
            return
        grid = mesh(self.live[0], "peak", scale=10.0)
        self.assertEqual(grid.n_cells, len(self.live[0].specimen.triangles))
        self.assertEqual(self.run_.tests[0].fields().n_cells, grid.n_cells)

    def test_fields_for_paraview(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.run_.export_paraview(folder), Path(folder))
            collection = list(Path(folder).glob("*.pvd"))
            self.assertEqual(len(collection), 1)
            self.assertTrue(list(Path(folder).glob("*/grains-*.vtu")))


class Studies(unittest.TestCase):
    def test_a_study_runs_goes_on_and_is_read_as_frames(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "job.toml").write_text(feldspar.job(rock(test=[{"kind": "uniaxial-compression", "stop_fraction": 0.9}])).text)
            Path(folder, "study.toml").write_text('job = "job.toml"\nseeds = [1, 2]\n[[axis]]\nname = "tau"\nkey = "material.contact.tau"\nvalues = ["20 MPa", "40 MPa"]\n')
            study = feldspar.study(Path(folder, "study.toml"), results=Path(folder, "results"))
            self.assertEqual((study.axes, len(study), study.points), (["tau"], 4, [["20 MPa"], ["40 MPa"]]))
            events = []
            done = feldspar.run_study(study, progress=events.append)
            self.assertEqual((done["done"], done["failed"], done["left"]), (4, 0, 0))
            self.assertEqual(len([e for e in events if e["event"] == "finished"]), 4)
            again = feldspar.run_study(study, progress=None)
            self.assertEqual((again["done"], again["found_done"]), (0, 4))
            self.assertTrue(os.path.exists(study.page))
            if pandas is None:
                with self.assertRaises(feldspar.MissingPackage):
                    feldspar.ledger(study)
                return
            points, runs = feldspar.ledger(study), feldspar.ledger(study, runs=True)
            self.assertEqual((len(points), len(runs)), (2, 4))
            self.assertLess(points.filter(like="UCS").iloc[0, 0], points.filter(like="UCS").iloc[1, 0], "cohesion makes strength")

    def test_settings_go_over_a_study_and_make_other_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "job.toml").write_text(feldspar.job(rock()).text)
            Path(folder, "study.toml").write_text('job = "job.toml"\nseeds = [1]\n[[axis]]\nname = "tau"\nkey = "material.contact.tau"\nvalues = ["20 MPa", "40 MPa"]\n')
            read = lambda **keys: feldspar.study(Path(folder, "study.toml"), results=Path(folder, "results"), **keys)
            done = feldspar.run_study(read(settings={"numerics.accuracy": "8 %", "test.UCS.stop_fraction": 0.9}), progress=None)
            self.assertEqual(done["done"], 2)
            self.assertEqual(read(settings=["numerics.accuracy=8%", "test.UCS.stop_fraction=0.9"]).status()["done"], 2, "the same runs")
            self.assertEqual(read().status(), {"runs": 2, "done": 0, "running": 0, "failed": 0, "left": 2, "failures": []})
            points = json.loads(read(settings={"numerics.accuracy": "8 %", "test.UCS.stop_fraction": 0.9}).results_json())["points"]
            self.assertLess(points[0]["properties"]["UCS_MPa"]["mean"], points[1]["properties"]["UCS_MPa"]["mean"])
            with self.assertRaises(feldspar.InputError) as caught:
                read(settings={"material.contact.tau": "30 MPa"})
            self.assertIn("the axis 'tau' varies this key", str(caught.exception))

    def test_mistakes_of_a_study_and_a_calibration_arrive(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "study.toml").write_text("jib = 1\n")
            with self.assertRaises(feldspar.InputError) as caught:
                feldspar.study(Path(folder, "study.toml"))
            self.assertIn("jib", str(caught.exception))
            with self.assertRaises(feldspar.InputError):
                feldspar.calibrate(Path(folder, "none.toml"))

class Findings(unittest.TestCase):
    """Envelopes, convergences and claims: small ones, as the program makes them."""

    def test_an_envelope_runs_and_goes_on(self):
        with tempfile.TemporaryDirectory() as folder:
            job = feldspar.job(rock(), settings={"numerics.accuracy": "10 %"})
            events = []
            found = feldspar.envelope(job, seeds=2, sigma3=["3 MPa", 9e6], results=Path(folder, "results"), progress=events.append)
            self.assertEqual(found["executed"]["done"], 10, "uniaxial, two biaxial, tension, Brazilian on two packings")
            self.assertEqual(len(found["envelopes"][0]["strengths"]), 3)
            self.assertTrue(os.path.exists(found["page"]))
            self.assertEqual(len([e for e in events if e["event"] == "finished"]), 10)
            again = feldspar.envelope(job, seeds=2, sigma3=["3 MPa", "9 MPa"], results=Path(folder, "results"), progress=None)
            self.assertEqual((again["executed"]["done"], again["executed"]["found_done"]), (0, 10))
            self.assertEqual(again["envelopes"], found["envelopes"])

    def test_a_convergence_judges_every_axis(self):
        with tempfile.TemporaryDirectory() as folder:
            job = feldspar.job(rock(test=[{"kind": "direct-tension"}], numerics={"accuracy": "10 %"}))
            found = feldspar.converge(job, seeds=2, tests=["DTS"], within=0.1, results=Path(folder, "results"), progress=None)
            self.assertEqual(len(found["axes"]), 4, "grains, specimen, triangles, rate")
            self.assertTrue(all(axis["verdict"]["words"] for axis in found["axes"]))
            self.assertTrue(os.path.exists(found["page"]))

    def test_mistakes_arrive_before_anything_is_written(self):
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder, "results")
            for wrong in (dict(sigma3=["5 mm"]), dict(sigma3=[0.0])):
                with self.assertRaises(feldspar.InputError) as caught:
                    feldspar.envelope(rock(), results=place, **wrong)
                self.assertIn("sigma3", str(caught.exception))
            with self.assertRaises(feldspar.InputError):
                feldspar.converge(rock(), within=2.0, results=place)
            self.assertFalse(place.exists())

    def test_claims_are_held_against_ledgers(self):
        folder = Path(os.environ["FELDSPAR_SOURCE_DIR"], "studies", "paper")
        with tempfile.TemporaryDirectory() as nothing:
            found = feldspar.claims(folder, results=Path(nothing, "none"))
        self.assertEqual(len({claim["id"] for claim in found}), len(found))
        self.assertTrue(all(claim["verdict"] in ("not run", "not evaluated") for claim in found), "there is no ledger")
        self.assertTrue(all(claim["says"] and claim["statements"] for claim in found))


if __name__ == "__main__":
    unittest.main()
