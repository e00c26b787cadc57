"""Matrices read back, frequency outputs, what is refused, states."""

import zlib
from dataclasses import replace

import fmu_oracle as oracle
import numpy as np
import pytest
from fmu_driver import ERROR, OK, Fmu
from fmu_helpers import export
from fmu_states import Keeper
from fmu_tangent import LEVELS
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from schedule_machine import SCALE, START, TORQUE, TORQUES, interpolated, machine, new, read_matrix

from gearpath.network.records import MeshSource, Tone

BOTH = pytest.mark.parametrize("version", [2, 3])
DECIDED = {"bearing_1.stiffness": 2, "bearing_2.stiffness": 2, "bearing_2.damping": 2, "mount_1.stiffness": 1}
PHASES = [(False, p) for p in ("instantiated", "initialization", "stepping", "terminated")]
PHASES += [(True, p) for p in ("initialization", "event", "continuous")]


def by_name(network, name):
    joint, what = name.split(".")
    return getattr(next(j for j in network.joints if j.name == joint), what)


@BOTH
def test_matrices_between_the_points(fmus, scheduled, version):
    """At random torques, within and without: those of numpy.interp, symmetric, without negative eigenvalues."""
    fmu = new(fmus[version], version)

    @settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
    @given(st.one_of(st.floats(-50.0, 200.0), st.sampled_from([*TORQUES.tolist(), START, -1e300, 1e300])))
    def check(torque):
        assert fmu.set({TORQUE: torque}) == OK
        assert fmu.get([TORQUE]).tolist() == [torque]
        wanted = interpolated(scheduled, torque)
        for name, size in DECIDED.items():
            found = read_matrix(fmu, version, name, size)
            scale = SCALE[:size] if "stiffness" in name else 1e-3 * SCALE[:size]
            assert np.abs((found - by_name(wanted, name)) / np.outer(scale, scale)).max() < 1e-13
            assert (found == found.T).all()
            assert np.linalg.eigvalsh(found / np.outer(scale, scale)).min() > -1e-14
        assert (read_matrix(fmu, version, "bearing_3.stiffness") == by_name(scheduled, "bearing_3.stiffness")).all()

    check()
    fmu.free()


@BOTH
@pytest.mark.parametrize("torque", [START, 10.0, 17.0, 25.0, 88.8, 100.0, 1e4, -7.0])
def test_frequency_outputs(fmus, scheduled, version, torque):
    """Against one dense solve with the interpolated matrices; no step between the change and the question."""
    fmu = new(fmus[version], version)
    network = interpolated(scheduled, torque)
    for hertz in (61.0, 900.0, 4000.0):
        assert fmu.set({"frequency": hertz, TORQUE: torque}) == OK
        expected = oracle.frequency_response(network, hertz)
        gross = max(abs(value) for name, value in expected.items() if "alpha" in name)
        for name, value in expected.items():
            found = fmu.get([name])[0]
            if "alpha" in name:
                assert abs(found - value) < 1e-9 * gross, name
                continue
            stem, kind = name.rsplit(".", 1)[0], name.rsplit(".", 2)[1]
            size = max(
                abs(complex(expected[f"{n[:-3]}.re"], expected[f"{n[:-3]}.im"]))
                for n in expected
                if n.endswith(f"{kind}.re")
            )
            assert abs(found - value) < 1e-9 * size, stem
    fmu.free()


def test_order_outputs_follow(scheduled, tmp_path):
    """The alpha of a tone is that of the frequency outputs at its frequency, at every torque."""
    tones = (Tone("mesh.harmonic_1", 1.0, 0.0, 1e-6, 0.3),)
    network = replace(scheduled, source=MeshSource("mesh.transmission_error", 1000.0, 23, tones))
    fmu = new(Fmu.unpack(export(network, tmp_path / "it.fmu"), tmp_path / "it"), 2)
    hertz, found = fmu.get(["mesh.harmonic_1.frequency"])[0], []
    for torque in (START, 90.0, 12.0, START):
        assert fmu.set({TORQUE: torque, "frequency": hertz}) == OK
        alpha, own, power = fmu.get(["alpha", "mesh.harmonic_1.alpha", "mesh.harmonic_1.power"])
        assert own == pytest.approx(alpha, rel=1e-12)
        assert alpha == pytest.approx(
            oracle.frequency_response(interpolated(network, torque), hertz)["alpha"], rel=1e-9
        )
        found.append(power)
    assert len(set(found)) == 3
    assert found[0] == found[3]
    fmu.free()


@BOTH
@pytest.mark.parametrize(("exchange", "phase"), PHASES)
def test_scheduled_matrices_cannot_be_set(fmus, version, exchange, phase):
    """Even to their own value; the sentence says what decides, and nothing changes."""
    fmu = new(fmus[version], version, exchange=exchange, phase=phase)
    before = fmu.serialised()
    for name, size in DECIDED.items():
        values = {name: np.zeros((size, size)) if size > 1 else 0.0}
        if version == 2 and size > 1:
            values = {f"{name}[1,2]": 0.0}
        assert fmu.set(values) == ERROR
        if phase != "terminated":
            assert "follows the input operation.torque, which decides it; set that input" in fmu.messages[-1]
        elif version == 2:
            assert "after terminating" in fmu.messages[-1]
        if phase == "stepping" and version == 2:
            assert fmu.set_slopes(dict.fromkeys(values, 1.0)) == ERROR
    assert fmu.serialised() == before
    if phase != "terminated" and not exchange:  # what does not follow is a parameter as before
        assert fmu.set({"mount_1.damping": 500.0, "mount_2.stiffness": 2e6}) == OK
    fmu.free()


@BOTH
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_torque_is_a_finite_number(fmus, version, value):
    fmu = new(fmus[version], version)
    assert fmu.set({"mesh.force": 1.0, TORQUE: value}) == ERROR
    assert "operation.torque" in fmu.messages[-1]
    assert fmu.get([TORQUE, "mesh.force"]).tolist() == [START, 0.0]
    fmu.free()


@BOTH
def test_reset(fmus, scheduled, version):
    fmu = new(fmus[version], version)
    begun = fmu.serialised()
    assert fmu.set({TORQUE: 60.0, "mesh.force": 1.0}) == OK
    assert fmu.step(0.0, 1e-5) == OK
    assert fmu.call(f"fmi{version}Reset") == OK
    fmu.enter("stepping")
    assert fmu.get([TORQUE]).tolist() == [START]
    K = by_name(interpolated(scheduled, START), "bearing_1.stiffness")
    assert read_matrix(fmu, version, "bearing_1.stiffness") == pytest.approx(K, rel=1e-14)
    fmu.free()
    fmu = new(fmus[version], version)
    assert fmu.serialised() == begun
    fmu.free()


def steps(fmu, first, count):
    """Outputs over some steps with inputs and torques that follow from their numbers."""
    rows, names = [], ["bearing_1.force_uy", "bearing_2.power", "casing.acceleration_uy", "alpha", TORQUE]
    for i in range(first, first + count):
        assert fmu.set({n: level * np.sin(1.3 * i) for n, level in LEVELS.items()}) == OK
        if i % 3 == 0:
            assert fmu.set({TORQUE: 55.0 + 60.0 * np.sin(float(i))}) == OK
        rows.append(fmu.get(names))
        assert fmu.step(i * 1e-5, 1e-5) == OK
    return np.array(rows)


@BOTH
@pytest.mark.parametrize("used", [True, False], ids=["used", "set"])
def test_state(fmus, version, used):
    """Continued in the same and in a fresh instance bit for bit, also where the torque was set but not used yet."""
    fmu = new(fmus[version], version)
    steps(fmu, 0, 7)
    assert fmu.set({TORQUE: 71.0}) == OK
    if used:
        fmu.get(["alpha"])
    kept = fmu.serialised()
    wanted, end = steps(fmu, 7, 10), fmu.serialised()
    other = new(fmus[version], version)
    for instance in (fmu, other):
        assert Keeper(instance).take(kept) == OK, instance.messages
        assert instance.get([TORQUE]).tolist() == [71.0]
        assert instance.serialised() == kept
        assert (steps(instance, 7, 10) == wanted).all()
        assert instance.serialised() == end
        instance.free()


def forged(content, at, value):
    """The state with another number and the right checksum."""
    numbers = np.frombuffer(content, "<f8", offset=72).copy()
    numbers[at] = value
    rest = content[32:72] + numbers.tobytes()
    return content[:24] + zlib.crc32(rest).to_bytes(4, "little") + content[28:32] + rest


def test_forged_states(fmus, scheduled):
    """Matrices that are not those of the torque, or of the torque in use, under the right checksum: refused."""
    fmu = new(fmus[2], 2)
    steps(fmu, 0, 4)
    before, keeper = fmu.serialised(), Keeper(fmu)
    blocks = sum(len(joint.dofs) ** 2 for joint in scheduled.joints)
    torque = 6 + 13
    K = torque + 3 + 8 + len(scheduled.joints)
    assert np.frombuffer(before, "<f8", 1, 72 + 8 * torque)[0] == fmu.get([TORQUE])[0]
    own = np.frombuffer(before, "<f8", 1, 72 + 8 * K)[0]
    assert own == read_matrix(fmu, 2, "bearing_1.stiffness")[0, 0]
    for at, factor in ((K, 1.01), (K + 2 * blocks, 1.01), (K + blocks + 4, 2.0), (torque, 1.1), (torque + 2, 1.1)):
        value = np.frombuffer(before, "<f8", 1, 72 + 8 * at)[0] * factor
        assert keeper.take(forged(before, at, value)) == ERROR, at
        assert "out of range" in fmu.messages[-1]
        assert fmu.serialised() == before
    fmu.free()


def test_other_starts(tmp_path):
    """The first point where the start is not given, or lies beyond the points."""
    for k, (start, wanted) in enumerate([(None, 10.0), (5.0, 10.0), (101.0, 10.0), (100.0, 100.0), (25.0, 25.0)]):
        network = machine(2, start=start)
        fmu = new(Fmu.unpack(export(network, tmp_path / f"{k}.fmu"), tmp_path / str(k)), 2)
        assert fmu.get([TORQUE]).tolist() == [wanted]
        K = by_name(interpolated(network, wanted), "bearing_1.stiffness")
        assert read_matrix(fmu, 2, "bearing_1.stiffness") == pytest.approx(K, rel=1e-14)
        fmu.free()
