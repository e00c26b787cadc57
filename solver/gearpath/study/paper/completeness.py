"""Sec. 4: static completeness of the source's basis, and the paper's Lanczos vectors."""

from __future__ import annotations

from ...modelfile import Model
from ...report.layout import COLOURS, DASHES, LEGEND, SYMBOLS, Figure, axis, line, page
from ...report.wording import number
from ..completeness import Completeness, Convergence, completeness_table, static_completeness
from .claims import Claim, judge
from .machine import shipped
from .record import Study

COUNTS = (4, 9, 12, 18, 24, 36)
ENOUGH = 0.1  # dB, mean deviation of alpha that is less than the width of a curve
FEW = 18  # vectors, about a quarter of the source's coordinates
_BLOCK, _MESH, _FREE = "Lanczos, block start", "Lanczos, mesh start", "free-interface modes"


def study(model: Model | None = None) -> Study:
    """Deviation of alpha over the size of the basis, five ways to reduce the source."""
    found = static_completeness(model or shipped(), COUNTS)
    block, mesh = found.curve(_BLOCK), found.curve(_MESH)
    return Study(
        key="completeness",
        title="Sec. 4: static completeness",
        done=f"The source's {found.coordinates} coordinates reduced in five ways, excited by the inertial force of the "
        "mesh. The paper's way (Eq. 10): constraint modes, and Lanczos vectors of the constrained interior that start "
        "from its static response to the mesh force (mesh start).",
        figures=(_figure(found),),
        claims=(
            judge(
                "Static completeness of the basis minimises truncation errors.",
                f"coordinates for a mean |difference| of α below {ENOUGH:g} dB: constraint modes and Lanczos vectors "
                f"(block start) against free-interface modes alone (∞: {COUNTS[-1]} are not enough)",
                [(_needed(block), _needed(found.curve(_FREE)))],
                lambda few, many: few < many,
                [""],
                unit="",
                digits=0,
            ),
            _few_vectors(mesh),
        ),
        tables=(completeness_table(found),),
        remarks=(
            "A block start, from the static response to the mesh force and from the inertia forces of the constraint "
            f"modes, leaves a mean |difference| of {', '.join(_deviations(block))}.",
        ),
    )


def _few_vectors(mesh: Convergence) -> Claim:
    tried = {f"{count:.0f} vectors": float(mean) for count, mean in zip(mesh.vectors, mesh.mean) if count <= FEW}
    return judge(
        "Few Lanczos vectors suffice where the static displacement is the first of them.",
        f"mean |difference| of α below {ENOUGH:g} dB with at most {FEW} vectors, mesh start",
        list(tried.values()),
        lambda d: d < ENOUGH,
        list(tried),
        digits=None,
    )


def _needed(curve: Convergence) -> float:
    """Coordinates of the smallest basis from which on the mean deviation stays low; infinite if none is enough."""
    enough = float("inf")
    for size, mean in list(zip(curve.size, curve.mean))[::-1]:
        if mean >= ENOUGH:
            break
        enough = float(size)
    return enough


def _deviations(curve: Convergence) -> list[str]:
    return [f"{number(mean, 2)} dB with {count:.0f}" for count, mean in zip(curve.vectors, curve.mean)]


def _figure(found: Completeness) -> Figure:
    data = []
    for k, curve in enumerate(found.curves):
        trace = line(curve.size, curve.mean, curve.method, COLOURS[k], DASHES[k])
        data.append(
            {**trace, "mode": "lines+markers", "marker": {"symbol": SYMBOLS[k], "size": 8, "color": COLOURS[k]}}
        )
    layout = page(
        400,
        xaxis=axis("coordinates of the reduced source"),
        yaxis=axis("mean |difference| of α, dB", type="log", exponentformat="power", dtick=1),
        legend={**LEGEND, "y": 1.02},
        hovermode="closest",
    )
    best = min(found.curves, key=_needed)
    caption = (
        "Mean |difference| of α from the complete basis over the size of the reduced one. Below "
        f"{ENOUGH:g} dB with the fewest coordinates: {best.method}, {_needed(best):.0f}. Each mark is one basis of "
        f"{', '.join(str(count) for count in COUNTS)} vectors, beside constraint modes or residuals where the method "
        "has them."
    )
    return Figure("completeness", caption, "Deviation over size of the basis, five methods.", data, layout)
