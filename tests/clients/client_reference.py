"""What a client must find: python-control's exact discretisations of `gp.state_space`, and nothing of the FMU.

All values are dictionaries from the FMU's variable names (a dot where python-control has a slash) to arrays over time.
"""

from dataclasses import dataclass

import control
import numpy as np

import gearpath as gp

LOADS = ("mesh.transmission_error", "mesh.force")
BEARINGS = ("bearing_1", "bearing_2", "bearing_3", "bearing_4")
LINEAR = (  # forces, moments, velocities and accelerations, most of them with a feedthrough from both loads
    "bearing_1.force_uy",
    "bearing_1.force_rx",
    "bearing_1.velocity_uy",
    "bearing_2.velocity_rx",
    "bearing_3.force_uy",
    "bearing_4.force_rx",
    "mount_1.force_uy",
    "mesh.velocity",
    "casing.velocity_uy",
    "casing.acceleration_uy",
    "casing.acceleration_rx",
    "casing.velocity_rz",
)
POWERS = tuple(f"{bearing}.power" for bearing in BEARINGS)
SPECTRAL = ("alpha", "bearing_2.alpha", "frf.bearing_1.force_uy.re", "frf.bearing_1.force_uy.im")
WATCHED = LINEAR + POWERS + SPECTRAL
FREQUENCY = 1234.0  # Hz, of the spectral outputs, unless a run says otherwise


@dataclass(frozen=True)
class Steps:
    """Loads that are held over steps of one length: row k acts from k step to (k + 1) step."""

    step: float
    loads: np.ndarray

    @property
    def times(self):
        return self.step * np.arange(len(self.loads) + 1)

    @staticmethod
    def random(step, count, seed=1):
        """White loads of the size that gears make: micrometres and some newtons."""
        return Steps(step, np.random.default_rng(seed).standard_normal((count, 2)) * [1e-6, 10.0])


def _signals(plant, outputs):
    """Linear outputs by name, and the instantaneous powers: force by velocity of the receiver, summed over the port."""
    values = dict(zip((label.replace("/", ".") for label in plant.output_labels), outputs.T))
    for bearing in BEARINGS:
        port = [(values[f"{bearing}.force_{dof}"], values[f"{bearing}.velocity_{dof}"]) for dof in ("uy", "rx")]
        values[f"{bearing}.power"] = sum(force * velocity for force, velocity in port)
    return values


def spectral(model, count, frequency=FREQUENCY):
    """The frequency-domain outputs, constant over `count` samples: power ratios, and a transfer by python-control."""
    flow = gp.power_flow(model, [frequency])
    transfer = gp.state_space(model)["bearing_1/force_uy", "mesh/transmission_error"](2j * np.pi * frequency)
    values = {
        "alpha": float(flow.alpha.item()),
        "bearing_2.alpha": float(sum(flow.path_alpha.sel(path=f"bearing_2.{dof}").item() for dof in ("uy", "rx"))),
        "frf.bearing_1.force_uy.re": transfer.real,
        "frf.bearing_1.force_uy.im": transfer.imag,
    }
    return {name: np.full(count, value) for name, value in values.items()}


def held(models, steps, *, fresh=False):
    """Every step by the exact zero-order hold, read at the step's end.

    `models` is one model, or one for every step (a bearing exchanged on the way). The loads at the reading are still
    those of the step, as a client sees that reads before it sets the next ones; `fresh`: they, and the model, are
    already the next step's.
    """
    models = models if isinstance(models, list) else [models] * len(steps.loads)
    plants = {id(model): gp.state_space(model) for model in models}
    discrete = {key: control.sample_system(plant, steps.step, "zoh") for key, plant in plants.items()}
    state, outputs = np.zeros(plants[id(models[0])].nstates), []
    for k, (model, loads) in enumerate(zip(models, steps.loads)):
        system = discrete[id(model)]
        state = system.A @ state + system.B @ loads
        at = min(k + 1, len(models) - 1) if fresh else k
        seen = discrete[id(models[at])]
        outputs.append(seen.C @ state + seen.D @ steps.loads[at])
    return _signals(plants[id(models[0])], np.array(outputs)) | spectral(models[-1], len(steps.loads))


def interpolated(model, times, loads):
    """The exact response to loads that run straight from sample to sample, at all `times` but the first."""
    plant = gp.state_space(model)
    response = control.forced_response(plant, times, loads.T)
    return _signals(plant, response.outputs.T[1:]) | spectral(model, len(times) - 1)


class Tones:
    """Smooth loads: 1 - cos of transmission error, a sine of force; and the exact response to them.

    They are made by linear equations of their own, z' = S z, u = G z, so that the response is one autonomous system
    together with the plant's: no sampling of the loads, no error but rounding.
    """

    rates = 2 * np.pi * np.array([900.0, 2600.0])
    sizes = np.array([1e-6, 10.0])

    def __call__(self, time):
        return self.sizes * [1.0 - np.cos(self.rates[0] * time), np.sin(self.rates[1] * time)]

    def response(self, model, interval, count):
        """At k `interval`, k = 0 ... `count`."""
        plant = gp.state_space(model)
        generator, read = np.zeros((5, 5)), np.zeros((2, 5))  # z = 1, cos, sin of the one; cos, sin of the other
        for place, rate in zip((1, 3), self.rates):
            generator[place, place + 1], generator[place + 1, place] = -rate, rate
        read[0, :2], read[1, 4] = [self.sizes[0], -self.sizes[0]], self.sizes[1]
        start = np.concatenate([np.zeros(plant.nstates), [1.0, 1.0, 0.0, 1.0, 0.0]])
        both = control.ss(
            np.block([[plant.A, plant.B @ read], [np.zeros((5, plant.nstates)), generator]]),
            np.zeros((len(start), 1)),
            np.hstack([plant.C, plant.D @ read]),
            np.zeros((plant.noutputs, 1)),
        )
        response = control.initial_response(both, interval * np.arange(count + 1), start)
        return _signals(plant, response.outputs.T) | spectral(model, count + 1)


def deviations(found, expected, names=WATCHED):
    """Largest deviation of each variable, divided by its largest value."""
    result = {}
    for name in names:
        values = np.asarray(found[name])
        assert values.shape == expected[name].shape, (name, values.shape, expected[name].shape)
        scale = np.max(np.abs(expected[name]))
        assert scale > 0.0, f"{name} stays at zero: nothing is compared"
        result[name] = float(np.max(np.abs(values - expected[name])) / scale)
    return result


def check(found, expected, limit, names=WATCHED):
    """All variables agree to `limit` of their largest values."""
    worst = deviations(found, expected, names)
    assert max(worst.values()) <= limit, {name: value for name, value in worst.items() if not value <= limit}
