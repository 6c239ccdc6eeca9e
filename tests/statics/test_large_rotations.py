"""Closed forms and published tables for large rotations of a weightless core."""

from math import pi

import numpy as np
import pytest
from conftest import weightless_core
from scipy.integrate import quad
from scipy.optimize import brentq

from statics import equilibrium

MATTIASSON_1981 = {
    # P L^2 / EJ: (shortening u / L, deflection w / L, tip angle) of a cantilever under a dead tip force.
    # K. Mattiasson, "Numerical results from large deflection beam and frame problems analysed by means of
    # elliptic integrals", Int. J. Numer. Meth. Engng 17 (1981) 145-153, Table I.
    1.0: (0.05643, 0.30172, 0.46135),
    2.0: (0.16064, 0.49346, 0.78175),
    5.0: (0.38763, 0.71379, 1.21537),
    10.0: (0.55500, 0.81061, 1.43029),
}


def elastica_tip(load: float) -> tuple[float, float, float]:
    """x, y and angle of the tip under a force along +y, by quadrature of the elastica (Love 1944, sec. 262).

    theta'^2 = 2 load (sin theta_tip - sin theta), so arc length, x and y are integrals over theta; with
    sin theta = sin theta_tip - s^2 they have no singularity at the tip.
    """

    def over_angle(tip: float, weight: str) -> float:
        def integrand(s: float) -> float:
            sine = np.sin(tip) - s * s
            cosine = np.sqrt(1 - sine * sine)
            return {"length": 1.0, "x": cosine, "y": sine}[weight] * 2 / (np.sqrt(2 * load) * cosine)

        return quad(integrand, 0.0, np.sqrt(np.sin(tip)), epsabs=1e-13, epsrel=1e-13)[0]

    tip = brentq(lambda angle: over_angle(angle, "length") - 1.0, 1e-6, 1.5, xtol=1e-14)
    assert isinstance(tip, float)
    return over_angle(tip, "x"), over_angle(tip, "y"), tip


@pytest.mark.parametrize("load", MATTIASSON_1981)
def test_elastica_quadrature_has_the_published_digits(load: float) -> None:
    x, y, angle = elastica_tip(load)
    np.testing.assert_allclose((1 - x, y, angle), MATTIASSON_1981[load], atol=6e-6)


@pytest.mark.parametrize("load", MATTIASSON_1981)
def test_cantilever_reaches_the_published_elastica(load: float) -> None:
    rest = equilibrium(weightless_core(disks=400, force=(0.0, load)))
    x, y, angle = rest.tip
    assert rest.stable
    np.testing.assert_allclose((1 - x, y, angle), MATTIASSON_1981[load], atol=2.5e-5)


@pytest.mark.parametrize("load", [1.0, 10.0])
def test_cantilever_converges_to_the_elastica_at_second_order(load: float) -> None:
    disks = np.array([16, 32, 64, 128, 256])
    exact = np.array(elastica_tip(load))
    errors = [
        np.abs(np.array(equilibrium(weightless_core(disks=int(n), force=(0.0, load))).tip) - exact).max()
        for n in disks
    ]
    slope = np.polyfit(np.log(disks), np.log(errors), 1)[0]
    assert slope == pytest.approx(-2.0, abs=0.05)


@pytest.mark.parametrize("disks", [1, 2, 3, 7, 64])
def test_end_moment_of_two_pi_closes_the_arm_into_a_circle(disks: int) -> None:
    rest = equilibrium(weightless_core(disks=disks, moment=2 * pi))
    assert rest.stable
    np.testing.assert_allclose(rest.bend_angle, 2 * pi / disks, rtol=1e-14)
    np.testing.assert_allclose(rest.tip, (0.0, 0.0, 2 * pi), atol=2e-14)


def test_pure_end_moment_gives_one_circle_for_any_number_of_segments() -> None:
    one = equilibrium(weightless_core(disks=1, moment=1.3))
    many = equilibrium(weightless_core(disks=50, moment=1.3))
    np.testing.assert_allclose(many.tip, one.tip, atol=1e-14)
