"""Steps that follow the energy which a coupling creates: it is what is missing in the balance of both sides, it falls with the
step, and steps that follow it are fewer at the same error."""

import numpy as np
import pytest

import ex07_suspension as suspension
from wheelrail.ecco import Bond, StepControl, work

SHORT = {"mesh.elements_per_half_width": 6}


@pytest.fixture
def stop(fmu, monkeypatch):
    """Stops from 2 m/s on a coarse mesh, as `course` of the example gives them."""
    monkeypatch.setattr(suspension, "SPEED", 2.0)
    monkeypatch.setattr(suspension, "WATCHED", 1.0)
    monkeypatch.setattr(suspension, "COLD", suspension.COLD | SHORT)
    return lambda *arguments: suspension.course(fmu, *arguments)


class Audited(suspension.Run):
    """A run that keeps books beside the bond: energy of the vehicle, of its spring and of the FMU."""

    def energy(self):
        """What the vehicle and its spring hold, and what the force at the hub has done to the FMU [J]."""
        elongation, _ = self.vehicle.elongation(self.place, self.speed)
        held = 0.5 * suspension.VEHICLE * self.vehicle.velocity**2 + 0.5 * suspension.STIFFNESS * elongation**2
        return held + sum(self.wheel.get("energy.hub_work", "energy.brake"))

    def audit(self):
        """Until the vehicle has stood for a while: created energy step by step [J] by the bond, and by the books."""
        bonds, books = [], []
        while self.wheel.time < 3.0:
            before, energy = self.vehicle.elongation(self.place, self.speed), self.energy()
            self.step()
            after = self.vehicle.elongation(self.place, self.speed)
            bonds.append(self.bonds[-1][2].created)
            books.append(self.energy() - energy + suspension.SUSPENSION.dissipated(self.h, before, after))
        return np.array(bonds), np.array(books)


@pytest.mark.parametrize("step", [2e-3, 1e-3])
def test_the_residual_is_the_energy_that_appears_in_the_balance_of_both_sides(fmu, stop, step):
    run = Audited(fmu, "held", step)
    bonds, books = (np.cumsum(series) for series in run.audit())
    run.wheel.close()
    worst = np.abs(bonds - books).max()
    print(f"{1e3 * step:g} ms: created {bonds[-1]:.5f} J by the bond, {books[-1]:.5f} J by the books; largest gap {worst:.1e} J")
    # The books are differences of energies of 19 kJ, which the FMU balances by a formula of second order.
    assert bonds[-1] > 1.0 and worst < 0.005 * bonds[-1]


@pytest.mark.parametrize(("master", "order"), [("held", 2.0), ("ramped", 2.0)])
def test_residual_energy_falls_with_the_square_of_the_step_at_the_least(stop, master, order):
    coarse, fine = (max(abs(b.created) for _, _, b in stop(master, h)[0].bonds) for h in (1e-3, 5e-4))
    print(f"{master}: {coarse:.2e} J, {fine:.2e} J at half the step")
    assert np.log2(coarse / fine) > order - 0.15


def test_steps_that_follow_the_energy_are_fewer_at_equal_error(stop):
    _, reference, rest = stop("ramped", 2e-4)
    end = rest + 0.8
    found = []
    for h, control in ((1e-3, None), (1e-3, suspension.control("ramped", 1e-4))):
        _, table, _ = stop("ramped", h, control)
        found.append((int(np.sum(table[:, 0] < end)), suspension.deviation(table, reference, end)))
    (equal, equal_error), (controlled, error) = found
    print(f"{equal} equal steps: {equal_error:.2f} N; {controlled} controlled ones: {error:.2f} N")
    assert error < equal_error and controlled < 0.6 * equal


def test_the_controller_settles_where_the_tolerance_asks_and_keeps_to_its_limits():
    order, energy, constant = 3.0, 1e-4, 50.0
    control, h = StepControl(energy, order, 1e-4, 1e-1), 1e-3
    for _ in range(200):
        h = control.next(h, [Bond(constant * h**order, 1.0)])
    # h' = h where 0.8 eps^-k_I = 1.
    assert h == pytest.approx((energy * 0.8 ** (order / 0.3) / constant) ** (1.0 / order), rel=1e-6)
    assert control.next(h, [Bond(1e9, 1.0)]) == pytest.approx(max(0.2 * h, 1e-4))
    assert control.next(0.09, [Bond(0.0, 1.0)]) == 0.1
    assert StepControl(energy, order, 1e-4, 1e-1).next(0.05, [Bond(0.0, 0.0)], horizon=0.02) == pytest.approx(2e-3)
    # Twice the residual is tolerated where what passes the bond counts, too; a bond that errs half counts by the mean
    # square.
    assert StepControl(1.0, order, 1e-4, 1.0, share=0.5).error([Bond(2.0, -2.0)]) == pytest.approx(1.0)
    assert StepControl(1.0, order, 1e-4, 1.0).error([Bond(3.0, 0.0), Bond(-4.0, 0.0)]) == pytest.approx(12.5**0.5)
    with pytest.raises(ValueError, match="energy = 0.0 J"):
        StepControl(0.0, order, 1e-4, 1e-1)


def test_work_is_exact_for_products_of_linear_and_square_courses():
    # (1 + 2 t)(3 - t) and (1 + 2 t)(t^2 over 2 s): 6 + 10 - 16/3; 8/3 + 8.
    assert work(2.0, (1.0, 5.0), (3.0, 1.0)) == pytest.approx(6.0 + 10.0 - 16.0 / 3.0)
    assert work(2.0, (1.0, 3.0, 5.0), (0.0, 1.0, 4.0)) == pytest.approx(8.0 / 3.0 + 8.0)


def test_control_of_a_master_without_a_bond_is_refused(fmu):
    with pytest.raises(ValueError, match="velocity"):
        suspension.Run(fmu, "velocity", 1e-3, suspension.control("ramped", 1e-4))
