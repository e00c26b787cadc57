"""Every exception that Gearpath raises on purpose.

An error message is one sentence that says what is wrong, where, and what to do about it.
"""


class GearpathError(Exception):
    """Base of all of them: catch this one to catch them all."""


class InputError(GearpathError):
    """The caller's data cannot be used: a wrong name, shape, unit or number."""


class ModelError(InputError):
    """A model is wrong: names the file (where there is one), the key, the value and the remedy."""

    def __init__(self, key: str, problem: str, remedy: str, *, file: str | None = None) -> None:
        self.key, self.problem, self.remedy, self.file = key, problem, remedy, file
        where = f"{file}: {key}" if file else key
        super().__init__(f"{where}: {problem}; {remedy}")


class MissingExtraError(GearpathError):
    """An optional library is not installed."""

    def __init__(self, library: str, extra: str) -> None:
        super().__init__(f'this needs {library}, which is not installed; run: pip install "gearpath[{extra}]"')


class AccuracyError(GearpathError):
    """A numerical result did not reach its own residual check and is withheld."""
