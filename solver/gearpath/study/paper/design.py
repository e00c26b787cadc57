"""Sec. 7: the three design principles as computed tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from ...modelfile import Model
from ...network.assemble import assemble
from ...network.records import Load, Output
from ...network.response import frequency_response
from ...numerics.arrays import Complex, Real
from ...report.layout import Figure
from ...report.table import Table, table
from .claims import Claim, judge, number_of
from .drawing import changes_seen, ratio_figure
from .effect import BANDS, GRID, Effect, band_means, effects
from .machine import bearings, mounts, scaled_joints, shipped
from .record import Study

Side = Literal["receiver", "joint", "source"]
SIDES: dict[Side, str] = {
    "receiver": "Receiver: casing and mounts",
    "joint": "Bearings",
    "source": "Source: gear train",
}
_LOW = "Keep the mobility of the receiving structure as low as possible"
_JOINT, _JOINT_DAMPING = "Keep the mobility of the joints as high as possible", "Or increase the damping of the joints"
_HIGH, _SOURCE_DAMPING = "Make the mobility of the source as high as possible", "Or increase the damping of the source"


@dataclass(frozen=True)
class Trial:
    """A principle of the paper, whose mobility it is about, and one change that tries it."""

    name: str
    side: Side
    says: str
    changes: Mapping[str, Any]


def study(model: Model | None = None) -> Study:
    """Every principle with its changes: effect on the mobility that it is about, on the ratios, on the power."""
    model = model or shipped()
    trials = _trials(model)
    _, found = effects(model, {trial.name: trial.changes for trial in trials})
    shifts = [
        [after - before for before, after in zip(mobility(model, t.side), mobility(model.replace(t.changes), t.side))]
        for t in trials
    ]
    return Study(
        key="design",
        title="Sec. 7: design criteria",
        done="The casing is rigid: it cannot be made stiffer. What can lower its mobility is mass and inertia, and "
        "stiffer mounts. The rest follows the paper: softer or more damped bearings (of the softer ones C is kept), "
        "thinner shafts or a softer mesh for a more mobile source, and more modal damping in it.",
        figures=tuple(_figure(side, trials, found) for side in SIDES),
        claims=tuple(_lowers(trial, effect) for trial, effect in zip(trials, found)),
        effects=found,
        tables=(_mobility_table(trials, shifts), _power_table(found)),
        remarks=(
            "α is a ratio to the input power, which the changes alter as well; the last table gives the transmitted "
            "power itself, for the same transmission error.",
        ),
    )


def mobility(model: Model, side: Side) -> tuple[float, ...]:
    """Driving-point mobility in uy at the bearings, mean level 20 lg |Y| by band, dB re 1 m/(N s).

    Of the free source, of the receiver on its mounts (Eq. 16), or of the bearings themselves,
    Y = i w (K + i w C)^-1 (Eq. 13a).
    """
    omega = 2.0 * np.pi * GRID
    network = assemble(model.system).modal()
    seats = [joint for joint in network.joints if joint.kind == "bearing"]
    if side == "joint":
        stiffness = [joint.stiffness + 1j * omega[:, None, None] * joint.damping for joint in seats]
        places = [joint.dofs.index("uy") for joint in seats]
        return _mean_level(np.array([1j * omega * np.linalg.inv(Z)[:, k, k] for Z, k in zip(stiffness, places)]))
    opened = replace(network, joints=tuple(joint for joint in network.joints if joint.kind != "bearing"))
    rows = {joint.name: getattr(joint, side)[joint.dofs.index("uy")] for joint in seats}
    outputs = [Output(name, "m/s", "velocity", row) for name, row in rows.items()]
    loads = [Load(name, "N", row) for name, row in rows.items()]
    return _mean_level(np.diagonal(frequency_response(opened, omega, outputs, loads), axis1=1, axis2=2).T)


def _mean_level(Y: Complex) -> tuple[float, ...]:
    level: Real = 20.0 * np.log10(abs(Y))
    return band_means(level.mean(axis=0), GRID)


def _trials(model: Model) -> tuple[Trial, ...]:
    data = model.to_dict()["components"]
    casing, train = data["casing"], data["gear_train"]
    heavier = {"components.casing.mass": 2.0 * casing["mass"]} | {
        f"components.casing.inertia.{key}": 2.0 * value for key, value in casing["inertia"].items()
    }
    thinner = {
        f"components.gear_train.shafts.{name}.diameter": 0.8 * shaft["diameter"]
        for name, shaft in train["shafts"].items()
    }
    softer = {
        f"components.gear_train.meshes.{name}.stiffness": 0.25 * mesh["stiffness"]
        for name, mesh in train["meshes"].items()
    }
    damped = {"components.gear_train.modal_damping": 3.0 * train["modal_damping"]}
    seats, feet = bearings(model), mounts(model)
    return (
        Trial("casing mass and inertia × 2", "receiver", _LOW, heavier),
        Trial("mount stiffness × 4", "receiver", _LOW, scaled_joints(model, feet, stiffness=4.0)),
        Trial("bearing stiffness × 0.5", "joint", _JOINT, scaled_joints(model, seats, stiffness=0.5)),
        Trial("bearing damping × 3", "joint", _JOINT_DAMPING, scaled_joints(model, seats, damping=3.0)),
        Trial("shaft diameter × 0.8", "source", _HIGH, thinner),
        Trial("mesh stiffness × 0.25", "source", _HIGH, softer),
        Trial("source damping × 3", "source", _SOURCE_DAMPING, damped),
    )


def _figure(side: Side, trials: tuple[Trial, ...], found: tuple[Effect, ...]) -> Figure:
    chosen = [effect for trial, effect in zip(trials, found) if trial.side == side]
    curves = {"original": found[0].original, **{effect.name: effect.changed for effect in chosen}}
    return ratio_figure(f"design-{side}", curves, ("alpha",), changes_seen(chosen, ("alpha",)), SIDES[side])


def _lowers(trial: Trial, effect: Effect) -> Claim:
    return judge(
        f"{trial.says}: {trial.name}.",
        "mean D of α below 0 dB: less of the input power is transmitted",
        effect.means("alpha"),
        lambda d: d < 0.0,
    )


def _mobility_table(trials: tuple[Trial, ...], shifts: list[list[float]]) -> Table:
    rows = [[trial.name, trial.side, *(number_of(v) for v in shift)] for trial, shift in zip(trials, shifts)]
    caption = (
        "What the change does to the mobility that it is about: mean change of 20 lg |Y| in uy at the bearings, dB"
    )
    return table(caption, ["change", "mobility of the", *BANDS], rows, text=2)


def _power_table(found: tuple[Effect, ...]) -> Table:
    rows = [[effect.name, *(number_of(v) for v in band_means(effect.power_difference(), GRID))] for effect in found]
    return table("Transmitted power at the same transmission error, mean change, dB", ["change", *BANDS], rows)
