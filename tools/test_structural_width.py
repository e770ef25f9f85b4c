"""Solids and plane bodies of structural_width.py against closed forms: python3 -m unittest discover tools.

Needs numpy, and is skipped without: `make test-fmpy` runs it in the environment that has it."""

import functools
import importlib.util
import unittest

if importlib.util.find_spec("numpy"):
    import structural_width as width  # first: it keeps numpy from starting threads
    from structural_width import BORE, DENSITY, NORMAL, POISSON, RADIUS, SHEAR, TANGENTIAL, YOUNG

    import numpy as np


def bessel(order, x):
    """Bessel functions of the first and of the second kind, from their integrals."""
    turn, far = np.linspace(0, np.pi, 4001), np.linspace(0, 12, 40001)
    first = np.trapezoid(np.cos(order * turn - x * np.sin(turn)), turn)
    tail = (np.exp(order * far) + (-1) ** order * np.exp(-order * far)) * np.exp(-x * np.sinh(far))
    second = np.trapezoid(np.sin(x * np.sin(turn) - order * turn), turn) - np.trapezoid(tail, far)
    return first / np.pi, second / np.pi


@functools.cache
def coarse_wheel():
    return width.wheel(order=3)


@functools.cache
def rest_of_a_wheel(s):
    """Remainders of a coarse wheel for a patch [m/N]."""
    return width.remainder(coarse_wheel(), RADIUS, s)


def even(solid, direction):
    """Displacement of the tread under a force per radian that is the same all around [m per N/rad]."""
    return solid.response(0, solid.loads(RADIUS, np.ones_like))[direction]


@unittest.skipUnless(importlib.util.find_spec("numpy"), "needs numpy")
class StructuralWidth(unittest.TestCase):
    def test_a_disc_turned_against_its_bore_is_that_of_the_closed_form(self):
        disc = width.Solid([-0.05, 0.0, 0.05], [(BORE, RADIUS, -0.05, 0.05, 4)])
        exact = RADIUS**2 / (2 * SHEAR * 0.1) * (1 / BORE**2 - 1 / RADIUS**2)
        self.assertLess(abs(even(disc, TANGENTIAL) / exact - 1), 1e-5)

    def test_an_annulus_pressed_all_around_shrinks_as_lame_says(self):
        hub, lame = width.HUB, 2 * SHEAR * POISSON / (1 - 2 * POISSON)
        a = 1 / (RADIUS * (2 * (lame + SHEAR) + 2 * SHEAR * (hub / RADIUS) ** 2))
        exact = a * (RADIUS - hub**2 / RADIUS)
        self.assertLess(abs(even(width.annulus(width.HUB), NORMAL) / exact - 1), 1e-5)

    def test_torsion_of_an_annulus_has_the_frequency_of_bessel_functions(self):
        hub = width.HUB

        def free(k):  # shear stress of the tread, bore at rest
            (j, y), (j2, y2) = bessel(1, k * hub), bessel(2, k * RADIUS)
            return j2 * y - y2 * j

        low, high = (2 * np.pi * f / np.sqrt(SHEAR / DENSITY) for f in (300, 700))
        for _ in range(30):
            middle = (low + high) / 2
            low, high = (middle, high) if free(middle) * free(low) > 0 else (low, middle)
        exact = low * np.sqrt(SHEAR / DENSITY) / (2 * np.pi)
        self.assertLess(abs(width.torsion(width.annulus(hub, fine=2)) / exact - 1), 1e-5)

    def test_small_patches_dent_a_wheel_as_a_half_space(self):
        """Boussinesq's and Cerruti's displacement doubles from 8 mm to 4 mm; what is left of the wheel stays."""
        small, large = (rest_of_a_wheel(s) for s in (0.004, 0.008))
        change = ((small - large) / (width.half_space(0.004) - width.half_space(0.008)))[width.PLANE]
        self.assertLess(max(abs(change)), 0.02, f"{change}")

    def test_line_loads_dent_plane_bodies_as_a_half_plane(self):
        for body, surface in ((width.annulus(width.HUB), RADIUS), (width.plate(0.1), 0.1)):
            small, large = (width.remainder(body, surface, s)[width.PLANE] for s in (0.003, 0.006))
            self.assertLess(max(abs(small - large)) / (width.KERNEL * np.log(2)), 0.01)

    def test_a_slender_bar_on_a_soft_bed_is_a_beam(self):
        """Bar of 20 by 20 mm, whose deflection decays over 0.6 m: shear adds the square of the ratio, 1e-3."""
        bed, side = 1e5, 0.02
        blocks, springs = [(0, side, -side / 2, side / 2, 1)], np.array([bed, bed, bed]) / side
        bar = width.Solid([-side / 2, side / 2], blocks, order=3, straight=True, bed=springs)
        deflection, _ = width.beam(bed, YOUNG * side**4 / 12)
        found = width.remainder(bar, side)[NORMAL]
        self.assertLess(abs(found / deflection - 1), 1e-3)

    def test_numbers_of_the_page_are_those_of_the_tool(self):
        """Coarse: 1 % below the limit of fine meshes (docs/theory/structural-width.md, section 3)."""
        rest, plane = rest_of_a_wheel(0.008), width.remainder(width.annulus(width.HUB, order=3), RADIUS)
        self.assertLess(abs(rest[NORMAL] / width.NORMAL_REST - 1), 0.015)
        self.assertLess(abs(rest[TANGENTIAL] / width.TANGENTIAL_REST - 1), 0.012)
        self.assertLess(abs(plane[TANGENTIAL] / width.TANGENTIAL_REST / width.WIDTH - 1), 0.012)
        tones = [width.torsion(solid) for solid in (coarse_wheel(), width.annulus(width.HUB, order=3))]
        self.assertLess(abs(tones[0] / tones[1] - 1), 0.005)


if __name__ == "__main__":
    unittest.main()
