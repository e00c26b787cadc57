"""What to suggest where a name is not known."""

from collections.abc import Iterable
from difflib import get_close_matches

_LISTED = 20


def hint(name: object, known: Iterable[str]) -> str:
    """The close match to `name`, otherwise the known names: "did you mean 'stiffness'?" or "known: a, b"."""
    names = list(known)
    lower = {item.lower(): item for item in reversed(names)}
    close = get_close_matches(str(name).lower(), lower, n=1, cutoff=0.65)
    if close:
        return f"did you mean '{lower[close[0]]}'?"
    if not names:
        return "there is none to choose from"
    more = f", and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
    return f"known: {', '.join(names[:_LISTED])}{more}"
