"""How far a reduced model is from the complete one, and whether it is stable and passive.

    error = max over pairs (output, input) of  max_f |H_r - H| / max_f |H|        f in the band

Both maxima are looked for on a grid that has every resonance of both models in steps of a fraction of its width, and
refined where they lie until they stand. What the grid still hides is covered by a margin of 1 %. Far below all modes
the responses of a machine that turns freely lose their digits, as 1 / f^2: what is left of them at the lower end of the
band is measured, and added for both models.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...network.modal import ModalNetwork
from ...network.records import JointRows, Output
from ...network.response import frequency_response
from ...network.time_twin import time_twin
from ...numerics.arrays import Complex, Real
from .grid import between, resonant_grid

Places = np.ndarray[tuple[int], np.dtype[np.intp]]
Response = Callable[[Real], Complex]  # omega (F,), rad/s -> (F, outputs, inputs)

_MARGIN = 1.01
_ROUNDING = 1e-9  # an error below this is made of rounding, which has peaks everywhere
_STANDS = 1e-4  # relative change of the error after which it is not refined further
_ROUNDS = 8
_PEAKS = 100  # that are refined at a time, the highest ones
_THINNED = 4
_LOWEST = 8  # lines at the lower end of the band, on which rounding is measured: its size is accidental
_UNIT = 1.1  # of the joints' degrees of freedom in a second solution
_BOTH = 4.0  # both models round, and either up to twice as much as the two solutions are apart
_NOTED = 0.1, 1e-5  # part of an error that is rounding, and size of that, from which on the certificate says so
_SILENT = 1e-9  # a gain below this part of the largest of its kind is a zero of the machine's symmetry, not a response


@dataclass(frozen=True)
class Certificate:
    """What is certain of a reduced model over a band."""

    error: float  # largest deviation of any input-output pair in the band, relative to the pair's own largest gain
    frequency: float  # Hz, where it occurs
    pair: tuple[str, str]  # (output, input) that it occurs in
    order: int  # second-order coordinates; the model has twice as many states
    complete: int  # coordinates of the complete model
    stable: bool  # no pole to the right of the imaginary axis
    passive: bool  # positive real between forces and velocities of the same places
    method: str
    band: tuple[float, float]  # Hz
    note: str = ""  # why the order is not the one asked for, or the error cannot be smaller

    def __str__(self) -> str:
        found = "passive" if self.passive else "NOT passive"
        return (
            f"{self.method}: order {self.order} of {self.complete}, error {self.error:.2g} of the largest gain "
            f"from {self.band[0]:g} to {self.band[1]:g} Hz (worst at {self.frequency:.5g} Hz, {self.pair[0]} from "
            f"{self.pair[1]}), {'stable' if self.stable else 'NOT stable'}, {found}"
            + (f"; {self.note}" if self.note else "")
        )


@dataclass(frozen=True)
class Deviation:
    """The largest deviation, where, and in which output and input."""

    error: float
    frequency: float  # Hz
    output: int
    input: int


class Comparison:
    """The complete model's responses over a band, against which reduced ones are held; solved once for all of them."""

    def __init__(self, network: ModalNetwork, band: tuple[float, float]) -> None:
        self.network, self.band = network, band
        self.outputs = linear_outputs(network)
        self._poles = poles(network)
        self._kept: dict[float, Complex] = {}
        units = [output.unit for output in self.outputs]
        self._kinds = np.array([[a == b for b in units] for a in units])

    def exact(self, omega: Real) -> Complex:
        """Responses of the complete model, (F, outputs, inputs); remembered line by line."""
        missing = np.array([w for w in omega if w not in self._kept])
        if missing.size:
            found = frequency_response(self.network, missing, self.outputs, self.network.loads)
            self._kept.update(zip(missing.tolist(), found))
        return np.array([self._kept[w] for w in omega.tolist()])

    @cached_property
    def rounding(self) -> float:
        """Relative error that rounding may make of a deviation, from responses where the band begins in other units.

        P -> a P, K -> K / a^2, C -> C / a^2, g -> g / a: the same machine, rounded otherwise if a is no power of 2.
        """
        grid = self._grid(np.zeros(0, complex), _THINNED)
        H = self.exact(grid)
        other = H.copy()
        network = replace(self.network, joints=tuple(_in_units(joint, _UNIT) for joint in self.network.joints))
        other[:_LOWEST] = frequency_response(network, grid[:_LOWEST], self.outputs, network.loads)
        other[:_LOWEST, [output.quantity == "force" for output in self.outputs]] *= _UNIT
        return float(_BOTH * self._relative(H, other).max())

    def over(self, omega: Real, network: ModalNetwork) -> float:
        """The deviation of a reduced network on the lines omega (rad/s) alone."""
        found = frequency_response(network, omega, linear_outputs(network), network.loads)
        return self._worst(omega, self.exact(omega), found).error

    def rough(self, respond: Response) -> Deviation:
        """The deviation on a thin grid of the complete model's resonances: for choosing, not for certifying."""
        grid = self._grid(np.zeros(0, complex), _THINNED)
        return self._worst(grid, self.exact(grid), respond(grid))

    def deviation(self, respond: Response, own_poles: Complex) -> Deviation:
        """The deviation on the grid of both models' resonances, refined until it stands, with its margin."""
        grid = self._grid(own_poles)
        H, found = self.exact(grid), respond(grid)
        worst = self._worst(grid, H, found)
        for _ in range(_ROUNDS):
            if worst.error < _ROUNDING:
                break
            new = between(grid, self._peaks(H, found))
            new = new[~np.isin(new, grid)]
            grid, place = np.unique(np.concatenate([grid, new]), return_index=True)
            H = np.concatenate([H, self.exact(new)])[place]
            found = np.concatenate([found, respond(new)])[place]
            last, worst = worst, self._worst(grid, H, found)
            if abs(worst.error - last.error) <= _STANDS * last.error:
                break
        return Deviation(_MARGIN * worst.error + self.rounding, worst.frequency, worst.output, worst.input)

    def _grid(self, own_poles: Complex, thinned: int = 1) -> Real:
        w = 2.0 * np.pi * np.array(self.band)
        return resonant_grid(np.concatenate([self._poles, own_poles]), (float(w[0]), float(w[1])), thinned)

    def _relative(self, H: Complex, found: Complex) -> Real:
        """Deviation of every line and pair relative to the pair's largest gain."""
        gain = abs(H).max(axis=0)
        kind = np.array([gain[same].max(axis=0) for same in self._kinds])
        scale = np.maximum(gain, _SILENT * kind)
        return np.asarray(np.divide(abs(found - H), scale, out=np.zeros(H.shape), where=scale > 0.0))

    def _worst(self, grid: Real, H: Complex, found: Complex) -> Deviation:
        relative = self._relative(H, found)
        line, output, load = np.unravel_index(np.argmax(relative), relative.shape)
        place = float(grid[line]) / (2.0 * np.pi)
        return Deviation(float(relative[line, output, load]), place, int(output), int(load))

    def _peaks(self, H: Complex, found: Complex) -> Places:
        """Lines beside which a larger deviation, or a larger gain to relate it to, may hide."""
        relative = self._relative(H, found)
        worst = relative.max(axis=0)
        candidates = worst > 0.3 * worst.max()
        curves = relative[:, candidates]
        end = np.zeros((1, curves.shape[1]))
        padded = np.vstack([end, curves, end])
        local = (padded[1:-1] >= padded[:-2]) & (padded[1:-1] >= padded[2:]) & (curves > 0.3 * curves.max(axis=0))
        height = np.where(local, curves / curves.max(axis=0), 0.0).max(axis=1)
        peaks = np.argsort(-height, kind="stable")[: min(_PEAKS, np.count_nonzero(height))]
        gains = abs(H[:, candidates]).argmax(axis=0)
        return np.unique(np.concatenate([peaks, gains]))


def _in_units(joint: JointRows, a: float) -> JointRows:
    """A joint whose degrees of freedom are counted in units a times smaller."""
    return replace(
        joint,
        source=a * joint.source,
        receiver=a * joint.receiver,
        stiffness=joint.stiffness / a**2,
        damping=joint.damping / a**2,
    )


def linear_outputs(network: ModalNetwork) -> tuple[Output, ...]:
    """All outputs but powers."""
    return tuple(output for output in network.outputs if output.quantity != "power")


def poles(network: ModalNetwork) -> Complex:
    """Poles of the coupled network, rad/s."""
    return np.asarray(np.linalg.eigvals(time_twin(network, outputs=()).A))


def certify(
    network: ModalNetwork, comparison: Comparison, method: str, *, stable: bool, passive: bool, note: str = ""
) -> Certificate:
    """The certificate of a reduced network."""

    def respond(omega: Real) -> Complex:
        return frequency_response(network, omega, linear_outputs(network), network.loads)

    found = comparison.deviation(respond, poles(network))
    return certificate_of(
        found, comparison, method, len(network.eigenvalues), stable=stable, passive=passive, note=note
    )


def certificate_of(
    found: Deviation,
    comparison: Comparison,
    method: str,
    order: int,
    *,
    stable: bool,
    passive: bool,
    note: str = "",
) -> Certificate:
    """The certificate that states a deviation."""
    network, floor = comparison.network, comparison.rounding
    if floor > max(_NOTED[0] * found.error, _NOTED[1]):
        low = comparison.band[0]
        note = f"{note}; " * bool(note) + f"{floor:.2g} of the error is rounding at {low:g} Hz: begin the band higher"
    return Certificate(
        found.error,
        found.frequency,
        (comparison.outputs[found.output].name, network.loads[found.input].name),
        order,
        len(network.eigenvalues),
        stable,
        passive,
        method,
        comparison.band,
        note,
    )
