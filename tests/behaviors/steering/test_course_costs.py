"""Anticipation gives to the last bit what its definition gives, written out person by person."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from mesa_mobility.behaviors.steering.anticipation import turn_aside
from shapely import box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.state.view import CrowdView

SIDE = 16.0
PLANS = [
    FloorPlan(box(0.0, 0.0, SIDE, SIDE), exits=[Exit("e", (SIDE, 0.0), (SIDE, SIDE))]),
    FloorPlan(
        box(0.0, 0.0, SIDE, SIDE),
        exits=[Exit("e", (SIDE, 0.0), (SIDE, SIDE))],
        obstacles=[box(4.0, 2.0, 4.2, 9.0), box(7.0, 8.0, 12.0, 8.2), box(10.0, 11.0, 11.0, 14.0)],
    ),
]
FRAME = 30


def crowd_of(seed, people):
    """People at random; some stand, wait, queue, or go the same way."""
    rng = np.random.default_rng(seed)
    crowd = Crowd(people)
    crowd.x[:], crowd.y[:] = rng.uniform(0.5, SIDE - 0.5, (2, people))
    turn, speed = rng.uniform(-math.pi, math.pi, people), rng.choice([0.0, 0.4, 1.2, 1.6], people)
    crowd.vx[:], crowd.vy[:] = speed * np.cos(turn), speed * np.sin(turn)
    off = rng.normal(0.0, 0.5, people)
    crowd.target_x[:] = crowd.x + 10.0 * np.cos(turn + off)
    crowd.target_y[:] = crowd.y + 10.0 * np.sin(turn + off)
    arrived = rng.random(people) < 0.1
    crowd.target_x[arrived], crowd.target_y[arrived] = crowd.x[arrived], crowd.y[arrived]
    crowd.core[:] = rng.choice([0.14, 0.17, 0.35], people)
    crowd.agenda["waits_until"] = np.where(rng.random(people) < 0.2, FRAME + 10, 0)
    return crowd, rng.uniform(0.7, 1.8, people)


def by_definition(crowd, order, plan, i, speed):
    """(point, speed) of pedestrian i; ``order`` is that in which costs are summed."""
    px, py = float(crowd.x[i]), float(crowd.y[i])
    now = math.sqrt(float(crowd.vx[i]) ** 2 + float(crowd.vy[i]) ** 2)
    dx, dy = float(crowd.target_x[i]) - px, float(crowd.target_y[i]) - py
    away = math.sqrt(dx * dx + dy * dy)
    if now < 0.3 or away == 0.0:
        return (px + dx, py + dy), speed
    ex, ey = dx / away, dy / away
    own = min(speed, now + 0.4)
    full = 1.0 / ((0.9 + 0.5) * (0.9 + 0.5) - 0.9 * 0.9)
    others = []
    for j in order:
        x, y = float(crowd.x[j]) - px, float(crowd.y[j]) - py
        vx, vy = float(crowd.vx[j]), float(crowd.vy[j])
        wx, wy = vx - own * ex, vy - own * ey
        excess = wx * wx + wy * wy - 0.9 * 0.9
        if x * ex + y * ey <= 0.0 or x * x + y * y > 81.0 or excess <= 0.0:
            continue
        jx, jy = float(crowd.target_x[j] - crowd.x[j]), float(crowd.target_y[j] - crowd.y[j])
        stays = (jx == 0.0 and jy == 0.0) or crowd.agenda["waits_until"][j] > FRAME
        if not stays and vx * vx + vy * vy < 0.25:
            continue
        if not stays and jx * ex + jy * ey > 0.5 * math.sqrt(jx * jx + jy * jy):
            continue
        weight = 3.0 * min(excess * full, 1.0) * 4.0 / (4.0 + math.sqrt(x * x + y * y))
        room = 0.65 + (float(crowd.core[j]) + float(crowd.core[i]) - 0.28)
        room2 = min(room * room, 0.6 * 0.6 * (x * x + y * y))
        others.append((x, y, vx, vy, weight, room2))
    horizon = min(4.0, away / own)

    def people(ux, uy, others):
        total = 0.0
        for x, y, vx, vy, weight, room2 in others:
            wx, wy = vx - ux, vy - uy
            towards = -(x * wx + y * wy)
            if towards > 0.0:
                time = min(towards / (wx * wx + wy * wy), horizon)
                ax, ay = x + wx * time, y + wy * time
                near = 1.0 - (ax * ax + ay * ay) / room2
                total += near * weight if near > 0.0 else 0.0
        return total

    if people(own * ex, own * ey, others) == 0.0:
        return (px + dx, py + dy), speed
    walls = shapely.union_all(shapely.linestrings(plan.walls.reshape(-1, 2, 2)))
    seen = [
        other
        for other in others
        if not walls.intersects(shapely.LineString([(px, py), (px + other[0], py + other[1])]))
    ]
    courses = []
    for share in (1.0, 0.7):
        for step in range(13):
            turn = 0.8 / 36 * ((step + 1) // 2) * ((step + 1) // 2)
            angle = -turn if step % 2 else turn
            c, s = math.cos(angle), math.sin(angle)
            ux, uy = share * own * (c * ex - s * ey), share * own * (s * ex + c * ey)
            courses.append((angle, share, ux, uy))

    def comes_near(x, y, vx, vy, _, room2):
        """Whether somebody who comes the other way would ever be too near on any course."""
        if vx * ex + vy * ey >= 0.0:
            return False
        for *_, ux, uy in courses:
            wx, wy = vx - ux, vy - uy
            towards = -(x * wx + y * wy)
            if towards > 0.0 and x * x + y * y - towards * towards / (wx * wx + wy * wy) < room2:
                return True
        return False

    left = 0.5 if any(comes_near(*other) for other in seen) else 0.1
    best = (math.inf, 0.0, 1.0)
    for angle, share, ux, uy in courses:
        wx, wy = ux - own * ex, uy - own * ey
        cost = math.sqrt(wx * wx + wy * wy) + (left if angle > 0.0 else 0.0)
        best = min(best, (cost + people(ux, uy, seen), angle, share), key=lambda each: each[0])
    _, angle, share = best
    c, s = math.cos(angle), math.sin(angle)
    return (px + away * (c * ex - s * ey), py + away * (s * ex + c * ey)), speed * share


@pytest.mark.parametrize("plan", PLANS, ids=["hall", "walls"])
@given(seed=st.integers(0, 10_000), people=st.integers(1, 120))
@settings(deadline=None, max_examples=15)
def test_courses_are_those_of_the_definition_to_the_last_bit(plan, seed, people):
    crowd, speeds = crowd_of(seed, people)
    rows = np.arange(people)
    grid = CrowdView(rows, crowd).grid
    wanted = np.column_stack([crowd.target_x, crowd.target_y])
    points, found = turn_aside(rows, grid, FRAME, crowd, plan, wanted, speeds)
    for i in rows.tolist():
        point, speed = by_definition(crowd, grid.people.tolist(), plan, i, float(speeds[i]))
        assert found[i] == speed
        changed = points[i].tolist() != wanted[i].tolist()
        assert points[i].tolist() == (list(point) if changed else wanted[i].tolist())
        assert changed or point == pytest.approx(wanted[i])


def test_many_people_do_turn_aside_in_these_crowds():
    crowd, speeds = crowd_of(1, 120)
    rows, wanted = np.arange(120), np.column_stack([crowd.target_x, crowd.target_y])
    grid = CrowdView(rows, crowd).grid
    counts = []
    for plan in PLANS:
        points, found = turn_aside(rows, grid, FRAME, crowd, plan, wanted, speeds)
        counts.append(int(((points != wanted).any(axis=1) | (found != speeds)).sum()))
    assert counts[0] > counts[1] > 5
