"""Whether a README still says what a fresh run prints."""

import re

import pytest

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")


def check_numbers(readme, fresh):
    """Every block of the run is in the README with the same words, its numbers to 2 % or a unit of their last place.

    Other machines round the last digits differently.
    """
    blocks = {words(block): block for block in readme.split("\n\n")}
    for part in fresh.split("\n\n"):
        assert words(part) in blocks, part
        for now, old in zip(NUMBER.findall(part), NUMBER.findall(blocks[words(part)]), strict=True):
            assert float(now) == pytest.approx(float(old), rel=0.02, abs=1.01 * last_place(old)), (now, old, part)


def words(text):
    return " ".join(NUMBER.sub("#", text).split())


def last_place(text):
    mantissa, _, exponent = text.partition("e")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
