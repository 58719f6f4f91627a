"""Tests that are watched and led from Python."""

import gc
import unittest

import numpy as np

import feldspar
from feldspar import Stage
from small import pressed, rock


def same_bits(test, a, b):
    test.assertEqual(len(a.history_si["step"]), len(b.history_si["step"]))
    for name in a.history_si:
        x, y = a.history_si[name], b.history_si[name]
        test.assertTrue(np.array_equal(x, y), name)
    np.testing.assert_array_equal(a.cracks["step"], b.cracks["step"])
    np.testing.assert_array_equal(a.snapshot("end").displacement, b.snapshot("end").displacement)


class Watching(unittest.TestCase):
    def test_changes_no_bit_and_sees_the_state(self):
        job = feldspar.job(rock())
        seen = []

        def look(state):
            self.assertEqual(state.displacement.shape, state.node_places.shape)
            self.assertEqual(state.displacement.shape, state.velocity.shape)
            for array in (state.displacement, state.velocity, state.force, state.bond_damage, state.bond_normal_force, state.contact_bodies, state.point_bonds):
                self.assertFalse(array.flags.owndata)
                self.assertFalse(array.flags.writeable)
            self.assertTrue((state.bond_damage >= 0.0).all() and (state.bond_damage <= 1.0).all())
            broken = int((state.bond_damage[state.point_bonds] >= 1.0).sum())
            self.assertGreaterEqual(broken, 0)
            seen.append((state.step, state.axial_strain, state.axial_stress, state.cracks_tensile + state.cracks_shear))

        watched = feldspar.run(job, callback=look, every=50)
        same_bits(self, watched, feldspar.run(job))
        history = watched.history_si
        self.assertGreater(len(seen), 5)
        last = [row for row in seen if row[0] in history["step"]][-1]
        row = int(np.flatnonzero(history["step"] == last[0])[-1])
        self.assertEqual(last[1:3], (history["axial_strain"][row], history["axial_stress"][row]))

    def test_fields_are_those_that_a_result_keeps(self):
        job = feldspar.job(rock())
        kept = {}

        def look(state):
            kept["displacement"], kept["stresses"] = state.mesh_displacement(), state.stresses()
            kept["direct"] = np.array(state.displacement[state.mesh_nodes])
            if state.axial_strain > 1e-3:
                state.stop("far enough")

        result = feldspar.run(job, callback=look)
        self.assertEqual(result.stop_reason, "far enough")
        end = result.snapshot("end")
        np.testing.assert_array_equal(kept["displacement"], end.displacement)
        np.testing.assert_array_equal(kept["direct"], end.displacement)
        np.testing.assert_array_equal(kept["stresses"][:, 1], end.stress_yy)
        mean = np.average(kept["stresses"][:, 1], weights=None)
        self.assertAlmostEqual(mean / result.history_si["axial_stress"][-1], 1.0, delta=0.2)

    def test_false_ends_the_test(self):
        result = feldspar.run(rock(), callback=lambda state: state.axial_strain < 5e-4)
        self.assertEqual(result.stop_reason, "the callback has ended it")

    def test_what_it_raises_arrives(self):
        class Mine(Exception):
            pass

        def raises(state):
            raise Mine("here")

        with self.assertRaises(Mine):
            feldspar.run(rock(), callback=raises)

    def test_a_view_that_is_kept_is_refused_and_stays_readable(self):
        kept = []

        def keep(state):
            kept.append(state.displacement[:, 1])

        with self.assertRaises(ValueError) as caught:
            feldspar.run(rock(), callback=keep)
        self.assertIn("copy", str(caught.exception))
        gc.collect()
        self.assertEqual(len(kept), 1)
        self.assertTrue(np.isfinite(kept[0]).all(), "its memory is still there")

    def test_the_state_is_gone_behind_the_call(self):
        states = []
        feldspar.run(rock(), callback=lambda state: states.append(state) or len(states) < 2)
        with self.assertRaises(ValueError):
            states[0].axial_stress
        with self.assertRaises(ValueError):
            states[0].stop()


class Leading(unittest.TestCase):
    # What the callback orders stage by stage is what the job file says.
    def test_has_the_bits_of_the_same_stages_in_a_job(self):
        stages = [
            {"kind": "load", "until": "stress", "at": "30 MPa"},
            {"kind": "hold", "travel_times": 5},
            {"kind": "unload", "until": "stress", "at": "10 MPa"},
            {"kind": "confine", "sigma3": "4 MPa"},
            {"kind": "load"},
        ]
        of_file = feldspar.run(rock(test=[pressed(stages=stages)]))
        self.assertEqual(len(of_file.stages), 5, of_file.stop_reason)
        orders = [Stage.hold(5), Stage.unload("stress", at="10 MPa"), Stage.confine("4 MPa"), Stage.load()]

        def lead(state):
            if state.stage_ended and orders:
                state.begin(orders.pop(0))

        led = feldspar.run(rock(test=[pressed()]), callback=lead, every=1000, begins=Stage.load("stress", at=30e6))
        same_bits(self, led, of_file)
        self.assertEqual(led.stages, of_file.stages)
        self.assertEqual(led.stop_reason, of_file.stop_reason)

    def test_loads_and_unloads_by_what_it_sees(self):
        turned = []

        def lead(state):
            if state.stage_kind == "load" and state.cracks_tensile >= 3 * (len(turned) + 1) and len(turned) < 2:
                turned.append(state.axial_stress)
                state.begin(Stage.unload("stress", at="2 MPa"))
            elif state.stage_kind == "unload" and state.stage_ended:
                state.begin(Stage.load())

        result = feldspar.run(rock(), callback=lead, begins=Stage.load())
        self.assertEqual([s["kind"] for s in result.stages][:5], ["load", "unload", "load", "unload", "load"])
        self.assertGreaterEqual(len(result.cycles), 2)
        self.assertLess(abs(result.energies["energy_residual_at_end_J"]), 2e-3 * result.energies["energy_external_J"])

    def test_changes_pressure_speed_and_motion(self):
        def lead(state):
            if state.axial_strain > 5e-4:
                state.set_pressure("3 MPa")
                state.set_motion("bottom", (0.0, 0.5))
                state.set_speed(2e-9)
            if state.axial_strain > 8e-4:
                self.assertEqual(state.pressures, {"left": 3e6, "right": 3e6})
                self.assertEqual(state.fixtures["bottom"]["motion"], (0.0, 0.5))
                self.assertEqual(state.platen_speed, 2e-9)
                state.stop("seen")

        result = feldspar.run(rock(test=[pressed()]), callback=lead)
        self.assertEqual(result.stop_reason, "seen")
        self.assertLess(abs(result.energies["energy_residual_at_end_J"]), 2e-3 * result.energies["energy_external_J"])

    def test_orders_that_cannot_be_carried_out_are_refused_with_what_is_allowed(self):
        def order(what):
            return lambda state: what(state)

        for what, words in ((lambda s: s.begin(Stage.hold()), "stage"), (lambda s: s.set_motion("sideways", (1.0, 0.0)), "top"), (lambda s: s.set_pressure(-1.0), "0 or more")):
            with self.assertRaises(feldspar.InputError) as caught:
                feldspar.run(rock(test=[pressed()]), callback=order(what))
            self.assertIn(words, str(caught.exception))
        with self.assertRaises(feldspar.InputError):
            feldspar.run(rock(), begins=Stage.load())
        with self.assertRaises(feldspar.InputError):
            feldspar.run(rock(test=[{"kind": "cyclic-compression"}]), callback=lambda s: None, begins=Stage.load())

    def test_stages_are_held_against_what_is_possible(self):
        for wrong in (
            lambda: Stage.load("stress"),
            lambda: Stage.load("stress", at="10 mm"),
            lambda: Stage.load("stress", at=1e6, by=1e6),
            lambda: Stage.load(at=1e6),
            lambda: Stage.load("share-of-peak", at=1.5),
            lambda: Stage.unload("reversal"),
            lambda: Stage.hold(-1.0),
            lambda: Stage.confine("-1 MPa"),
            lambda: Stage.confine("1 MPa", keep="warm"),
        ):
            with self.assertRaises(feldspar.InputError):
                wrong()
        self.assertEqual(Stage.load("stress", at="30 MPa"), Stage.load("stress", at=30e6))


if __name__ == "__main__":
    unittest.main()
