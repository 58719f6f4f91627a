"""Tests and jobs that are run: the same bits as the program's, views without copies, Ctrl-C, errors."""

import _thread
import os
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import numpy as np

import feldspar
from small import pressed, rock


class OneTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.job = feldspar.job(rock())
        cls.result = feldspar.run(cls.job)

    def test_has_what_a_laboratory_reports(self):
        p = self.result.properties
        self.assertTrue(20.0 < p["strength_MPa"] < 400.0)
        self.assertTrue(10.0 < p["E_GPa"] < 40.0)
        self.assertTrue(0.05 < p["nu"] < 0.5)
        self.assertTrue(p["peak_reached"])
        self.assertNotIn("BTS_split", p, "a number of another method")
        self.assertIn(self.result.grade, "ABC")
        self.assertGreater(len(self.result.verdict), 20)
        self.assertGreater(self.result.evidence["error_estimate"], 0.0)
        self.assertAlmostEqual(self.result.energies["energy_residual_at_end_J"], 0.0, delta=1e-3 * self.result.energies["energy_external_J"])
        self.assertGreater(self.result.costs["steps"], 0)

    def test_history_has_names_units_and_meanings(self):
        h, si = self.result.history, self.result.history_si
        self.assertEqual(h.unit("axial_stress_MPa"), "MPa")
        self.assertEqual(si.unit("axial_stress"), "Pa")
        self.assertIn("platens", h.meaning("axial_stress_MPa"))
        np.testing.assert_allclose(h["axial_stress_MPa"], 1e-6 * si["axial_stress"], rtol=1e-12)
        self.assertEqual(h["step"].dtype, np.int64)
        self.assertAlmostEqual(h["axial_stress_MPa"].max(), self.result.properties["strength_MPa"], places=6)
        with self.assertRaises(KeyError) as caught:
            h["axial_stress"]
        self.assertIn("axial_stress_MPa", str(caught.exception))

    def test_si_columns_cracks_and_fields_are_views(self):
        for array in (self.result.history_si["axial_stress"], self.result.cracks["place"], self.result.cracks["step"], self.result.snapshot("end").displacement, self.result.snapshot("end").damage):
            self.assertFalse(array.flags.owndata)
            self.assertFalse(array.flags.writeable)
        first, second = self.result.history_si["axial_stress"], self.result.history_si["axial_stress"]
        self.assertEqual(first.ctypes.data, second.ctypes.data, "the record itself")

    def test_cracks_lie_in_the_specimen_and_carry_their_modes(self):
        cracks = self.result.cracks
        self.assertEqual((cracks["mode"] == 0).sum(), self.result.properties["cracks_tensile"])
        self.assertEqual((cracks["mode"] == 1).sum(), self.result.properties["cracks_shear"])
        self.assertTrue((cracks["place"] >= -1e-9).all() and (cracks["place"] <= [0.018 + 1e-9, 0.036 + 1e-9]).all())
        self.assertTrue((np.diff(cracks["step"]) >= 0).all())
        self.assertEqual(self.result.snapshot("end").cracks, cracks.rows)

    def test_fields_fit_the_specimen(self):
        end, s = self.result.snapshot("end"), self.result.specimen
        self.assertEqual(end.displacement.shape, s.nodes.shape)
        self.assertEqual(len(end.stress_yy), len(s.triangles))
        self.assertEqual([x.label for x in self.result.snapshots][-1], "end")
        with self.assertRaises(feldspar.InputError):
            self.result.snapshot("never")

    def test_emission_gathers_all_cracks(self):
        e = self.result.emission
        self.assertEqual(e["events"]["cracks"].sum(), self.result.cracks.rows)
        self.assertEqual(e["events"].unit("energy_J"), "J")

    def test_has_the_bits_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "job.toml").write_text(self.job.text)
            subprocess.run([os.environ["FELDSPAR_PROGRAM"], "run", "job.toml", "--out", "out"], cwd=folder, check=True, capture_output=True)
            theirs = feldspar.read_run(Path(folder, "out")).tests[0].history
        ours = self.result.history
        self.assertEqual(list(ours), list(theirs))
        for name in ours:
            np.testing.assert_array_equal(ours[name], theirs[name], err_msg=name)

    def test_has_the_same_bits_for_any_number_of_threads(self):
        other = feldspar.run(self.job, threads=3)
        np.testing.assert_array_equal(other.history_si["axial_stress"], self.result.history_si["axial_stress"])

    def test_is_saved_and_nothing_is_written_over(self):
        with tempfile.TemporaryDirectory() as folder:
            self.result.save(folder)
            self.assertTrue(Path(folder, "history-uniaxial-compression-s1.csv").exists())
            with self.assertRaises(feldspar.InputError):
                self.result.save(folder)


class Jobs(unittest.TestCase):
    def test_has_properties_over_packings_and_an_envelope(self):
        job = feldspar.job(rock(test=[{"kind": "uniaxial-compression", "stop_fraction": 0.9}, {"kind": "biaxial", "sigma3": ["5 MPa"], "stop_fraction": 0.9}], run={"seeds": [1, 2]}))
        events = []
        found = feldspar.run_job(job, progress=events.append)
        self.assertEqual(len(found), 4)
        self.assertEqual(found.properties["UCS_MPa"]["seeds"], [1, 2])
        self.assertEqual(len(found.properties["UCS_MPa"]["values"]), 2)
        self.assertEqual(found.properties["UCS_MPa"]["unit"], "MPa")
        self.assertEqual([f["seed"] for f in found.envelope["fits"]], [1, 2])
        self.assertIsNone(found.directory)
        self.assertEqual(len([e for e in events if e["event"] == "finished"]), 4)
        alone = feldspar.run(job, "biaxial", seed=2)
        np.testing.assert_array_equal(alone.history_si["axial_stress"], found.of(kind="biaxial", seed=2)[0].history_si["axial_stress"])
        properties, envelope = feldspar.summarise(found.results)
        self.assertEqual(properties, found.properties)
        self.assertEqual(envelope, found.envelope)

    def test_writes_what_the_program_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            place = os.path.join(folder, "out")
            found = feldspar.run_job(rock(), place)
            self.assertEqual(found.directory, place)
            for name in ("report.html", "summary.json", "history-uniaxial-compression-s1.csv", "uniaxial-compression-s1.h5"):
                self.assertTrue(os.path.exists(os.path.join(place, name)), name)
            with self.assertRaises(feldspar.InputError):
                feldspar.run_job(rock(), place)

    def test_a_test_that_fails_is_told_and_the_others_are_kept(self):
        slow = rock(numerics={"kind": "dynamic", "speed": "1 m/s", "time_step": "1 s"})
        with self.assertRaises(feldspar.InputError) as caught:
            feldspar.run(slow)
        self.assertEqual(caught.exception.mistakes[0].key, "numerics.time_step")
        found = feldspar.run_job(slow)
        self.assertEqual(len(found), 0)
        self.assertIn("unstable", found.failed[0]["reason"])


class Interruption(unittest.TestCase):
    # Ctrl-C as Python does it: the flag of the main thread.
    def interrupt_soon(self, seconds):
        timer = threading.Timer(seconds, _thread.interrupt_main)
        timer.start()
        self.addCleanup(timer.cancel)

    def test_ctrl_c_ends_a_test_cleanly_with_what_there_is(self):
        long = rock(numerics={"accuracy": "0.1 %"}, specimen={**rock()["specimen"], "width": "40 mm", "height": "80 mm"})
        started = threading.Event()

        def progress(event):
            if not started.is_set() and event["stage"] == "loading" and event["step"] > 0:
                started.set()
                _thread.interrupt_main()

        with self.assertRaises(feldspar.Interrupted) as caught:
            feldspar.run(long, progress=progress)
        self.assertIsInstance(caught.exception, KeyboardInterrupt)
        self.assertTrue(caught.exception.result.interrupted)
        self.assertGreater(caught.exception.result.history.rows, 0)

    def test_ctrl_c_ends_the_making_of_a_specimen(self):
        self.interrupt_soon(0.3)
        began = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            feldspar.specimen(shape="rectangle", width="400 mm", height="800 mm", grains=rock()["specimen"]["grains"])
        self.assertLess(time.monotonic() - began, 60.0, "a packing of 30,000 grains takes longer than the wait for its end")

    def test_others_may_compute_meanwhile(self):
        counted = 0
        done = threading.Event()

        def count():
            nonlocal counted
            while not done.is_set():
                counted += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        feldspar.run(rock())
        done.set()
        thread.join()
        self.assertGreater(counted, 20, "the interpreter was free")


if __name__ == "__main__":
    unittest.main()
