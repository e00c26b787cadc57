"""The tables of the page: joints, components, modes, variables."""

from collections.abc import Collection, Iterable, Sequence
from html import escape

import numpy as np

from ...network.modal import ModalNetwork
from ...network.records import JointRows
from ...numerics.arrays import Real
from ..dependencies import TORQUE
from ..units import DISPLAY
from ..variables import Kind, Variable, motion_of
from .modes import ModalData

_SHOWN_MODES = 40
_JOINTS = (Kind.STIFFNESS, Kind.DAMPING, Kind.STIFFNESS_MATRIX, Kind.DAMPING_MATRIX)
_MATRICES = (Kind.MATRIX_A, Kind.MATRIX_B, Kind.MATRIX_C, Kind.MATRIX_D)
_GROUPS = (
    "Inputs",
    "Parameters",
    f"Following {TORQUE}",
    "Outputs",
    "States, derivatives and time",
    "Matrices of the state equations",
)


def table(head: Sequence[str], rows: Iterable[Sequence[str]], numbers: Collection[int] = ()) -> str:
    """A table of cells that are HTML already; `numbers` are the columns that hold numbers."""
    kinds = [' class="n"' if k in numbers else "" for k in range(len(head))]
    top = "".join(f"<th{kind}>{name}</th>" for name, kind in zip(head, kinds))
    body = "\n".join(
        "<tr>" + "".join(f"<td{kind}>{cell}</td>" for cell, kind in zip(row, kinds)) + "</tr>" for row in rows
    )
    return f'<div class="scroll"><table>\n<thead><tr>{top}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table></div>'


def number(value: float, digits: int = 6) -> str:
    """A number for reading, such as 1.2e+08 as 1.2 with a power of ten."""
    text = f"{value:.{digits}g}"
    if "e" in text:
        digits_, power = text.split("e")
        text = f"{digits_}&nbsp;·&nbsp;10<sup>{int(power)}</sup>"
    return text.replace("-", "−")


def joints(network: ModalNetwork) -> str:
    """Kind, ends, degrees of freedom and both matrices of every joint."""
    head = ("Joint", "Kind", "Between", "K", "C")
    rows = [
        (
            f"<code>{escape(joint.name)}</code>",
            escape(joint.kind),
            escape(f"{_end(network, joint.source)}, {_end(network, joint.receiver)}"),
            _matrix(joint, joint.stiffness, ""),
            _matrix(joint, joint.damping, ".s"),
        )
        for joint in network.joints
    ]
    return table(head, rows)


def _end(network: ModalNetwork, rows: Real) -> str:
    found = [name for name, block in network.components.items() if rows[:, block].any()]
    return " and ".join(found) or "ground"


def _matrix(joint: JointRows, matrix: Real, factor: str) -> str:
    """Upper half of a symmetric matrix, entry by entry with its unit."""
    lines = []
    for i, row in enumerate(joint.dofs):
        for k, column in enumerate(joint.dofs[i:], start=i):
            if i == k or matrix[i, k]:
                unit = motion_of(("N.m" if row.startswith("r") else "N") + factor, column)
                pair = row if i == k else f"{row},{column}"
                lines.append(f"{escape(pair)}: {number(float(matrix[i, k]))}&nbsp;{escape(unit)}")
    return "<br>".join(lines)


def components(network: ModalNetwork) -> str:
    """What every component brings: rigid and elastic free-free modes, their frequencies and damping."""
    rows = []
    for name, block in network.components.items():
        squares = network.eigenvalues[block]
        elastic = np.sqrt(squares[squares > 0]) / (2.0 * np.pi)
        span = f"{number(elastic.min(), 5)} to {number(elastic.max(), 5)}" if elastic.size else "none"
        own = network.damping + sum((D**2).sum(axis=0) for D in network.dashpots.values())
        ratios = own[block][squares > 0] / (4.0 * np.pi * elastic)
        ends = dict.fromkeys(number(float(end)) for end in (ratios.min(), ratios.max())) if elastic.size else ("none",)
        rows.append((escape(name), str(int((squares == 0).sum())), str(elastic.size), span, " to ".join(ends)))
    head = ("Component", "Rigid motions", "Elastic modes", "Natural frequencies, free, Hz", "Damping ratio")
    return table(head, rows, (1, 2, 3, 4))


def modes(network: ModalNetwork, data: ModalData, highest: float) -> str:
    """Modes of the assembled model up to a frequency, at most forty."""
    shown = [mode for mode in data.modes if mode.frequency <= highest][:_SHOWN_MODES] or list(data.modes[:1])
    names = list(network.components)
    rows = []
    for k, mode in enumerate(shown, start=1):
        largest = int(np.argmax(mode.shares))
        where = f"{escape(names[largest])} ({100.0 * mode.shares[largest]:.0f}&nbsp;%)"
        rows.append((str(k), number(mode.frequency), number(100.0 * mode.damping, 4), where))
    rest = [f"{len(data.modes) - len(shown)} more modes lie above"] if len(data.modes) > len(shown) else []
    rest += [f"{data.rigid} rigid motions are free"] if data.rigid else []
    if data.decaying.size:
        rest.append(f"{data.decaying.size} poles are real, the slowest {number(data.decaying[0], 4)}&nbsp;rad/s")
    note = f"<p>{'; '.join(rest)}.</p>" if rest else ""
    head = ("No.", "Natural frequency, Hz", "Damping ratio, %", "Most kinetic energy in")
    return table(head, rows, (0, 1, 2)) + note


def variables(every: Sequence[Variable]) -> str:
    """All variables by what they are for; the long list of states folded away."""
    parts = []
    for heading in _GROUPS:
        group, folded = [v for v in every if _group(v) == heading], heading.startswith("States")
        if not group:
            continue
        content = table(("Name", "Unit", "Start", "Meaning"), map(_variable, group))
        if folded:
            parts.append(f"<details><summary>{heading} ({len(group)})</summary>\n{content}\n</details>")
        else:
            parts.append(f"<h3>{heading} ({len(group)})</h3>\n{content}")
    return "\n".join(parts)


def _group(variable: Variable) -> str:
    inputs, parameters, following, outputs, states, matrices = _GROUPS
    if variable.kind in _MATRICES:
        return matrices
    if variable.causality == "local" and variable.kind in _JOINTS:
        return following
    return {"input": inputs, "parameter": parameters, "output": outputs}.get(variable.causality, states)


def _variable(variable: Variable) -> tuple[str, str, str, str]:
    size = f" <small>[{', '.join(map(str, variable.shape))}]</small>" if variable.shape else ""
    unit = "" if variable.unit is None else escape(variable.unit)
    if variable.unit and variable.unit in DISPLAY and variable.kind not in (Kind.FRF_REAL, Kind.FRF_IMAG):
        unit += f" <small>({escape(DISPLAY[variable.unit][0])})</small>"
    return f"<code>{escape(variable.name)}</code>{size}", unit, _start(variable), escape(variable.description)


def _start(variable: Variable) -> str:
    if variable.start is None:
        return ""
    if not isinstance(variable.start, tuple):
        return number(variable.start)
    values = np.array(variable.start).reshape(variable.shape or -1)
    if not values.any():
        return "0"
    rows = values if values.ndim == 2 else values[None]
    return "<br>".join(" &nbsp; ".join(number(x) for x in row) for row in rows.tolist())
