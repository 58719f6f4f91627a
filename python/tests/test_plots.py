"""The field's plots show the numbers that they are made of."""

import unittest

import numpy as np

import feldspar
from small import rock

try:
    import matplotlib.pyplot as plt
except ImportError:
    plt = None


@unittest.skipIf(plt is None, "matplotlib is not installed")
class Plots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.result = feldspar.run(rock(test=[{"kind": "uniaxial-compression", "stop_fraction": 0.6}]))

    def tearDown(self):
        plt.close("all")

    def test_stress_strain_has_the_points_where_numbers_are_read_off(self):
        from feldspar import plots

        ax = plots.stress_strain(self.result)
        curve = ax.lines[0]
        np.testing.assert_array_equal(curve.get_ydata(), self.result.history["axial_stress_MPa"])
        marked = {line.get_label().rsplit(" ", 2)[0]: line.get_ydata() for line in ax.lines[1:]}
        self.assertAlmostEqual(float(marked["strength"][0]), self.result.properties["strength_MPa"])
        self.assertAlmostEqual(float(marked["first crack"][0]), self.result.properties["first_crack_MPa"])
        # The secant of E goes through the curve at half the strength (P3).
        secant = next(line for line in ax.lines if line.get_label().startswith("E "))
        (x0, x1), (y0, y1) = secant.get_xdata(), secant.get_ydata()
        self.assertAlmostEqual((y1 - y0) / (x1 - x0) / 10.0, self.result.properties["E_GPa"], places=6)   # MPa over %

    def test_crack_map_draws_every_crack_once(self):
        from feldspar import plots

        ax = plots.crack_map(self.result, cells=False)
        self.assertEqual(sum(len(c.get_segments()) for c in ax.collections), self.result.cracks.rows)
        self.assertLessEqual(sum(len(c.get_segments()) for c in plots.crack_map(self.result, label="peak", cells=False).collections), self.result.cracks.rows)

    def test_circles_touch_the_lines_of_their_fit(self):
        from feldspar import plots

        c, phi, mi, ucs = 20.0, 50.0, 15.0, 120.0
        n = np.tan(np.radians(45 + phi / 2)) ** 2
        sigma3 = [0.0, 5.0, 10.0]
        fit = {"seed": 7, "sigma3_MPa": sigma3, "sigma1_MPa": [2 * c * np.sqrt(n) + n * s for s in sigma3], "cohesion_MPa": c, "friction_angle_deg": phi, "hoek_brown_mi": mi, "hoek_brown_UCS_MPa": ucs}
        ax = plots.mohr_circles({"fits": [fit]})
        circles, line, curve = ax.lines[:3], ax.lines[3], ax.lines[4]
        (x0, x1), (y0, y1) = line.get_xdata(), line.get_ydata()
        for circle in circles:
            x, y = circle.get_xdata(), circle.get_ydata()
            above = y - (y0 + (x - x0) * (y1 - y0) / (x1 - x0))
            self.assertAlmostEqual(above.max() / c, 0.0, delta=1e-3)   # points every degree of a circle miss the touch by (1 deg)^2 / 8 of a radius at most
        # The tangent of Hoek and Brown's curve is the slope of its circles there: each circle on it stays below.
        low = 3.0
        high = low + ucs * np.sqrt(mi * low / ucs + 1.0)
        angle = np.linspace(0, np.pi, 721)
        x, y = 0.5 * (low + high) + 0.5 * (high - low) * np.cos(angle), 0.5 * (high - low) * np.sin(angle)
        inside = (x > curve.get_xdata().min()) & (x < curve.get_xdata().max())
        gap = np.interp(x[inside], curve.get_xdata(), curve.get_ydata()) - y[inside]
        self.assertAlmostEqual(gap.min() / ucs, 0.0, delta=2e-4)   # of linear interpolation between 300 points
        with self.assertRaises(feldspar.InputError):
            plots.mohr_circles({"fits": []})

    def test_the_others_draw(self):
        from feldspar import plots

        self.assertEqual(len(plots.specimen(self.result).collections[0].get_paths()), len(self.result.specimen))
        plots.field(self.result, "stress_yy", scale=10.0)
        plots.acoustic_emission(self.result)
        with self.assertRaises(feldspar.InputError):
            plots.field(self.result, "colour")


if __name__ == "__main__":
    unittest.main()
