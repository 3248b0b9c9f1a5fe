"""Compiled plane geometry: distances and crossings of straight segments.

All kernels take plain floats in metres and return floats (square metres) or
booleans, so that other kernels can call them inside their innermost loops.
"""

from mesa_mobility.compiled.decorators import kept


@kept()
def point_segment_distance2(
    px: float, py: float, ax: float, ay: float, bx: float, by: float
) -> float:
    """Squared distance (m²) from point p to the closed segment ab; ab may be a point."""
    dx = bx - ax
    dy = by - ay
    length2 = dx * dx + dy * dy
    t = 0.0
    if length2 > 0.0:
        t = ((px - ax) * dx + (py - ay) * dy) / length2
        t = min(1.0, max(0.0, t))
    ex = px - (ax + t * dx)
    ey = py - (ay + t * dy)
    return ex * ex + ey * ey


@kept()
def segments_cross(
    ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> bool:
    """True where the open segments ab and cd cross at one inner point.

    Segments that only touch (a shared end, an end on the other segment, an
    overlap along one line) do not cross.
    """
    abx = bx - ax
    aby = by - ay
    c_side = abx * (cy - ay) - aby * (cx - ax)
    d_side = abx * (dy - ay) - aby * (dx - ax)
    if not ((c_side > 0.0 and d_side < 0.0) or (c_side < 0.0 and d_side > 0.0)):
        return False
    cdx = dx - cx
    cdy = dy - cy
    a_side = cdx * (ay - cy) - cdy * (ax - cx)
    b_side = cdx * (by - cy) - cdy * (bx - cx)
    return (a_side > 0.0 and b_side < 0.0) or (a_side < 0.0 and b_side > 0.0)


@kept()
def segment_segment_distance2(
    ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> float:
    """Squared distance (m²) between the closed segments ab and cd; 0 where they meet."""
    if segments_cross(ax, ay, bx, by, cx, cy, dx, dy):
        return 0.0
    # Segments that do not cross are nearest at an end of one of them.
    best = point_segment_distance2(ax, ay, cx, cy, dx, dy)
    best = min(best, point_segment_distance2(bx, by, cx, cy, dx, dy))
    best = min(best, point_segment_distance2(cx, cy, ax, ay, bx, by))
    return min(best, point_segment_distance2(dx, dy, ax, ay, bx, by))


@kept()
def segment_box_distance2(
    ax: float, ay: float, bx: float, by: float, xmin: float, ymin: float, xmax: float, ymax: float
) -> float:
    """Squared distance (m²) from the closed segment ab to the closed axis-parallel box."""
    if xmin <= ax <= xmax and ymin <= ay <= ymax:
        return 0.0
    best = segment_segment_distance2(ax, ay, bx, by, xmin, ymin, xmax, ymin)
    best = min(best, segment_segment_distance2(ax, ay, bx, by, xmax, ymin, xmax, ymax))
    best = min(best, segment_segment_distance2(ax, ay, bx, by, xmax, ymax, xmin, ymax))
    return min(best, segment_segment_distance2(ax, ay, bx, by, xmin, ymax, xmin, ymin))
