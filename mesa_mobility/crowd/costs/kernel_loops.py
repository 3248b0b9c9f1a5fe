"""Source of the loops that kernels are compiled with."""

OPTION_LOOP = """
def {name}(
    n, x, y, facing_x, facing_y, duration, speed, sx, sy, tx, ty, preferred, own_vx, own_vy, mine,
    at, p, weight, out
):
    for k in range(n):
        out[k] += weight * each(
            x[k], y[k], facing_x[k], facing_y[k], duration[k], speed[k], sx, sy, tx, ty, preferred,
            {own}{taken}p
        )
"""

BOUND_LOOP = """
def {name}(
    n, x, y, radius, facing_x, facing_y, turn, duration, slowest, fastest, sx, sy, tx, ty,
    preferred, own_vx, own_vy, p, weight, out
):
    for k in range(n):
        out[k] += weight * each(
            x[k], y[k], radius[k], facing_x[k], facing_y[k], turn[k], duration[k], slowest[k],
            fastest[k], sx, sy, tx, ty, preferred, {own}p
        )
"""

PAIR_LOOP = """
def {name}(
    n, x, y, facing_x, facing_y, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex, ney, lead,
    mine, theirs, width, at, p, out
):
    for k in range(n):
        out[k] = each(
            x, y, facing_x, facing_y, duration, speed, sx, sy, tx, ty, nx[k], ny[k], nvx[k], nvy[k],
            nex[k], ney[k], lead[k], {taken}p
        )
"""

PAIRS_LOOP = """
def {name}(
    m, n, x, y, facing_x, facing_y, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex, ney,
    lead, mine, theirs, width, at, p, weight, out
):
    for a in range(m):
        ax, ay, avx, avy, aex, aey, alead = nx[a], ny[a], nvx[a], nvy[a], nex[a], ney[a], lead[a]
        for k in range(n):
            out[k] += weight * each(
                x[k], y[k], facing_x[k], facing_y[k], duration[k], speed[k], sx, sy, tx, ty, ax, ay,
                avx, avy, aex, aey, alead, {taken}p
            )
"""

PAIR_BOUND_LOOP = """
def {name}(
    m, n, x, y, radius, facing_x, facing_y, turn, duration, slowest, fastest, sx, sy, tx, ty, nx,
    ny, nvx, nvy, nex, ney, lead, p, weight, out
):
    for a in range(m):
        ax, ay, avx, avy, aex, aey, alead = nx[a], ny[a], nvx[a], nvy[a], nex[a], ney[a], lead[a]
        for k in range(n):
            out[k] += weight * each(
                x[k], y[k], radius[k], facing_x[k], facing_y[k], turn[k], duration[k], slowest[k],
                fastest[k], sx, sy, tx, ty, ax, ay, avx, avy, aex, aey, alead, p
            )
"""

WALL_LOOP = """
def {name}(
    n, x, y, facing_x, facing_y, duration, speed, sx, sy, tx, ty, core, walls, p
):
    worst = 0.0
    for k in range(n):
        cost = each(
            x, y, facing_x, facing_y, duration, speed, sx, sy, tx, ty, walls[5 * k],
            walls[5 * k + 1], walls[5 * k + 2], walls[5 * k + 3], core, p
        )
        # A cost that is not a number stays the worst.
        worst = cost if worst == worst and not cost <= worst else worst
    return worst
"""
