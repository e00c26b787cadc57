"""Numbers as an engineer prints them."""

import pytest
from report_reader import plain

from gearpath.report import wording as w


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (0.03124, "0.0312"),
        (-1.5, "-1.50"),
        (1509.2, "1509"),
        (60000.0, "60 000"),
        (999.6, "1000"),
        (3.814e-7, "3.81 × 10⁻⁷"),
        (-2.5e8, "-2.50 × 10⁸"),
        (float("nan"), "not a number"),
        (float("-inf"), "-∞"),
    ],
)
def test_number(value, text):
    assert plain(w.number(value)) == text


@pytest.mark.parametrize("value", [0.04975, 1.2e8, 7850.0, 1e-6, 2.07e11, 0.1 + 0.2, 1 / 3])
def test_given_keeps_the_digits_of_the_model(value):
    text = plain(w.given(value)).replace(" × 10", "e").translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    text = text.replace(" ", "")
    text = "1e" + text[2:] if text.startswith("10-") else text
    assert float(text) == pytest.approx(value, rel=1e-11)


@pytest.mark.parametrize(
    ("share", "text"),
    [
        (0.5, "50.0 %"),
        (1.00136, "100.1 %"),
        (-0.00135, "-0.135 %"),
        (13.834, "1383 %"),
        (0.0, "0 %"),
        (float("nan"), "–"),
        (0.00999999, "1.00 %"),
    ],
)
def test_percent(share, text):
    assert plain(w.percent(share)) == text


def test_small_words():
    assert [plain(w.plural(n, noun)) for n, noun in [(1, "path"), (8, "path"), (2, "mesh"), (3, "FMU")]] == [
        "1 path",
        "8 paths",
        "2 meshes",
        "3 FMUs",
    ]
    assert [w.listed(list(words)) for words in ("a", "ab", "abc")] == ["a", "a and b", "a, b and c"]
    assert plain(w.decibel(-0.04)) == "0.0 dB"
    assert plain(w.decibel(float("-inf"))) == "– dB"
    assert plain(w.quantity(1e-6, "N.m")) == "10⁻⁶ N m"
