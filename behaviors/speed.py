"""The speed of an option: as fast as possible, or near the preferred speed."""

from mesa_mobility import CompiledTerm, bound_kernel, option_kernel


@option_kernel
def _displacement(x, y, ux, uy, duration, speed, sx, sy, tx, ty, preferred, p):  # type: ignore[no-untyped-def]
    return -speed * duration


@option_kernel
def _preferred_speed(x, y, ux, uy, duration, speed, sx, sy, tx, ty, preferred, p):  # type: ignore[no-untyped-def]
    return 1.5 * abs(speed - preferred)


@bound_kernel
def _displacement_bound(  # type: ignore[no-untyped-def]
    x, y, radius, ux, uy, turn, duration, slowest, fastest, sx, sy, tx, ty, preferred, p
):
    return -fastest * duration


@bound_kernel
def _preferred_speed_bound(  # type: ignore[no-untyped-def]
    x, y, radius, ux, uy, turn, duration, slowest, fastest, sx, sy, tx, ty, preferred, p
):
    return 1.5 * max(slowest - preferred, preferred - fastest, 0.0)


class Displacement(CompiledTerm):
    """Prefers options that go far, and so rewards speed without limit.

    -S of equation (1): minus the displacement in metres.
    On its own it makes everybody walk as fast as the recorded person ever did.
    """

    name = "displacement"
    kernel = _displacement
    bound = _displacement_bound


class PreferredSpeed(CompiledTerm):
    """Prefers options near the pedestrian's preferred speed.

    ``|S - v0 t| x 1.5 / t``: S is the displacement, v0 the preferred speed, t the
    option's duration.  In metres over the paper's 1.5 s whatever the duration, so that options of
    different durations compare.  Takes the place of ``Displacement``.
    """

    name = "preferred_speed"
    default_weight = 2.0
    kernel = _preferred_speed
    bound = _preferred_speed_bound
