"""Linux, Windows and Arm compute the same doubles, bit by bit, in everything that an FMU does."""

import re

import numpy as np
import pytest
from platform_scenarios import LOADS, co_simulation, every_scenario, held_inputs, new_bearing
from platform_script import Script, parsed, values

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("platforms")]
SCENARIOS = every_scenario()


@pytest.fixture(scope="module")
def expected(fmus, linux, run):
    """What the host prints on this machine, by FMI version and scenario, run once each."""
    outputs = {}

    def output(fmi, name):
        if (fmi, name) not in outputs:
            script = Script(fmus[fmi], linux)
            SCENARIOS[name](script)
            outputs[fmi, name] = run(script)
        return outputs[fmi, name]

    return output


def lines_that_differ(first: str, second: str) -> list[tuple[int, str, str]]:
    a, b = first.splitlines(), second.splitlines()
    different = [(k, x[:80], y[:80]) for k, (x, y) in enumerate(zip(a, b)) if x != y]
    return different if len(a) == len(b) else [*different, (min(len(a), len(b)), "the end of", "one of them")]


@pytest.mark.parametrize("name", list(SCENARIOS))
def test_same_doubles(name, fmu, other, run, expected):
    script = Script(fmu, other)
    SCENARIOS[name](script)
    found, reference = run(script), expected(fmu.fmi, name)
    bad = [call for call in parsed(found) if call.status or call.name == "log"]
    assert not bad, bad[0]
    assert len(reference.splitlines()) > 10
    assert lines_that_differ(reference, found) == []


def test_the_numbers_are_no_zeros(fmu, expected):
    """The comparison is of numbers that mean something: all finite, hardly any zero, most of them different."""
    numbers = np.concatenate(values(expected(fmu.fmi, "held inputs")))
    assert np.isfinite(numbers).all()
    assert (numbers != 0).mean() > 0.9
    assert len(np.unique(numbers)) > 2000


def test_both_versions_of_fmi_compute_the_same(fmus, expected):
    """One core: the outputs that both have are the same doubles in co-simulation."""
    outputs = [
        dict(zip(_scalars(fmus[fmi]), np.array(values(expected(fmi, "held inputs"))).T)) for fmi in ("2.0", "3.0")
    ]
    shared = [name for name in outputs[0] if name in outputs[1]]
    assert len(shared) > 80
    for name in shared:
        assert outputs[0][name].tobytes() == outputs[1][name].tobytes(), name


def _scalars(fmu):
    """A name for each number of a line of outputs."""
    return [
        name if fmu.size[name] == 1 else f"{name}[{k}]" for name in fmu.names("output") for k in range(fmu.size[name])
    ]


def test_a_state_travels_to_another_machine(fmu, linux, other, run):
    """Saved here in mid-run, read there, gone on with: the same doubles as without the journey."""
    inputs, h, cut = held_inputs(30), 1e-5, 12
    whole = Script(fmu, linux)
    co_simulation(whole, inputs, h, change_at=5)
    there = values(run(whole))[cut:]

    first = Script(fmu, linux)
    co_simulation(first, inputs[:cut], h, change_at=5)
    first.call("keep")
    first.call("serialise")
    (saved,) = re.findall(r"^serialise 0 ([0-9a-f]+)$", run(first), re.M)

    second = Script(fmu, other)
    second.start("cs")
    second.call("deserialise", saved)
    second.call("restore")
    for k in range(cut, len(inputs)):
        second.set(dict(zip(LOADS, inputs[k])))
        second.get(fmu.names("output"))
        second.step(k * h, h)
    second.get(fmu.names("output"))
    here = values(run(second))
    assert len(here) == len(there)
    assert [row.tobytes() for row in here] == [row.tobytes() for row in there]


def test_a_damaged_state_is_refused_everywhere(fmu, machine, run):
    script = Script(fmu, machine)
    script.start("cs")
    script.call("keep")
    script.call("serialise")
    (saved,) = re.findall(r"^serialise 0 ([0-9a-f]+)$", run(script), re.M)
    middle = len(saved) // 2
    flipped = saved[:middle] + f"{int(saved[middle], 16) ^ 1:x}" + saved[middle + 1 :]
    script.call("deserialise", flipped)
    script.call("deserialise", saved[:-16])
    calls = parsed(run(script))
    assert [call.status for call in calls if call.name == "deserialise"] == [3, 3]
    assert sum(call.name == "log" for call in calls) == 2


def test_a_wrong_bearing_is_refused_everywhere(fmu, machine, run):
    """A negative stiffness: an error with a sentence that names it, and no result changes."""
    outputs = fmu.names("output")
    script = Script(fmu, machine)
    script.start("cs")
    script.set({"mesh.force": 1.0})
    script.step(0.0, 1e-5)
    script.get(outputs)
    script.set({name: -np.asarray(value) for name, value in new_bearing(fmu.fmi).items()})
    script.get(outputs)
    before, message, refused, after = parsed(run(script))[-4:]
    assert before.words == after.words
    assert (message.name, refused.name, refused.status) == ("log", "set", 3)
    assert "bearing_2.stiffness" in " ".join(message.words)
