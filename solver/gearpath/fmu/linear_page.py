"""documentation/index.html of a linear system: its signals, poles and frequency response, and how the FMU behaves."""

from collections.abc import Iterator, Sequence
from html import escape

import numpy as np

from ..numerics.arrays import Complex, Real
from .description import LOG_CATEGORIES, Experiment
from .documentation import tables
from .documentation.page import page
from .documentation.plots import decibels
from .documentation.svg import DASHES, Curve, legend, plot
from .documentation.tables import number, table
from .linear_system import LinearSystem
from .variables import Variable

_POINTS, _DEPTH = 400, 160.0  # lines of a plot; dB of its largest axis
_MOST = 8  # inputs with a plot, and curves in each
_SHOWN_POLES = 60
_EQUATIONS = """
<p class="eq">x′ = A x + B u,&emsp;y = C x + D u</p>
<p>{n} states x, {m} inputs u, {p} outputs y, all in the units of the table below, starting at x = 0. The matrices are
fixed; there are no parameters.</p>
"""
_USE = """
<p>Steps are exact for the signal between communication points, at any step size, fixed or not: the inputs are held at
the values set before the step, or vary linearly where the importer gives {linear}. An output with direct feedthrough
follows an input at once: the dependencies say which. In a loop with another FMU the inputs of a step are the other's
outputs at its start, which delays the loop by up to one step; choose the step so that this costs little phase at
the crossover frequency.</p>
<p>Model exchange has the same equations, without events. Directional derivatives are the entries of A, B, C and D;
states can be kept, restored and serialised, also for another process or platform. Nothing is needed beside the FMU.
A call that cannot be done returns an error, logs a sentence and changes nothing. Log categories:</p>
<dl>
{categories}
</dl>
"""
_LINEAR = {
    "2.0": "their first derivatives (<code>fmi2SetRealInputDerivatives</code>)",
    "3.0": "their values at the end of the step (<code>fmi3IntermediateUpdate</code>)",
}


def linear_page(
    system: LinearSystem,
    variables: Sequence[Variable],
    *,
    fmi: str,
    description: str,
    version: str,
    experiment: Experiment,
    plots: bool = True,
) -> bytes:
    """The page; without `plots` there are no figures on it."""
    categories = "\n".join(f"<dt><code>{k}</code></dt><dd>{escape(v)}</dd>" for k, v in LOG_CATEGORIES.items())
    equations = _EQUATIONS.format(n=len(system.states), m=len(system.inputs), p=len(system.outputs))
    sections = {
        "equations": ("Equations", equations),
        "poles": ("Poles", _poles(system)),
        "response": ("Frequency response", "\n".join(_figures(system)) if plots else ""),
        "use": ("Use", _USE.format(linear=_LINEAR[fmi], categories=categories)),
        "variables": ("Variables", tables.variables(variables)),
    }
    start, stop, step = experiment.start_time, experiment.stop_time, experiment.step_size
    facts = {
        "Interface": f"FMI {fmi}, model exchange and co-simulation",
        "Stable": _stability(system),
        "Variables": f"{len(variables)}",
        "Default experiment": f"{start:g} s to {stop:g} s in steps of {step:g} s",
    }
    return page(system.name, description, facts, sections, version)


def _stability(system: LinearSystem) -> str:
    growth = system.poles.real.max(initial=-np.inf)
    if growth < 0:
        return "yes"
    return "no pole grows, but some do not decay" if growth == 0 else "no: a pole grows"


def _poles(system: LinearSystem) -> str:
    """Poles with their frequency and damping ratio, one row for a conjugate pair."""
    shown = [pole for pole in system.poles if pole.imag >= 0]
    rows = [
        (
            number(float(pole.real)) + (f"&nbsp;±&nbsp;{number(float(pole.imag))}&nbsp;i" if pole.imag else ""),
            number(float(abs(pole)) / (2.0 * np.pi)),
            number(float(-pole.real / abs(pole)), 4) if pole else "",
        )
        for pole in shown[:_SHOWN_POLES]
    ]
    if not rows:
        return ""
    more = f"<p>{len(shown) - _SHOWN_POLES} more are faster.</p>" if len(shown) > _SHOWN_POLES else ""
    return table(("Pole, rad/s", "Frequency, Hz", "Damping ratio"), rows, (0, 1, 2)) + more


def response(system: LinearSystem, frequency: Real) -> Complex:
    """G(i w) = C (i w I - A)^-1 B + D at frequencies in Hz: (F, p, m); gaps (NaN) on an undamped pole."""
    n = len(system.A)
    G = np.full((len(frequency), *system.D.shape), np.nan + 0j)
    for k, s in enumerate(2j * np.pi * frequency):
        try:
            G[k] = system.C @ np.linalg.solve(s * np.eye(n) - system.A, system.B.astype(complex)) + system.D
        except np.linalg.LinAlgError:
            continue
    return G


def _band(system: LinearSystem) -> tuple[float, float]:
    """From a tenth of the slowest to ten times the fastest pole, six decades at most, Hz."""
    corners = abs(system.poles[abs(system.poles) > 0]) / (2.0 * np.pi)
    if not corners.size:
        return 1.0, 1e4
    high = 10.0 * float(corners.max())
    return max(0.1 * float(corners.min()), 1e-6 * high), high


def _figures(system: LinearSystem) -> Iterator[str]:
    """Magnitude and phase from every input, at most eight, to the first eight outputs."""
    f = np.geomspace(*_band(system), _POINTS)
    G = response(system, f)
    marks = np.asarray(np.unique(abs(system.poles)) / (2.0 * np.pi), dtype=float)
    for k, name in enumerate(system.inputs[:_MOST]):
        chosen = [i for i in range(len(system.outputs)) if abs(np.nan_to_num(G[:, i, k])).any()][:_MOST]
        for part, unit, depth in (("magnitude", "20 lg |G|, dB", _DEPTH), ("phase", "phase of G, degrees", 1e9)):
            curves = [
                Curve(system.outputs[i], _level(part, G[:, i, k]), place, DASHES[place % len(DASHES)])
                for place, i in enumerate(chosen)
            ]
            if not curves:
                continue
            words = f"{part.capitalize()} of the response to {name}, {f[0]:g} to {f[-1]:g} Hz."
            drawing = plot(f"{part}-{k}", f, curves, unit, words, marks[marks > 0], depth)
            caption = f"<figcaption>{part.capitalize()} of the response to {escape(name)}</figcaption>"
            yield f"<figure>\n{caption}\n{drawing}\n{legend(curves)}\n</figure>"


def _level(part: str, G: Complex) -> Real:
    return decibels(G) if part == "magnitude" else np.degrees(np.unwrap(np.angle(G)))
