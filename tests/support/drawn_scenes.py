"""Coupled scenes of a few bodies on a coarse grid, drawn at random: boundaries, flows, schemes, inertia, obstacles,
contrast, gravity, contact, membranes that stretch, remember and leak. Their curves are in files, so that tests/robustness/test_metamorphic.py has the same markers in each change.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

#: Lists that have an entry for each vesicle, or each obstacle.
OF_VESICLES = ("vesicle_bending", "vesicle_viscosity_ratio", "vesicle_density_difference")
OF_VESICLES += ("membrane_stretching", "membrane_memory")
OF_SOLIDS = ("obstacle_center", "obstacle_radius", "obstacle_velocity", "obstacle_rotation")
OF_FREE = ("obstacle_force", "obstacle_torque", "obstacle_density")

PROJECTIONS = ["split", "penalty"]


@dataclass
class Scene:
    """Numbers by option, words by option, and the points of curves, each [points, 2], the last one the first."""

    numbers: dict  # arrays that a change may change
    text: dict
    vesicles: list
    solids: list = field(default_factory=list)  # empty: none, or posts
    kind: str = "closed"  # of the solids

    def words(self, folder: Path) -> list[str]:
        """The command line; writes the files that it names."""
        used = {"flow_center_x": ["extension"], "flow_center_y": ["extension", "shear", "poiseuille"]}
        words = {"vesicle_shape": "file", "vesicle_file": str(folder / "vesicles.txt")} | self.text
        write_curves(folder / "vesicles.txt", self.vesicles)
        if self.solids:
            notes = [
                f"# velocity {written(v, ' ')}\n# rotation {written(w)}\n" + "# open\n" * (self.kind == "open")
                for v, w in zip(self.numbers["obstacle_velocity"], self.numbers["obstacle_rotation"])
            ]
            write_curves(folder / "solids.txt", self.solids, notes)
            words |= {"obstacle_shape": "file", "obstacle_file": str(folder / "solids.txt")}
        for name, value in self.numbers.items():
            if name in ("domain_bc", "flow_center"):
                words |= {f"{name}_{axis}": written(value[k]) for k, axis in enumerate("xy")}
            elif not (self.solids and name in OF_SOLIDS):
                words[name] = written(value)
        flow = self.text["flow_type"]
        return [part for name, value in words.items() if flow in used.get(name, [flow]) for part in (f"-{name}", value)]


def written(value, between: str = ",") -> str:
    return between.join(str(x) if isinstance(x, str) else repr(x) for x in np.ravel(value).tolist())


def write_curves(path: Path, curves: list, notes: list | None = None) -> None:
    with open(path, "w") as file:
        for note, points in zip(notes or [""] * len(curves), curves):
            file.write(note + "".join(written(point, " ") + "\n" for point in points) + "\n")


def draw_curve(draw: random.Random, radius: float, least: float = 0.45) -> np.ndarray:
    """A closed curve about 0 that stays within the radius: an ellipse with a third wave on it."""
    t = draw.uniform(0, 7) + np.linspace(0, 2 * np.pi, 49)
    z = np.cos(t) + 1j * draw.uniform(least, 0.96) * np.sin(t) + draw.uniform(0, 0.04) * np.exp(-2j * t)
    z *= 0.96 * radius * np.exp(1j * draw.uniform(0, 7))
    z[-1] = z[0]
    return np.c_[z.real, z.imag]


class Draw:
    """Draws a scene of a few bodies on a coarse grid."""

    def __init__(self, seed: int, number: int) -> None:
        self.random = random.Random(f"{seed} {number}")
        self.taken: list[tuple] = []  # centre and radius of bodies
        pick = self.random.choice
        self.h = pick([1 / 16, 1 / 8, 0.1])
        self.n = np.array(pick([(24, 24), (28, 28), (32, 24), (24, 32)]))
        self.bc = ["free"] * 2 if self.chance(0.1) else [pick(["wall", "periodic"]), pick(["wall", "periodic"])]
        self.bc = np.array(self.bc)
        if self.bc.tolist() == ["wall", "periodic"]:
            self.bc = self.bc[::-1]
        self.low = np.array([self.random.uniform(-2, 2), self.random.uniform(-2, 2)])
        self.size = self.n * self.h

    def chance(self, p: float) -> bool:
        return self.random.random() < p

    def place(self, radius: float, gap: float, within: float) -> np.ndarray | None:
        """A place for a body, off others and walls, and no farther from the middle than a container lets it be."""
        for _ in range(60):
            x = self.low + self.size * [self.random.random(), self.random.random()]
            room = np.minimum(x - self.low, self.low + self.size - x) - radius - gap
            if (room[self.bc == "wall"] < 0).any():
                continue
            if np.hypot(*(x - self.low - self.size / 2)) + radius + gap > within:
                continue
            apart = [x - other for other, _ in self.taken]
            apart = [d - np.where(self.bc == "periodic", self.size * np.round(d / self.size), 0) for d in apart]
            if all(np.hypot(*d) > radius + r + gap for d, (_, r) in zip(apart, self.taken)):
                self.taken.append((x, radius))
                return x
        return None

    def solids(self) -> tuple[str, list]:
        """Their kind, and curves, or of posts centres and radii."""
        kinds = ["none", "none", "none", "posts", "closed", "container"]
        kinds += ["open"] * (self.bc[1] == "wall") + ["spanning"] * (list(self.bc) == ["periodic", "wall"])
        kind = "none" if self.bc[0] == "free" else self.random.choice(kinds)
        h, middle, found = self.h, self.low + self.size / 2, []
        t = np.linspace(0, 1, 65)
        if kind == "container":
            found = [middle + draw_curve(self.random, 0.46 * min(self.size), 0.95)[::-1]]
        elif kind == "open":
            foot = self.low + [self.random.uniform(0.4, 0.6) * self.size[0], 0]
            found = [foot + h * np.c_[14 * (t - 0.5), 2.5 * (1 - np.cos(2 * np.pi * t))]]
            self.taken.append((foot, 7.5 * h))
        elif kind == "spanning":
            y = (4 + np.cos(2 * np.pi * (t + self.random.random()))) * h
            y[-1] = y[0]
            found = [self.low + np.c_[self.size[0] * (1 - t), y]]
            self.taken += [(self.low + [x * h, -15 * h], 20.5 * h) for x in range(0, self.n[0], 4)]
        elif kind in ("posts", "closed"):
            for _ in range(self.random.randint(1, 2)):
                radius = self.random.uniform(3.6, 5) * h
                x = self.place(radius, 2 * h, np.inf)
                if x is not None:
                    found.append((x, radius) if kind == "posts" else x + draw_curve(self.random, radius, 0.9))
        return kind if found else "none", found

    def scene(self) -> Scene | None:
        """None where no vesicle has found a place."""
        pick, h = self.random.choice, self.h
        kind, found = self.solids()
        free, grid = self.bc[0] == "free", kind == "none" and self.bc[0] != "free"
        scheme = pick(["coupled"] * (10 if free else 8 if grid else 4) + PROJECTIONS * grid)
        gaps = [3.1] if scheme in PROJECTIONS else [0.8, 1.5, 3]  # what kernels need
        vesicles = []
        for _ in range(self.random.randint(1, 3)):
            radius = self.random.uniform(3.6, 5.5) * h
            within = 0.42 * min(self.size) if kind == "container" else np.inf
            x = self.place(radius, pick(gaps) * h, within)
            vesicles += [] if x is None else [x + draw_curve(self.random, radius)]
        if not vesicles:
            return None
        R0, nu, bending, steps = 4 * h, pick([0.1, 1, 10]), pick([0.01, 1]), pick([3, 4, 5])
        rate = bending / (nu * R0**3) * pick([0.5, 3, 20])  # of all that moves the fluid
        step = pick([0.02, 0.05]) / max(rate, bending / (nu * R0**3))
        self.numbers = {"domain_box": np.c_[self.low, self.low + self.size].ravel(), "domain_cells": self.n}
        self.numbers |= {"domain_bc": self.bc, "fluid_viscosity": nu}
        self.numbers |= {"vesicle_bending": bending * np.array([pick([1, 1, 3]) for _ in vesicles])}
        self.numbers |= {"time_step": step, "time_end": steps * step, "output_every": steps * step}
        self.text = {"scheme_type": scheme, "flow_type": self.flow(rate)}
        if scheme in PROJECTIONS:
            tight = {"tension_ksp_rtol": "1e-11", "bending_ksp_rtol": "1e-11"}
            self.text |= {"fluid_inertia": "unsteady"} | (tight if scheme == "split" else {})
        else:
            self.unsplit(len(vesicles), bending)
            self.forces(len(vesicles), nu * rate / R0, bending)
            self.membranes(len(vesicles), R0, nu, bending)
        if kind != "none" and self.text["fluid_inertia"] != "none":  # with shorter steps vesicles beside solids grow
            times = self.numbers.keys() & {"time_step", "time_end", "output_every", "time_adapt_max_step"}
            longer = max(1, 0.64 * h**2 / (nu * step))
            self.numbers |= {name: self.numbers[name] * longer for name in times}
            if longer > 1 and self.text.pop("time_cfl_limit", ""):  # too long for convection
                self.text["fluid_inertia"] = "unsteady"
        if kind != "none":
            self.bodies(kind, found, rate)
        return Scene(self.numbers, self.text, vesicles, [] if kind in ("none", "posts") else found, kind)

    def unsplit(self, count: int, bending: float) -> None:
        """What coupled may have."""
        pick, order = self.random.choice, self.random.choice([1, 2, 3, 3])
        inertia = "none" if self.bc[0] == "free" else pick(["auto", "none", "unsteady", "convective"])
        if self.chance(0.3):
            inertia = "none"
            self.numbers["vesicle_viscosity_ratio"] = np.array([pick([1, 0.2, 5, 20]) for _ in range(count)])
        if inertia == "convective":
            order, self.text["time_cfl_limit"] = max(order, 2), "3"
        self.text |= {"fluid_inertia": inertia, "scheme_order": str(order)}
        if order > 1 and self.chance(0.2):
            self.text["time_adapt"] = "error"
            self.numbers["time_adapt_max_step"] = 4 * self.numbers["time_step"]
            self.text |= {"scheme_auto": "0.01"} if order == 3 and self.chance(0.5) else {}
        if self.text["scheme_type"] == "coupled" and self.chance(0.8):
            self.text["coupled_ksp_rtol"] = "1e-11"
        driven = list(self.bc) == ["periodic", "wall"]
        driven &= self.text["scheme_type"] == "coupled" or "vesicle_viscosity_ratio" not in self.numbers
        if driven and self.chance(0.4):
            self.text["flow_drive"] = "flux"

    def forces(self, count: int, weight: float, bending: float) -> None:
        pick, h, R0 = self.random.choice, self.h, 4 * self.h
        if self.bc[0] != "free" and self.chance(0.3):
            self.numbers["fluid_gravity"] = weight * np.array([pick([0, 1, -2]), pick([-1, 2])])
            self.numbers["vesicle_density_difference"] = np.array([pick([1, -1, 3]) for _ in range(count)])
        if self.chance(0.3):
            self.numbers["contact_repulsion"] = pick([1, 30]) * bending / R0**3
            self.numbers |= {"contact_repulsion_range": pick([1.5, 3]) * h} if self.chance(0.5) else {}
            self.numbers |= {"contact_adhesion": 0.3 * bending / R0**2} if self.chance(0.5) else {}

    def membranes(self, count: int, R0: float, nu: float, bending: float) -> None:
        pick, tension = self.random.choice, bending / R0**2
        derivative = pick(["spectral", "spectral", "bending", "fd"])
        if self.chance(0.45):
            self.text |= {"membrane_derivative": derivative, "membrane_law": pick(["green", "neo_hookean", "hooke"])}
            modulus = tension * pick([3, 30, 1000])
            moduli = [modulus, *(modulus * pick([0, 1, 5]) for _ in range(count - 1))]
            self.numbers["membrane_stretching"] = np.array(moduli)
            self.numbers |= {"membrane_viscosity": R0 * nu} if self.chance(0.3) else {}
            if derivative != "fd" and self.chance(0.5):
                self.text["membrane_moment"] = pick(["angle", "helfrich"])
            self.text |= {"membrane_rest": "circle"} if self.chance(0.2) else {}
        if derivative != "fd" and self.chance(0.2):
            self.numbers["membrane_memory"] = np.array([pick([0, 0.5, 1]) for _ in range(count)])
        if self.chance(0.15):
            self.numbers["membrane_permeability"] = pick([0.01, 0.1]) * R0 / nu
            self.numbers["membrane_osmotic"] = bending / R0**3 * np.array([pick([0, 1, 3]), pick([0, 1])])
        if self.chance(0.2) and count > 1:
            self.numbers["contact_potential"] = pick([0.1, 1]) * bending / R0**3
            self.numbers["contact_potential_distance"] = R0 * pick([0.4, 1])
            self.numbers |= {"contact_potential_exponents": np.array([6.5, 3])} if self.chance(0.3) else {}

    def flow(self, rate: float) -> str:
        walls = [bc == "wall" for bc in self.bc.tolist()]
        flows = ["quiescent"] + ["shear", "poiseuille"] * walls[1] + ["extension"] * all(walls) + ["uniform"]
        flows = ["quiescent", "shear", "extension", "poiseuille"] if self.bc[0] == "free" else flows
        flow, rate = self.random.choice(flows), rate * self.random.choice([1, -1])
        self.numbers |= {"flow_center": self.low + self.size / 2} if flow not in ("quiescent", "uniform") else {}
        if flow in ("shear", "extension"):
            self.numbers["flow_rate"] = rate
        elif flow == "poiseuille":
            self.numbers |= {"flow_half_width": self.size[1] / 2, "flow_peak_velocity": rate * self.size[1] / 4}
        elif flow == "uniform":
            self.numbers["flow_velocity"] = rate * self.h * np.where(walls, 0, [3, -2])
        return flow

    def bodies(self, kind: str, found: list, rate: float) -> None:
        """What obstacles do."""
        pick, carried = self.random.choice, (self.text["flow_type"], self.text["fluid_inertia"])
        if free := kind in ("posts", "closed") and carried != ("extension", "convective") and self.chance(0.5):
            self.text["obstacle_free"] = "all"
            push = self.numbers["fluid_viscosity"] * rate * self.h**2 * 10
            self.numbers["obstacle_force"] = push * np.array([[pick([0, 1, -2]), pick([0, 1])] for _ in found])
            self.numbers["obstacle_torque"] = push * self.h * np.array([pick([0, 2, -1]) for _ in found])
            self.numbers["obstacle_density"] = np.array([pick([1, 0.1, 3]) for _ in found])
        moving = not free and kind in ("posts", "closed", "container") and self.chance(0.7)
        turns = [[pick([0, 1, -1]), pick([0, 1]), pick([1, -1])] for _ in found]
        self.numbers["obstacle_velocity"] = 2 * self.h * rate * moving * np.array([turn[:2] for turn in turns])
        self.numbers["obstacle_rotation"] = rate * moving * np.array([turn[2] for turn in turns])
        self.text |= {"obstacle_spacing": "0.5"} if kind == "open" else {}
        if moving:
            self.text["obstacle_moving"] = pick(["true", "false"])
            self.numbers["obstacle_frequency"] = pick([0, 3 * rate])
        if kind == "posts":
            self.text["obstacle_shape"] = "posts"
            self.numbers["obstacle_center"] = np.array([x for x, _ in found])
            self.numbers["obstacle_radius"] = np.array([radius for _, radius in found])
