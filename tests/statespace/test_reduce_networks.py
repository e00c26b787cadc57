"""Reduction of networks: the beam of the benchmarks, certificates against finer grids, passivity, joints exchanged."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from reduction_cases import beam, coupled, poles_of, random_network, responses, true_error

from gearpath.statespace.reduced import Comparison, reduced_network
from gearpath.statespace.reduced.passivity import is_passive_network
from gearpath.statespace.reduction import reduce

BAND = (50.0, 8000.0)


@pytest.mark.parametrize(("method", "low", "high"), [("rational_krylov", 0.0, 1e-6), ("modal", 1e-5, 1e-2)])
def test_beam_of_102_coordinates_at_order_16(method, low, high):
    found = reduced_network(beam(), order=16, band=BAND, method=method)
    true = true_error(beam(), found.network, BAND)
    assert low <= true <= found.certificate.error <= high
    assert found.certificate.order == 16 == len(found.network.eigenvalues)
    assert found.certificate.passive
    assert found.certificate.stable


def test_krylov_beats_craig_bampton_on_the_beam():
    errors = {
        method: reduced_network(beam(), order=16, band=BAND, method=method).certificate.error
        for method in ("rational_krylov", "craig_bampton", "modal")
    }
    assert errors["rational_krylov"] < 1e-3 * errors["craig_bampton"]
    assert errors["rational_krylov"] < 1e-3 * errors["modal"]


@pytest.mark.parametrize("length", [0.3, 0.8, 1.2])
def test_error_falls_with_the_order(length):
    network = beam(length)
    least = int((network.eigenvalues <= (2 * np.pi * BAND[1]) ** 2).sum())
    errors = [reduced_network(network, order=least + k, band=BAND).certificate.error for k in (0, 4, 8, 12)]
    assert all(later < 0.5 * earlier for earlier, later in pairwise(errors))
    assert errors[-1] < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("part", range(4))
def test_certificate_is_never_below_the_true_error(part):
    """200 random networks, the true error on a grid ten times finer, from the state equations."""
    rng = np.random.default_rng(part)
    closest = np.inf
    for seed in range(50 * part, 50 * part + 50):
        network = random_network(seed)
        tolerance = 10.0 ** rng.uniform(-5, -1)
        found = reduced_network(network, tolerance=tolerance, band=(60.0, 3000.0))
        true = true_error(network, found.network, (60.0, 3000.0))
        certified = found.certificate.error
        assert true <= certified + 1e-9, seed
        assert certified <= tolerance or found.certificate.order == found.certificate.complete
        assert found.certificate.stable
        assert found.certificate.passive
        closest = min(closest, certified / max(true, 1e-9))
    assert closest < 1.03  # it is no lavish bound either


@pytest.mark.parametrize("seed", range(8))
def test_reduced_networks_are_positive_real(seed):
    """By sampling, not as the certificate does: the Hermitian part of force to velocity is never negative."""
    network = random_network(seed)
    for order in (3, 8, 15):
        small = reduced_network(network, order=order, band=(60.0, 3000.0)).network
        ports = [k for k, output in enumerate(small.outputs) if output.name.startswith("velocity")]
        H = responses(small, 2 * np.pi * np.geomspace(1.0, 1e5, 3000))[:, ports]
        assert np.linalg.eigvalsh(H + H.conj().swapaxes(1, 2)).min() >= -1e-9 * abs(H).max()
        D, S, _ = coupled(small)
        assert np.linalg.eigvalsh(D).min() >= -1e-9 * abs(D).max()
        assert np.linalg.eigvalsh(S).min() >= -1e-9 * abs(S).max()
        assert poles_of(small)[0].real.max() < 1e-6


def test_a_network_that_is_not_passive_is_told_so():
    network = random_network(3)
    joint = network.joints[0]
    for bad in (
        replace(joint, damping=joint.damping - 1e4 * np.eye(len(joint.dofs))),
        replace(joint, stiffness=-joint.stiffness),
    ):
        active = replace(network, joints=(bad, *network.joints[1:]))
        assert not is_passive_network(active)
        found = reduced_network(active, order=12, band=(60.0, 3000.0)).certificate
        assert not found.passive
        assert found.stable == bool(
            poles_of(reduced_network(active, order=12, band=(60.0, 3000.0)).network)[0].real.max() <= 0
        )
    assert is_passive_network(network)


@pytest.mark.parametrize("seed", [1, 4, 9])
def test_joints_may_be_exchanged_after_the_reduction(seed):
    """The bases know nothing of the joints: a tenth or ten times the stiffness is served as well."""
    network, band = random_network(seed), (60.0, 3000.0)
    small = reduced_network(network, tolerance=1e-4, band=band).network
    for factor in (0.1, 10.0):
        joint = network.joints[0]
        K = factor * joint.stiffness
        changed = replace(network, joints=(replace(joint, stiffness=K), *network.joints[1:]))
        same = replace(small.joints[0], stiffness=K)
        exchanged = replace(small, joints=(same, *small.joints[1:]))
        assert true_error(changed, exchanged, band, density=1) < 3e-3


def test_symmetric_directions_are_not_parted():
    """Two equal components: vectors come in equal pairs, of which never one alone is kept."""
    one = random_network(5)
    N = len(one.eigenvalues)
    wide = [
        replace(j, source=np.hstack([j.source, 0 * j.source]), receiver=np.hstack([j.receiver, 0 * j.receiver]))
        for j in one.joints
    ]
    twin = [
        replace(
            j,
            name=f"{j.name}_b",
            source=np.hstack([0 * j.source, j.source]),
            receiver=np.hstack([0 * j.receiver, j.receiver]),
        )
        for j in one.joints
    ]
    pair = replace(
        one,
        components={**one.components, **{f"{n}_b": slice(s.start + N, s.stop + N) for n, s in one.components.items()}},
        modal_damping={**one.modal_damping, **{f"{n}_b": z for n, z in one.modal_damping.items()}},
        eigenvalues=np.tile(one.eigenvalues, 2),
        joints=(*wide, *twin),
        loads=tuple(replace(x, column=np.tile(x.column, 2)) for x in one.loads),
        outputs=tuple(replace(o, row=None if o.row is None else np.tile(o.row, 2)) for o in one.outputs),
    )
    for order in range(20, 26):
        kept = reduced_network(pair, order=order, band=(60.0, 3000.0)).network.components
        for name in one.components:
            first, second = kept[name], kept[f"{name}_b"]
            assert first.stop - first.start == second.stop - second.start


def test_the_comparison_sees_a_narrow_resonance():
    """All modes moved by a tenth of their width, which is a millionth of their frequency."""
    network = beam(zeta=1e-6)
    shifted = replace(network, eigenvalues=network.eigenvalues * (1.0 + 1e-7))
    comparison = Comparison(network, BAND)
    found = comparison.deviation(lambda w: responses(shifted, w), poles_of(shifted)[0])
    true = true_error(network, shifted, BAND, density=40)
    assert true <= found.error <= 1.05 * true


def test_a_tolerance_beyond_the_shifts_gives_the_complete_network():
    network = random_network(11)
    found = reduced_network(network, tolerance=1e-11, band=(60.0, 3000.0))
    assert found.certificate.order == found.certificate.complete == len(network.eigenvalues)
    assert found.certificate.error < 1e-9
    np.testing.assert_array_equal(found.network.damping, network.damping)


@pytest.mark.parametrize("order", [8, 16])
def test_balanced_truncation_of_the_beam_is_not_passive_and_says_so(order):
    """Four ports; the negative power is found by sampling too, in 1e-4 of the largest gain."""
    free = beam()
    rows = np.vstack([free.loads[0].column, free.loads[3].column])
    mounts = replace(
        free.joints[0],
        source=rows,
        receiver=0 * rows,
        dofs=("ux", "uy"),
        stiffness=1e6 * np.eye(2),
        damping=50 * np.eye(2),
    )
    network = replace(free, joints=(mounts,))
    found = reduce(network, order, None, BAND, "balanced")
    w = 2 * np.pi * np.geomspace(1.0, 1e6, 4000)
    H = np.moveaxis(found(1j * w), -1, 0)
    assert np.linalg.eigvalsh(H + H.conj().swapaxes(1, 2)).min() < -1e-5 * abs(H).max()
    assert not found.certificate.passive
    assert found.certificate.stable
    exact = responses(network, w[(w > 2 * np.pi * BAND[0]) & (w < 2 * np.pi * BAND[1])])
    there = H[(w > 2 * np.pi * BAND[0]) & (w < 2 * np.pi * BAND[1])]
    assert (abs(there - exact).max(axis=0) <= found.certificate.error * abs(exact).max(axis=0)).all()
    krylov = reduce(network, order, None, BAND, "rational_krylov")
    assert krylov.certificate.passive
