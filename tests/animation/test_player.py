"""Plan, maps, curves and camera paths of the page that plays a run."""

import json

import numpy as np
import pytest
import shapely

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.results import Trajectories
from mesa_mobility.results.engineering.doors import n_t
from mesa_mobility.results.engineering.grids import Grid
from mesa_mobility.results.engineering.maps import maps

HALL = FloorPlan(
    # A hall whose right end is a room behind a wall with a door, and an exit on either side.
    "POLYGON ((0 0, 9.2 0, 9.2 2, 9.4 2, 9.4 0, 14 0, 14 6, 9.4 6, 9.4 3.5, 9.2 3.5, 9.2 6, 0 6, "
    "0 0))",
    exits=[Exit("left", (0, 2), (0, 4)), Exit("right", (14, 2), (14, 3.5))],
)


@pytest.fixture(scope="module")
def crowd() -> Trajectories:
    model = PedestrianModel(HALL, record="decisions", rng=4)
    model.add_pedestrians(HALL.random_points(40, model.rng, spacing=0.6, clearance=0.3))
    model.run(max_seconds=12)
    return Trajectories.of(model)


@pytest.fixture
def page(open_page, crowd):
    return open_page(crowd, HALL, title="hall")


def cells(page, kind, seconds):
    """(rows, columns) of a map at a time."""
    shape = page.evaluate(
        """([kind, seconds]) => {
          element("layer").value = kind;
          show(seconds * RATE);
          const storey = storeyShown(), grid = gridOf(storey);
          const values = kind === "usage" ? usageOf(storey, grid).until(state.frame)
            : grid.densities(placesOn(storey));
          const known = Array.from(values, (each) => Number.isFinite(each) ? each : null);
          return [grid.rows, grid.columns, known];
        }""",
        [kind, seconds],
    )
    rows, columns, values = shape
    return np.array([np.nan if each is None else each for each in values]).reshape(rows, columns)


@pytest.mark.slow
def test_densities_are_those_of_the_results(page, crowd):
    for seconds in (0.0, 4.0, 8.0):
        own = maps(crowd, HALL, start=seconds, end=seconds)[0]
        shown, known = cells(page, "density", seconds), own.density_max
        np.testing.assert_array_equal(np.isnan(shown), np.isnan(known))
        on = ~np.isnan(known)
        area = own.grid.share[on] * 0.25
        # Everybody is somewhere: what differs is on which side of a border a place of 0.1 m lies.
        assert (shown[on] * area).sum() == pytest.approx((known[on] * area).sum(), rel=0.02)
        assert np.corrcoef(shown[on], known[on])[0, 1] > 0.98
        assert np.abs(shown - known)[on].mean() < 0.05 * known[on].mean()


@pytest.mark.slow
def test_walls_keep_densities_apart(page):
    """Two people beside a wall: each has their own side, worked out by hand."""
    shown = page.evaluate(
        """() => {
          const room = (a, b) => [[[a, 0], [b, 0], [b, 4], [a, 4], [a, 0]]];
          const grid = new FloorGrid([room(0, 4), room(4.5, 8.5)]);
          return [grid.columns, Array.from(grid.densities([2, 2, 5, 2]))];
        }"""
    )
    columns, values = shown
    table = np.array([np.nan if each is None else each for each in values], dtype=float)
    table = table.reshape(-1, columns)
    # On the left 3.5 m by 4 m; the rest is nearer to the other, who is behind a wall: nobody's.
    np.testing.assert_allclose(table[:, :7], 1 / 14, rtol=0.03)
    np.testing.assert_array_equal(table[:, 7], 0.0)
    np.testing.assert_allclose(table[:, 9:], 1 / 16, rtol=0.03)
    # The gap between both is no floor.
    assert np.isnan(table[:, 8]).all()
    grid = Grid(shapely.MultiPolygon([shapely.box(0, 0, 4, 4), shapely.box(4.5, 0, 8.5, 4)]), 0.5)
    known = grid.densities(np.array([[2.0, 2.0], [5.0, 2.0]]), np.ones((1, 2)))[0]
    np.testing.assert_allclose(table, known, rtol=0.03)


@pytest.mark.slow
def test_usage_is_that_of_the_results_so_far(page, crowd):
    whole = cells(page, "usage", crowd.duration)
    known = maps(crowd, HALL)[0].people
    # Places between two that are stored, 0.1 s apart, are on a straight line.
    assert whole.sum() == pytest.approx(known.sum(), rel=0.03)
    assert np.abs(whole - known).max() <= 3
    some = cells(page, "usage", 3.0)
    assert (some <= whole).all()
    assert some.sum() < whole.sum()
    again = cells(page, "usage", crowd.duration)
    np.testing.assert_array_equal(again, whole)


@pytest.mark.slow
def test_levels_of_service_have_the_limits_of_the_results(page):
    limits, found = page.evaluate(
        """() => {
          const { service } = state.run.header, { paint } = LAYERS.service;
          return [service, [0.2, 0.4, 0.5, 0.8, 1.5, 3].map((value) => paint(value, service)[1])];
        }"""
    )
    # Fruin: 35, 25, 15, 10 and 5 square feet a person.
    np.testing.assert_allclose(limits, 1 / (np.array([35, 25, 15, 10, 5]) * 0.09290304), rtol=1e-6)
    assert found == sorted(found)
    assert len(set(found)) == 6


@pytest.mark.slow
def test_curves_count_the_passages(page, crowd):
    table = n_t(crowd, HALL)
    for seconds in (0.0, 3.5, 7.0, crowd.duration):
        page.evaluate(f"show({seconds} * RATE)")
        told = {
            each["name"]: each["passed"] for each in page.evaluate(f"state.curves.told({seconds})")
        }
        for name, passed in told.items():
            own = table[table.door == name]
            assert passed == (own.time_s <= seconds + 0.005).sum()
    assert sum(told.values()) == len(crowd.exit_frames[crowd.exit_frames >= 0])
    # The time of a place on the curves is that of the slider below it.
    box = page.evaluate(
        "(({left, width}) => [left, width])(element('curves').getBoundingClientRect())"
    )
    slider = page.evaluate(
        "(({left, width}) => [left, width])(element('time').getBoundingClientRect())"
    )
    assert box == slider
    page.mouse.click(
        box[0] + box[1] / 2, page.evaluate("element('curves').getBoundingClientRect().top + 20")
    )
    assert page.evaluate("state.frame / RATE") == pytest.approx(crowd.duration / 2, abs=0.05)


@pytest.mark.slow
def test_the_plan_shows_people_where_they_are_and_a_click_selects(page, crowd):
    page.select_option("#camera", "plan")
    page.evaluate("show(60)")
    rows = np.flatnonzero(crowd.frame == 60)
    drawn = page.evaluate(
        "peopleOn(storeyShown()).map(({row, track}) => [row, ...track.at(state.frame)])"
    )
    known = {int(crowd.person[k]): (crowd.x[k], crowd.y[k]) for k in rows}
    assert {int(each[0]) for each in drawn} == set(known)
    for row, x, y, *_ in drawn:
        assert np.hypot(x - known[int(row)][0], y - known[int(row)][1]) < 0.002
    row, (x, y) = next(iter(known.items()))
    page.mouse.click(*page.evaluate("([x, y]) => state.plan.onPage(x, y)", [float(x), float(y)]))
    assert page.input_value("#person") == str(row)
    # The scale bar is as long as it says.
    metres, pixels = page.evaluate("state.plan.scaleBar()")
    a, b = (
        page.evaluate("([x, y]) => state.plan.onPage(x, y)", [x, 1.0]) for x in (1.0, 1.0 + metres)
    )
    assert b[0] - a[0] == pytest.approx(pixels, abs=1e-6)


@pytest.mark.slow
def test_legends_panel_and_curves_fold(page):
    assert "speed" in page.inner_text("#legend")
    page.select_option("#layer", "service")
    page.evaluate("draw()")
    assert "A 0.31" in page.inner_text("#legend")
    wide = page.evaluate("element('scene').clientWidth")
    page.click("#folded")
    assert page.evaluate("element('scene').clientWidth") == wide + 224
    high = page.evaluate("element('scene').clientHeight")
    page.click("#charted")
    assert page.evaluate("element('scene').clientHeight") > high + 40


@pytest.mark.slow
def test_a_camera_goes_along_its_path(page):
    places = page.evaluate(
        """() => {
          const { path } = state;
          const view = (time, x) => ({ time, eye: [x, 0, 2], target: [x + 1, 0, 1] });
          path.read(JSON.stringify({ views: [view(0, 0), view(2, 4), view(4, 8)] }));
          return [-1, 0, 1, 2, 3, 4, 9].map((time) => path.at(time * RATE).eye);
        }"""
    )
    # At an even pace along a straight line, slower at the ends, and it stays there.
    assert places[0] == places[1] == [0, 0, 2]
    assert places[3] == pytest.approx([4, 0, 2])
    assert places[5] == places[6] == [8, 0, 2]
    assert 1 < places[2][0] < 3
    assert 5 < places[4][0] < 7
    page.click("#along")
    page.evaluate("show(60)")
    assert page.evaluate("state.stage.perspective.position.toArray()") == pytest.approx([4, 0, 2])
    again = json.loads(page.evaluate("state.path.text()"))
    assert again["views"][1] == {"time": 2, "eye": [4, 0, 2], "target": [5, 0, 1]}
    page.evaluate("state.path.views.length = 0; null")
    for wrong in (
        "{}",
        '{"views": [{"time": 1}]}',
        '{"views": [{"time": "x", "eye": [0,0,0], "target": [0,0,0]}]}',
    ):
        with pytest.raises(Exception, match="expected views"):
            page.evaluate("(text) => state.path.read(text)", wrong)


@pytest.mark.slow
def test_people_wear_clothes_and_have_shadows(page):
    page.evaluate("show(30)")
    people = page.evaluate("(draw(), shown().length)")
    assert page.evaluate("state.stage.troops.shadows.count") == people
    page.select_option("#colour", "clothes")
    page.evaluate("draw()")
    assert page.evaluate("shown().every((each) => each.colour === null)")
    # Jacket, trousers, skin, hair and shoes of 24 varieties.
    assert page.evaluate("new Set(state.run.header.looks.map(String)).size") == 24
