#!/usr/bin/env python3
"""Flexibility of a railway wheel and of a rail as solids, and the plane bodies that have the same one.

    tools/structural_width.py             every table behind docs/theory/structural-width.md, some minutes
    tools/structural_width.py wheels      one of: convergence, annuli, wheels, widths, rails

Finite elements in the cross section, Fourier series along the tread: order n around a wheel, wave number along a rail.
A force is spread over a round patch, Gaussian with the standard deviation s; its displacement is the mean weighted with
the same Gaussian. Less that of a half-space under the same patch it hardly depends on s: the remainder. Needs numpy.
"""

import os
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # for matrices of this size threads only wait for each other

import numpy as np  # noqa: E402
from numpy.polynomial import legendre  # noqa: E402

YOUNG, POISSON, DENSITY = 210e9, 0.3, 7850.0
SHEAR = YOUNG / (2 * (1 + POISSON))
KERNEL = 2 * (1 - POISSON**2) / (np.pi * YOUNG)  # of a half-plane [m2/N]
EULER = 0.5772156649015329
HUB, WIDTH = 0.067, 0.073  # of the plane wheel [m]
NORMAL_REST, TANGENTIAL_REST = 1.975e-10, 7.83e-10  # of the wheel with a straight web, limit of `convergence` [m/N]
NORMAL, LATERAL, TANGENTIAL = 0, 1, 2  # along r (or y of a rail), along the axle, along the tread
RADIUS, BORE, DEPTH = 0.46, 0.09, 0.025  # tread and bore of the wheel, reference length L0 of the logarithm [m]


def shapes(order):
    """Nodes and Gauss points on [-1, 1], weights, and values and slopes of the Lagrange polynomials there."""
    nodes = -np.cos(np.pi * np.arange(order + 1) / order)
    points, weights = legendre.leggauss(order + 2)
    inverse = np.linalg.inv(legendre.legvander(nodes, order))
    slopes = legendre.legval(points, legendre.legder(np.eye(order + 1))).T
    return nodes, points, weights, legendre.legvander(points, order) @ inverse, slopes @ inverse


def element(r, z, order, straight):
    """Matrices K0, K1, K2 and M of an element with nodes r, z [row, column]: stiffness K0 + n K1 + n2 K2 per radian."""
    _, _, weight, value, slope = shapes(order)
    n = np.einsum("ai,bj->abij", value, value).reshape(-1, r.size)
    along_r = np.einsum("ai,bj->abij", slope, value).reshape(-1, r.size)
    along_z = np.einsum("ai,bj->abij", value, slope).reshape(-1, r.size)
    r, z = r.ravel(), z.ravel()
    rr, rz, zr, zz = along_r @ r, along_z @ r, along_r @ z, along_z @ z
    jacobian = rr * zz - rz * zr
    by_r = (along_r * zz[:, None] - along_z * zr[:, None]) / jacobian[:, None]
    by_z = (along_z * rr[:, None] - along_r * rz[:, None]) / jacobian[:, None]
    radius = np.ones(len(n)) if straight else n @ r
    turned, curved = n / radius[:, None], 0 if straight else n / radius[:, None]
    # Strains rr, zz, tt, rz, rt, zt by u_r cos, u_z cos, u_t sin; b1 is what the order n multiplies.
    b0, b1 = np.zeros((2, len(n), 6, n.shape[1], 3))
    b0[:, 0, :, 0], b0[:, 1, :, 1], b0[:, 2, :, 0] = by_r, by_z, curved
    b0[:, 3, :, 0], b0[:, 3, :, 1], b0[:, 4, :, 2], b0[:, 5, :, 2] = by_z, by_r, by_r - curved, by_z
    b1[:, 2, :, 2], b1[:, 4, :, 0], b1[:, 5, :, 1] = turned, -turned, -turned
    lame = 2 * SHEAR * POISSON / (1 - 2 * POISSON)
    elastic = np.diag(SHEAR * np.array([2.0, 2, 2, 1, 1, 1]))
    elastic[:3, :3] += lame
    volume = np.outer(weight, weight).ravel() * jacobian * radius
    b0, b1 = b0.reshape(len(n), 6, -1), b1.reshape(len(n), 6, -1)
    product = lambda a, b: np.einsum("gsi,st,gtj,g->ij", a, elastic, b, volume, optimize=True)
    mixed = product(b0, b1)
    mass = np.kron(np.einsum("gi,gj,g->ij", n, n, DENSITY * volume), np.eye(3))
    return np.array([product(b0, b0), mixed + mixed.T, product(b1, b1), mass])


class Solid:
    """A stack of blocks (bottom, top, left, right, layers), each between two of the lines `columns`: a wheel from its
    bore outwards, or a rail (`straight`) from its base upwards. The base is clamped, or on a bed of stiffness per area
    in the directions r, z and along. `plane`: nothing moves along z. `offset` shifts the section along z, over r."""

    def __init__(self, columns, blocks, order=4, straight=False, plane=False, bed=None, offset=lambda r: 0.0):
        ticks = shapes(order)[0] / 2 + 0.5
        self.z = np.concatenate([*(a + (b - a) * ticks[:-1] for a, b in zip(columns, columns[1:])), columns[-1:]])
        self.order, self.straight, self.plane, self.blocks = order, straight, plane, blocks
        self.layers, self.rows = [], [blocks[0][0]]
        for bottom, top, left, right, count in blocks:
            first, last = (int(np.argmin(abs(np.array(columns) - edge))) for edge in (left, right))
            for low, high in zip(*(np.linspace(bottom, top, count + 1)[i:][:count] for i in (0, 1))):
                self._add_layer(low + (high - low) * ticks, range(first, last), offset)
        dofs, matrices = self.layers[0]
        if bed is None:
            keep = dofs >= 3 * len(self.z)
            self.layers[0] = dofs[keep], matrices[:, keep][:, :, keep]
        else:
            width = self.line(lambda z: np.ones_like(z), blocks[0][2:4])
            for node in np.flatnonzero(width):  # lumped: the base is stiff across
                where = np.searchsorted(dofs, 3 * node)
                matrices[0, range(where, where + 3), range(where, where + 3)] += width[node] * np.array(bed)

    def _add_layer(self, r, elements, offset):
        """Appends the matrices of the elements between the rows of nodes r."""
        p, row = self.order, len(self.rows) - 1
        self.rows += list(r[1:])
        first = row * len(self.z) + np.add.outer(np.arange(p + 1) * len(self.z), np.arange(p + 1))
        nodes = [first + p * e for e in elements]
        numbers = np.unique(np.concatenate(nodes))
        matrices = np.zeros((4, 3 * len(numbers), 3 * len(numbers)))
        for e, own in zip(elements, nodes):
            grid = np.broadcast_to(r[:, None], own.shape)
            z = self.z[p * e : p * e + p + 1] + np.array([offset(x) for x in r])[:, None]
            at = (3 * np.searchsorted(numbers, own.ravel())[:, None] + np.arange(3)).ravel()
            matrices[np.ix_(range(4), at, at)] += element(grid, z, p, self.straight)
        dofs = (3 * numbers[:, None] + np.arange(3)).ravel()
        keep = dofs % 3 != LATERAL if self.plane else np.full(len(dofs), True)
        self.layers.append((dofs[keep], matrices[:, keep][:, :, keep]))

    def line(self, density, between=(-np.inf, np.inf)):
        """Integrals over z of `density` and the shape of each node of a row."""
        nodes, p = shapes(self.order)[0], self.order
        points, weights = legendre.leggauss(40)
        value = legendre.legvander(points, p) @ np.linalg.inv(legendre.legvander(nodes, p))
        total = np.zeros(len(self.z))
        for first in range(0, len(self.z) - 1, p):
            left, right = self.z[first], self.z[first + p]
            if between[0] - 1e-9 < left and right < between[1] + 1e-9:
                z = (left + right) / 2 + (right - left) / 2 * points
                total[first : first + p + 1] += value.T @ (weights * density(z)) * (right - left) / 2
        return total

    def loads(self, surface, density):
        """Nodal forces of unit forces on the row at the height `surface`, in the three directions."""
        row, forces = int(np.argmin(abs(np.array(self.rows) - surface))), np.zeros((len(self.rows), len(self.z), 3, 3))
        forces[row] = np.multiply.outer(self.line(density) / self.line(density).sum(), np.eye(3))
        return forces.reshape(-1, 3)

    def response(self, n, forces):
        """Displacements along `forces` of one order, per radian (per metre if straight): layer by layer eliminated."""
        work, rest, passed, forces = np.zeros(forces.shape[1]), None, None, forces.copy()
        for i, (dofs, (k0, k1, k2, _)) in enumerate(self.layers):
            k = k0 + n * k1 + n * n * k2
            if passed is not None:
                at = np.searchsorted(dofs, rest)
                k[np.ix_(at, at)] += passed
            stays = np.isin(dofs, self.layers[i + 1][0]) if i + 1 < len(self.layers) else np.full(len(dofs), False)
            rest, gone = dofs[stays], dofs[~stays]
            both = np.linalg.solve(k[~stays][:, ~stays], np.column_stack([k[~stays][:, stays], forces[gone]]))
            work += (forces[gone] * both[:, len(rest) :]).sum(axis=0)
            forces[rest] -= k[stays][:, ~stays] @ both[:, len(rest) :]
            passed = k[stays][:, stays] - k[stays][:, ~stays] @ both[:, : len(rest)]
        return work

    def flexibility(self, surface, s, single=24, points=6):
        """Displacements of a patch by unit forces on it in the three directions [m/N]; per metre of width if `plane`
        [m2/N]. Orders up to `single` one by one, those above as an integral (midpoint rule), as are the wave numbers of
        a rail."""
        forces = self.loads(surface, np.ones_like if self.plane else lambda z: np.exp(-0.5 * (z / s) ** 2))
        sigma = s if self.straight else s / surface
        part = lambda n: np.exp(-((n * sigma) ** 2)) * self.response(n, forces) / np.pi
        if self.straight:
            total, edges = np.zeros(3), [1e-9, *np.geomspace(0.1, 5 / sigma, 10)]
        else:
            total = part(0) / 2 + sum(part(n) for n in range(1, single + 1))
            edges = np.geomspace(single + 0.5, 5 / sigma, 4)
        x, w = legendre.leggauss(points)
        for a, b in zip(edges, edges[1:]):
            total += sum(wi * part((a + b) / 2 + (b - a) / 2 * xi) for xi, wi in zip(x, w)) * (b - a) / 2
        return total

    def assembled(self, n):
        """All degrees of freedom, stiffness and mass of one order as full matrices."""
        dofs = np.unique(np.concatenate([d for d, _ in self.layers]))
        k, m = np.zeros((2, len(dofs), len(dofs)))
        for own, (k0, k1, k2, mass) in self.layers:
            at = np.ix_(np.searchsorted(dofs, own), np.searchsorted(dofs, own))
            k[at] += k0 + n * k1 + n * n * k2
            m[at] += mass
        return dofs, k, m

    def modes(self, n, motion):
        """Frequencies [Hz] of an order, base clamped, and their share of the mass that moves in `motion` (r, z, t)."""
        dofs, k, m = self.assembled(n)
        if n == 0:  # torsion is alone
            own = dofs % 3 == TANGENTIAL
            dofs, k, m = dofs[own], k[own][:, own], m[own][:, own]
        inverse = np.linalg.inv(np.linalg.cholesky(m))
        squares, vectors = np.linalg.eigh(inverse @ k @ inverse.T)
        pattern = np.array(motion)[dofs % 3]
        shares = (vectors.T @ inverse @ m @ pattern) ** 2 / (pattern @ m @ pattern)
        return np.sqrt(squares) / (2 * np.pi), shares


def torsion(solid):
    """Lowest frequency of a wheel that turns about its clamped bore [Hz]."""
    return solid.modes(0, (0, 0, 1))[0][0]


def translation(solid):
    """Frequency and share of the mode of order 1 that has most of the wheel's motion in its plane [Hz], [1]."""
    frequencies, shares = solid.modes(1, (1, 0, -1))
    best = np.argmax(shares)
    return frequencies[best], shares[best]


def half_space(s):
    """Displacements of a half-space under a round Gaussian patch, mean weighted with it (Boussinesq, Cerruti) [m/N]."""
    shares = np.array([1 - POISSON, 1 - POISSON / 2, 1 - POISSON / 2])
    return shares / (2 * np.pi * SHEAR) * np.sqrt(np.pi) / (2 * s)


def half_plane(s, depth=DEPTH):
    """The same of a half-plane, -kernel ln(|x|/depth), under a line force spread along the tread [m2/N]."""
    return -KERNEL * (np.log(s * np.sqrt(2) / depth) - (EULER + np.log(2)) / 2)


def remainder(solid, surface, s=0.006):
    """Flexibilities of a solid less those of the half-space: normal, lateral, tangential [m/N]; of a plane body less
    that of the half-plane: normal and tangential, plus kernel ln(|x|/L0) [m2/N]."""
    return solid.flexibility(surface, s) - (half_plane(s) if solid.plane else half_space(s))


def wheel(web=0.025, order=4, fine=1, boss=0.13, rim=0.06, fillet=0.0, inclined=0.0, bulge=0.0, flange=False):
    """A 920 mm wheel: rim 135 wide, boss 170, web between them; `fillet`: web thicker by that on both sides and over
    that height next to rim and boss; an `inclined` web shifts by that from boss to rim, one with a `bulge` is bent by
    it, a `flange` is 28 by 21.5 mm."""
    bottom, f, half = RADIUS - rim, fillet, web / 2
    halves = np.array([half, half + f, 0.0675, 0.085])
    columns = np.unique(np.round([0.0, *halves, *-halves, *[-0.046] * flange], 6))
    columns = np.unique(np.concatenate([np.linspace(a, b, fine + 1) for a, b in zip(columns, columns[1:])]))
    thick = (-half - f, half + f, 1)
    blocks = [(BORE, boss, -0.085, 0.085, fine)] + [(boss, boss + f, *thick)] * (f > 0)
    blocks += [(boss + f, bottom - f, -half, half, 4 * fine)] + [(bottom - f, bottom, *thick)] * (f > 0)
    edges = [bottom, RADIUS - 0.6 * rim, RADIUS - 0.2 * rim, RADIUS]
    blocks += [(a, b, -0.0675, 0.0675, fine) for a, b in zip(edges, edges[1:])]
    blocks += [(RADIUS, RADIUS + 0.028, -0.0675, -0.046, 1)] * flange

    def offset(r):
        along = np.clip((r - boss - f) / (bottom - boss - 2 * f), 0, 1)
        return inclined * (along - 1) + bulge * np.sin(np.pi * along) ** 2

    return Solid(columns, blocks, order, offset=offset)


def annulus(hub, order=4, fine=1):
    """The plane wheel of the product, per metre of width: an annulus on a rigid hub, in plane strain."""
    edges = [hub, *(RADIUS - np.array([0.26, 0.16, 0.1, 0.06, 0.036, 0.02, 0.008, 0.0]))]
    return Solid([-0.5, 0.5], [(a, b, -0.5, 0.5, fine) for a, b in zip(edges, edges[1:])], order, plane=True)


def inertia(solid):
    """Mass [kg] and moment of inertia about the axle [kg m2] of a wheel."""
    parts = np.array([DENSITY * np.pi * (b**2 - a**2) * (right - left) * np.array([1, (a**2 + b**2) / 2])
                      for a, b, left, right, _ in solid.blocks])
    return parts.sum(axis=0)


# Bottom, top, half of the width, layers: area, height of the centroid and second moment of area of a 60E1 within 2 %.
RAIL = [(0.0, 0.0125, 0.075, 1), (0.0125, 0.0225, 0.0355, 1), (0.0225, 0.0345, 0.014, 1), (0.0345, 0.121, 0.00825, 4),
        (0.121, 0.128, 0.014, 1), (0.128, 0.133, 0.028, 1), (0.133, 0.148, 0.0355, 1), (0.148, 0.164, 0.0355, 1),
        (0.164, 0.172, 0.0305, 1)]
HEAD, ALONG, ACROSS = RAIL[-1][1], 4e7, 1e7  # height of the head [m]; bed along the rail and across [N/m2]
BALLAST = 1 / (1 / 137.75 + 1 / 77.5)  # ballast and subgrade below a sleeper, see track-support.md [MN/m]
SLEEPERS = 0.6  # their distance [m]


def rail(bed=None, order=3, fine=1):
    """A rail 60E1 as a stack of rectangles, its foot clamped or on a vertical `bed` [N/m per metre of rail]."""
    halves = np.unique([0.0, *(part[2] for part in RAIL)])
    columns = np.unique(np.concatenate([halves, -halves]))
    columns = np.unique(np.concatenate([np.linspace(a, b, fine + 1) for a, b in zip(columns, columns[1:])]))
    springs = None if bed is None else np.array([bed, ACROSS, ALONG]) / (2 * RAIL[0][2])
    return Solid(columns, [(a, b, -w, w, n * fine) for a, b, w, n in RAIL], order, straight=True, bed=springs)


def plate(height, order=4, fine=1):
    """The plane rail of the product, per metre of width: a plate on a rigid line, in plane strain."""
    edges = [0, *(height * (1 - np.array([0.5, 0.28, 0.14, 0.06, 0.0])))]
    blocks = [(a, b, -0.5, 0.5, fine) for a, b in zip(edges, edges[1:])]
    return Solid([-0.5, 0.5], blocks, order, straight=True, plane=True)


def section():
    """Area [m2], height of the centroid [m] and second moment of area [m4] of the rail."""
    a, b, half, _ = np.array(RAIL).T
    area, middle = 2 * half * (b - a), (a + b) / 2
    centroid = area @ middle / area.sum()
    return area.sum(), centroid, area @ ((middle - centroid) ** 2 + (b - a) ** 2 / 12)


def beam(bed, bending):
    """Deflection of an infinite beam on an elastic bed under a unit force [m/N] and the length of its mass that has the
    kinetic energy of that shape [m] (Winkler)."""
    beta = (bed / (4 * bending)) ** 0.25
    return beta / (2 * bed), 1.5 / beta


def row(*cells):
    """Prints a row of a table."""
    texts = (cell if isinstance(cell, str) else " ".join(f"{v:.4g}" for v in np.atleast_1d(cell)) for cell in cells)
    print(*texts, sep=" | ", flush=True)


PLANE = [NORMAL, TANGENTIAL]


def convergence():
    row("order, parts, s [mm]", "wheel: normal, lateral, tangential [1e-10 m/N]", "torsion, n = 1 [Hz]")
    for order, fine, s in [(3, 1, 6), (4, 1, 6), (3, 2, 6), (4, 2, 8), (4, 2, 6), (4, 2, 4)]:
        solid = wheel(order=order, fine=fine)
        tones = [] if order * fine > 6 else [torsion(solid), translation(solid)[0]]
        row([order, fine, s], 1e10 * remainder(solid, RADIUS, 1e-3 * s), tones)
    for single in (8, 24, 72):
        row("wheel, orders one by one up to", single, 1e10 * wheel(order=3).flexibility(RADIUS, 0.006, single))
    row("order, parts, s [mm]", "annulus, plate 100 mm high: normal, tangential [1e-12 m2/N]")
    for order, fine, s in [(3, 1, 6), (4, 1, 6), (4, 2, 6), (4, 2, 3)]:
        bodies = (annulus(HUB, order, fine), RADIUS), (plate(0.1, order, fine), 0.1)
        row([order, fine, s], *(1e12 * remainder(body, surface, 1e-3 * s)[PLANE] for body, surface in bodies))
    row("order, s [mm]", "rail, foot clamped: normal, lateral, tangential [1e-10 m/N]")
    for order, s in [(2, 6), (3, 6), (4, 6), (4, 4)]:
        row([order, s], 1e10 * remainder(rail(order=order), HEAD, 1e-3 * s))


def plane_wheels(hubs=(0.035, 0.046, 0.055, 0.06, 0.067, 0.075, 0.09, 0.11)):
    """Radii of hubs, and of their annuli: torsion [Hz], n = 1 [Hz], remainders normal and tangential [m2/N]."""
    solids = [annulus(hub) for hub in hubs]
    return np.array(hubs), np.array([(torsion(a), translation(a)[0], *remainder(a, RADIUS)[PLANE]) for a in solids]).T


def annuli():
    hubs, columns = plane_wheels()
    row("hub [mm]", "torsion, n = 1 [Hz]", "normal, tangential [1e-12 m2/N]", "mass, inertia per mm of width")
    for hub, values in zip(hubs, columns.T):
        row(1e3 * hub, values[:2], 1e12 * values[2:], 1e-3 * inertia(annulus(hub)))


WHEELS = {"straight web of 25 mm": {}, "web of 20 mm": {"web": 0.02}, "web of 30 mm": {"web": 0.03},
          "fillets of 20 mm": {"fillet": 0.02}, "web inclined by 30 mm": {"inclined": 0.03},
          "web bulging by 15 mm": {"bulge": 0.015}, "web bulging by 30 mm": {"bulge": 0.03},
          "with a flange": {"flange": True}, "rim of 50 mm": {"rim": 0.05}, "worn rim of 30 mm": {"rim": 0.03},
          "boss of 220 mm": {"boss": 0.11}}


def wheels():
    """The plane annulus that has torsion and tangential remainder of a wheel, and what its normal remainder lacks."""
    hubs, (tones, _, normals, tangentials) = plane_wheels()
    row("wheel", "mass, inertia", "torsion, n = 1 [Hz]", "normal, lateral, tangential [1e-10 m/N]", "hub, width [mm]",
        "series [1e-10 m/N]", "mass, inertia of the annulus")
    for name, options in WHEELS.items():
        solid = wheel(**options)
        rest, tone = remainder(solid, RADIUS), torsion(solid)
        hub = np.interp(tone, tones, hubs)
        width = np.exp(np.interp(hub, hubs, np.log(tangentials))) / rest[TANGENTIAL]
        series = rest[NORMAL] - np.interp(hub, hubs, normals) / width
        row(name, inertia(solid), [tone, translation(solid)[0]], 1e10 * rest, [1e3 * hub, 1e3 * width], 1e10 * series,
            width * inertia(annulus(hub)))


def widths():
    """Widths over L0, from the remainders of the first wheel in the limit of fine meshes and small patches."""
    n, t = remainder(annulus(HUB), RADIUS)[PLANE]
    row("L0 [mm]", "width by tangential, by normal [mm]", "series for the normal [1e-10 m/N]")
    for depth in (0.05, 0.025, 0.0125, 0.005, 0.0025, 0.001):
        shift = KERNEL * np.log(depth / DEPTH)
        width = (t - shift) / TANGENTIAL_REST
        row(1e3 * depth, [1e3 * width, 1e3 * (n - shift) / NORMAL_REST], 1e10 * (NORMAL_REST - (n - shift) / width))
    both = (t - n) / (TANGENTIAL_REST - NORMAL_REST)
    row("both: width, L0 [mm]", [1e3 * both, 1e3 * DEPTH * np.exp((n - NORMAL_REST * both) / KERNEL)],
        "mass, inertia", both * inertia(annulus(HUB)))


def rails():
    area, centroid, moment = section()
    row("rail [cm2, mm, cm4]", [1e4 * area, 1e3 * centroid, 1e8 * moment])
    row("foot clamped: normal, lateral, tangential [1e-10 m/N]", 1e10 * remainder(rail(), HEAD))
    plates = {h: remainder(plate(h), h)[PLANE] for h in (0.05, 0.1, 0.172)}
    row("plate: height [mm]", "normal, tangential [1e-12 m2/N]", "with the width [1e-10 m/N]")
    for h, values in plates.items():
        row(1e3 * h, 1e12 * values, 1e10 * values / WIDTH)
    row("pad, ballast [MN/m]", "bed [MN/m2]", "normal, tangential [1e-10 m/N]", "beam, bar",
        "support, restraint [MN/m]", "mass of rail [kg]")
    bar = 1 / (2 * np.sqrt(ALONG * YOUNG * area))
    for pad, ballast in [(65, BALLAST), *((pad, ballast) for ballast in (BALLAST, np.inf) for pad in (100, 200, 400))]:
        bed = 1e6 / (1 / pad + 1 / ballast) / SLEEPERS
        rest, (deflection, length) = remainder(rail(bed), HEAD)[PLANE], beam(bed, YOUNG * moment)
        row([pad, ballast], 1e-6 * bed, 1e10 * rest, 1e10 * np.array([deflection, bar]),
            1e-6 / (rest - plates[0.1] / WIDTH), DENSITY * area * length)


if __name__ == "__main__":
    tables = {"convergence": convergence, "annuli": annuli, "wheels": wheels, "widths": widths, "rails": rails}
    for name in sys.argv[1:] or tables:
        tables[name]()
