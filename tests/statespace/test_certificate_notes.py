"""What a certificate says beside its figures: orders that are not those asked for, and digits that rounding took."""

import re
from pathlib import Path

import numpy as np
import pytest
from reduction_cases import random_network

import gearpath as gp
from gearpath.statespace.reduced import Comparison, reduced_network

pytest.importorskip("control")
MODELS = Path(__file__).resolve().parents[2] / "models"


@pytest.fixture(scope="module")
def model():
    return gp.load(MODELS / "gearbox.toml")


@pytest.mark.parametrize(
    ("request_", "order", "words"),
    [
        ({"order": 2}, 7, ["order 2 was asked for: equal coordinates, such as rigid", "have 12 modes up to the end"]),
        ({"order": 30, "band": (20.0, 25.0)}, 26, ["order 30 was asked for: .* no more differ in this band"]),
        ({"order": 1000}, 72, ["order 1000 was asked for: there are no more than 72 coordinates"]),
        ({"order": 30}, 30, []),
        ({"tolerance": 1e-3}, 25, []),
    ],
)
def test_an_order_that_is_not_the_one_asked_for(model, request_, order, words):
    certificate = gp.reduce(model, **request_).certificate
    assert certificate.order == order
    assert (certificate.note == "") == (not words)
    for word in words:
        assert re.search(word, certificate.note), certificate.note
        assert certificate.note in str(certificate)


def test_a_tolerance_that_only_the_complete_network_keeps():
    found = reduced_network(random_network(11), tolerance=1e-11, band=(60.0, 3000.0)).certificate
    assert found.order == found.complete
    assert found.note == "no smaller order keeps 1e-11"


def exact(network, f):
    """Responses at one frequency in long double, by Gaussian elimination on the modal coordinates."""
    w = 2 * np.longdouble(np.pi) * np.longdouble(f)
    D, S = (np.zeros((len(network.eigenvalues),) * 2, np.longdouble) for _ in "DS")
    D, S = D + np.diag(network.damping.astype(np.longdouble)), S + np.diag(network.eigenvalues.astype(np.longdouble))
    at = {}
    for joint in network.joints:
        P = (joint.source - joint.receiver).astype(np.longdouble)
        D, S = D + P.T @ joint.damping @ P, S + P.T @ joint.stiffness @ P
        at[joint.name] = joint.stiffness @ P + 1j * w * (joint.damping @ P)
    A = S + 1j * w * D - w**2 * np.eye(len(S), dtype=np.longdouble)
    q = eliminated(A, np.column_stack([load.column for load in network.loads]).astype(A.dtype))
    powers = {"velocity": 1j * w, "acceleration": -(w**2)}
    return np.array(
        [at[o.joint][o.dof] @ q if o.quantity == "force" else powers[o.quantity] * (o.row @ q) for o in network.outputs]
    )


def eliminated(A, B):
    A, B = A.copy(), B.copy()
    for k in range(len(A)):
        pivot = k + int(np.argmax(abs(A[k:, k])))
        A[[k, pivot]], B[[k, pivot]] = A[[pivot, k]], B[[pivot, k]]
        factors = A[k + 1 :, k] / A[k, k]
        A[k + 1 :] -= factors[:, None] * A[k]
        B[k + 1 :] -= factors[:, None] * B[k]
    X = np.zeros_like(B)
    for k in reversed(range(len(A))):
        X[k] = (B[k] - A[k, k + 1 :] @ X[k + 1 :]) / A[k, k]
    return X


@pytest.mark.skipif(np.finfo(np.longdouble).eps > 1e-18, reason="long double is double here")
@pytest.mark.parametrize("seed", [0, 3, 4, 6, 14])
def test_the_certificate_covers_rounding_in_a_very_low_band(seed):
    """Free or nearly free machines, 1e-4 to 1e-2 Hz: the responses themselves have an error of 3 % to 100 % there."""
    network, band = random_network(seed), (1e-4, 1e-2)
    found = reduced_network(network, order=15, band=band, method="modal")
    lines = [1e-4, 1.07e-4, 1e-3, 1e-2]
    H = np.array([exact(network, f) for f in lines])
    G = np.array([exact(found.network, f) for f in lines])
    true = (abs(G - H).max(axis=0) / abs(H).max(axis=0)).max()
    assert true <= found.certificate.error
    assert "of the error is rounding at 0.0001 Hz: begin the band higher" in found.certificate.note
    with pytest.raises(gp.InputError, match=r"1e-06 cannot be certified from 0\.0001 Hz on, where rounding alone is"):
        reduced_network(network, tolerance=1e-6, band=band)


@pytest.mark.parametrize("method", ["rational_krylov", "balanced"])
def test_a_tolerance_below_the_rounding_is_refused_for_a_model(model, method):
    with pytest.raises(gp.InputError, match=r"cannot be certified from 0\.001 Hz on"):
        gp.reduce(model, tolerance=1e-3, band=(1e-3, 1.0), method=method)


@pytest.mark.skipif(np.finfo(np.longdouble).eps > 1e-18, reason="long double is double here")
@pytest.mark.parametrize("low", [1e-4, 1.0, 60.0])
@pytest.mark.parametrize("seed", [2, 5, 14])
def test_rounding_is_measured(seed, low):
    """Against long double, on the first line of the band: neither below the error nor far above it."""
    comparison = Comparison(random_network(seed), (low, 50.0 * low))
    H = comparison.exact(2 * np.pi * np.geomspace(low, 50.0 * low, 400))
    error = abs(H[0] - exact(comparison.network, low)) / abs(H).max(axis=0)
    assert error.max() <= comparison.rounding <= 1e3 * max(float(error.max()), 1e-16)
    assert low < 60.0 or comparison.rounding < 1e-11
