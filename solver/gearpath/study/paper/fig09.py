"""Fig. 9: damping and stiffness of the bearings."""

from __future__ import annotations

import numpy as np

from ...modelfile import Model
from ...numerics.arrays import Real
from ...report.table import Table, table
from ...report.wording import number
from .claims import HIGHER, LOWER, Claim, judge, little, noticeable, number_of
from .drawing import changes_seen, ratio_figure
from .effect import BANDS, Effect, Ratios, band_means, by_band, effects
from .machine import bearings, scaled_joints, shipped
from .record import Study

LITTLE = 0.1  # a relative motion or a loss below this part counts as little


def study(model: Model | None = None) -> Study:
    """alpha with more damping (a), and with softer and stiffer bearings whose damping is kept (b)."""
    model = model or shipped()
    names = bearings(model)
    original, found = effects(
        model,
        {
            "damping × 3": scaled_joints(model, names, damping=3.0),
            "stiffness × 0.5": scaled_joints(model, names, stiffness=0.5),
            "stiffness × 2": scaled_joints(model, names, stiffness=2.0),
        },
    )
    damped, soft, stiff = found
    return Study(
        key="fig09",
        title="Fig. 9: damping and stiffness of the bearings",
        done="(a) C of all bearings times 3; (b) K of all bearings times 0.5 and times 2, C kept.",
        figures=(
            ratio_figure(
                "fig09a",
                {"original": original, damped.name: damped.changed},
                ("alpha",),
                changes_seen([damped], ("alpha",)),
                "(a) Damping",
            ),
            ratio_figure(
                "fig09b",
                {"original": original, soft.name: soft.changed, stiff.name: stiff.changed},
                ("alpha",),
                changes_seen([soft, stiff], ("alpha",)),
                "(b) Stiffness",
            ),
        ),
        claims=(
            *_of_damping(damped),
            *_explanation(original, names),
            noticeable("Softer bearings: the effect is noticeable at the higher frequencies.", soft, "alpha", HIGHER),
            noticeable("Stiffer bearings: the effect is noticeable at the higher frequencies.", stiff, "alpha", HIGHER),
        ),
        effects=found,
        tables=(_motion_table({"original": original, damped.name: damped.changed}, names),),
    )


def relative_motion(machine: Ratios) -> tuple[float, ...]:
    """|v_shaft - v_casing| / |v_shaft| in uy, by band: median over the lines and the bearings."""
    radial = [str(path) for path in machine.flow.path.values if str(path).endswith(".uy")]
    shaft = machine.flow.velocity_source.sel(path=radial).values
    casing = machine.flow.velocity_receiver.sel(path=radial).values
    part = abs(shaft - casing) / abs(shaft)
    return tuple(float(np.median(band)) for band in by_band(part, machine.frequency))


def bearing_loss(machine: Ratios, names: list[str]) -> Real:
    """Power dissipated in the bearings relative to the input power, (F,)."""
    flow = machine.flow
    return np.asarray((flow.dissipated_power.sel(element=names).sum("element") / flow.input_power).values)


def _of_damping(damped: Effect) -> tuple[Claim, ...]:
    means = [abs(value) for value in damped.means("alpha")]
    return (
        little("At the lower frequencies the increased damping has minimal effect.", damped, "alpha", LOWER),
        judge(
            "It becomes increasingly important at the higher frequencies.",
            "|mean D| of α larger than in the band below",
            list(zip(means[1:], means)),
            np.greater,
            BANDS[1:],
        ),
    )


def _explanation(original: Ratios, names: list[str]) -> tuple[Claim, ...]:
    return (
        judge(
            "Not much is gained because there is little relative motion across the bearings.",
            f"|relative velocity| / |shaft velocity| in uy below {LITTLE:g}, median over lines and bearings",
            relative_motion(original),
            lambda part: part < LITTLE,
            unit="",
        ),
        judge(
            "Thus little power is dissipated in the bearings.",
            f"bearings' part of the dissipated power below {LITTLE:g}, band mean",
            band_means(bearing_loss(original, names), original.frequency),
            lambda part: part < LITTLE,
            unit="",
            digits=3,
        ),
    )


def _motion_table(machines: dict[str, Ratios], names: list[str]) -> Table:
    rows = []
    for name, machine in machines.items():
        lost = band_means(bearing_loss(machine, names), machine.frequency)
        rows.append([f"{name}: relative to shaft velocity, uy", *(number_of(v) for v in relative_motion(machine))])
        rows.append([f"{name}: power lost in the bearings, % of the input", *(number(100.0 * v) for v in lost)])
    return table("Motion across the bearings and power lost in them", ["", *BANDS], rows)
