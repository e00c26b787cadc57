"""Where the quasi-static theory stops."""

from math import acos, degrees, pi

from ...numerics.arrays import Real

DENSITY = 7800.0  # kg/m^3, bearing steel
SHOULDER = 0.2  # height of a groove's shoulder over the ball's diameter, usual in catalogues
CENTRIFUGAL = 0.02  # of the largest element load; at 0.10 the stiffness is a fifth off


def centrifugal_note(mass: float, radius: float, gamma: float, speed: float, load: float, bound: str = "") -> list[str]:
    """A sentence where the centrifugal force m w_c^2 r exceeds 0.02 of the largest element load.

    mass (kg) of an element, pitch radius (m), gamma = D cos(a) / d_m, inner ring speed (rev/min), load (N); the cage
    turns at w_c = w (1 - gamma) / 2 where the outer ring stands still. `bound` qualifies the figure.
    """
    cage = 0.5 * (1.0 - gamma) * speed * pi / 30.0
    ratio = mass * cage**2 * radius / load
    if ratio <= CENTRIFUGAL:
        return []
    return [
        f"at {speed:g} rev/min the centrifugal force on an element is {bound}{ratio:.2g} of the largest contact load; "
        f"above {CENTRIFUGAL:g} it changes the stiffness, and this theory leaves it out"
    ]


def ellipse_note(half: float, angle: float, conformity: float, diameter: float, ring: str) -> list[str]:
    """A sentence where the contact ellipse, of semi-axis `half` (m) at `angle` (rad), reaches beyond the shoulder.

    Seen from the centre of the groove, of radius f D, the ellipse ends at |a| + half / (f D) and a shoulder of the
    height h at acos(1 - h / (f D)).
    """
    end = abs(angle) + half / (conformity * diameter)
    shoulder = acos(1.0 - SHOULDER / conformity)
    if end <= shoulder:
        return []
    return [
        f"the contact ellipse of the heaviest ball reaches {degrees(end):.0f} degrees from the middle of the {ring} "
        f"groove; with shoulders of {SHOULDER:g} of the ball's diameter it is cut off at {degrees(shoulder):.0f} "
        "degrees, and the bearing is softer than computed"
    ]


def wrong_side_note(loads: Real, angles: Real) -> list[str]:
    """A sentence where loaded balls have a negative angle, counted from the side of the free contact angle."""
    if not (angles < 0)[loads > 0].any():
        return []
    return [
        "balls bear on the other side of the groove, where an angular contact bearing has no shoulder: the load opens "
        "the bearing; turn it round or preload it"
    ]
