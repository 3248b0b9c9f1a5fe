"""The report of the standards' tests, from outcomes made by hand."""

import base64
import re
import struct
from dataclasses import replace

import numpy as np
import pytest

from mesa_mobility import Exit, FloorPlan, Gate
from mesa_mobility.errors import ResultsError
from mesa_mobility.reports.html import Page
from mesa_mobility.results import Trajectories
from mesa_mobility.verification import Outcome, catalogue
from mesa_mobility.verification.checks import within
from mesa_mobility.verification.drawings import collect, draw, first_run_drawn
from mesa_mobility.verification.report import write_report

WALLS = np.array([[0.0, 0.0, 10.0, 0.0], [0.0, 2.0, 10.0, 2.0]])
CORRIDOR = FloorPlan(
    "POLYGON ((0 0, 10 0, 10 2, 0 2, 0 0))",
    exits=[Exit("out", (10, 0), (10, 2))],
    gates=[Gate("middle", (5, 0), (5, 2))],
)


def tracks(people, frames):
    frame, person = (each.ravel() for each in np.mgrid[0:frames, 0:people])
    return Trajectories(frame, person, frame * 0.04, person * 0.02, np.zeros(len(frame)))


def rows_of(text):
    """Cells of all rows of all tables."""
    rows = re.findall(r"<tr>(<td.*?)</tr>", text)
    return [tuple(re.findall(r"<td[^>]*>(.*?)</td>", row)) for row in rows]


def outcome(verdict, **keywords):
    given = {
        "measured": {"travel time s": 30.25, "overlaps": 0},
        "failed": [],
        "reported": [],
        "seeds": [1, 2],
        "per_seed": [],
        "safety": {"overlaps": 0, "wall_crossings": 0},
    }
    return Outcome(verdict, **{**given, **keywords})


def test_only_the_first_run_is_drawn_and_only_where_one_asks():
    collect(tracks(2, 3), WALLS, CORRIDOR)  # nobody asks
    with first_run_drawn() as found:
        collect(tracks(100, 400), WALLS, CORRIDOR)
        collect(tracks(2, 3), WALLS, CORRIDOR)
    [drawing] = found
    assert (drawing.people, len(drawing.ways)) == (100, 60)
    # Those drawn are spread over all, and each way has its first and its last point.
    assert drawing.ways[0][0] == pytest.approx([0.0, 0.0])
    assert drawing.ways[-1][-1] == pytest.approx([399 * 0.04, 99 * 0.02])
    assert max(len(way) for way in drawing.ways) == 150
    assert drawing.exits.tolist() == [[10, 0, 10, 2]]
    assert drawing.doors.tolist() == [[5, 0, 5, 2]]
    figure = draw(drawing)
    assert figure.axes[0].get_xlabel() == "x (m)"
    said = [each.get_text() for each in figure.legends[0].get_texts()]
    assert said == ["wall", "door", "exit", "way of a person, from its dot"]


def test_stairs_are_drawn():
    from tests.fixtures.buildings import two_storeys

    building = two_storeys()
    with first_run_drawn() as found:
        collect(tracks(2, 3), WALLS, building)
    # A straight flight, and two flights with a landing.
    assert len(found[0].stairs) == 4
    assert "stairs or lift" in [each.get_text() for each in draw(found[0]).legends[0].get_texts()]


def test_the_page_has_criterion_source_figures_picture_verdict_and_versions(tmp_path):
    with first_run_drawn() as found:
        collect(tracks(3, 20), WALLS, CORRIDOR)
    entries = catalogue()
    names = ["rimea-01", "rimea-06", "imo-04"]
    verdicts = [
        outcome(
            "pass",
            checks=[within("travel time s", 30.25, 26.0, 34.0)],
            drawings=[("speed 1.33", found[0])],
        ),
        outcome("fail", failed=["points outside: 3, wanted 0 (seed 2)"]),
        outcome("cap", reported=["flow: 2, wanted at most 1.33"]),
    ]
    page = tmp_path / "report.html"
    write_report(entries, dict(zip(names, verdicts, strict=True)), page)
    text = page.read_text(encoding="utf-8")
    assert not re.search(r"(?:src|href)=\"(?!data:|#)", text)
    assert "Tests: 3. Passed: 1. Failed: 1. “Cap exceeded”: 1." in text
    title = "one person walks along a corridor at their own speed"
    assert f'<h3 id="rimea-01">3.1 rimea-01: {title}</h3>' in text
    assert '<a href="#rimea-01">rimea-01</a>' in text
    assert "<td>source</td><td>RiMEA guideline 3.0 and 4.1.1, test 1</td>" in text
    assert "The person walks the 40 m in 26 to 34 s" in text
    row = ("travel time (s)", "30.25", "26 to 34", '<span class="pass">pass</span>')
    assert row in rows_of(text)
    assert "Not met: points outside: 3, wanted 0 (seed 2)." in text
    # In the summary and in the test itself; each figure has its verdict beside it.
    assert text.count('<span class="pass">pass</span>') == 2 + 1
    assert text.count('<span class="fail">FAIL</span>') == 2
    assert text.count(">cap exceeded<") == 2
    assert text.count("data:image/png;base64,") == 1
    assert "Ways of 3 people, with a dot where each begins (speed 1.33; seed 1)" in text
    command = re.sub("<[^>]+>", "", re.search(r'<pre class="command">(.*?)</pre>', text)[1])
    assert command == "mesa-mobility verify rimea-01 rimea-06 imo-04 --seeds 2"
    for hidden in ("POLYGON", "LINESTRING", ".csv", ".toml"):
        assert hidden not in text
    assert re.search(r"<td>mesa-mobility</td><td>\d", text)
    assert re.search(r"<td>recorded movements: able bodied up</td>.*[0-9a-f]{64}", text)
    assert "seeds 1 to 2." in text
    with pytest.raises(ResultsError, match="cannot be written"):
        write_report(entries, {"rimea-01": verdicts[0]}, tmp_path / "nowhere" / "report.html")


def test_the_page_of_a_comparison(tmp_path):
    from mesa_mobility import validation
    from mesa_mobility.validation.report import write_report as write_comparisons
    from mesa_mobility.verification import Verdict, charts
    from mesa_mobility.verification.checks import at_most

    verdict = Verdict(
        (at_most("never", 1.0, 0.0), at_most("ever", 3.0, 2.0, gates=False)), {"share": 0.5}
    )
    drawn = validation.EXPERIMENTS["walking"]
    shown = replace(drawn, draw=lambda figures: charts.panels(1)[0])
    page = tmp_path / "report.html"
    write_comparisons([shown], {"walking": verdict}, 3, page)
    text = page.read_text(encoding="utf-8")
    assert "0 of 1 comparisons pass" in text
    rows = rows_of(text)
    assert ("never", "1", "at most 0", '<span class="fail">FAIL</span>') in rows
    assert ("ever", "3", "at most 2", "outside") in rows
    assert ("share", "0.5", "-", "reported") in rows
    assert ("measured", drawn.source) in rows
    assert ("criterion", drawn.criterion) in rows
    # The comparison judges one figure, which is not as measured, and reports another.
    assert rows[0][2:] == ("1", "1", '<span class="fail">FAIL</span>')
    assert text.count("data:image/png;base64,") == 1


def test_one_person_is_no_people_and_a_long_floor_has_no_blank_around_it(tmp_path):
    with first_run_drawn() as found:
        collect(tracks(1, 20), np.array([[0.0, 0.0, 40.0, 0.0], [0.0, 2.0, 40.0, 2.0]]), CORRIDOR)
    page = tmp_path / "report.html"
    passed = outcome("pass", drawings=[("speed 1.33", found[0])])
    write_report(catalogue(), {"rimea-01": passed}, page)
    text = page.read_text(encoding="utf-8")
    assert "Ways of 1 person, with a dot where each begins (speed 1.33; seed 1)" in text
    png = base64.b64decode(re.search(r"base64,([^\"]+)", text)[1])
    width, height = struct.unpack(">II", png[16:24])
    # 40 m by 2 m, stretched to be seen, the labels of the axes and the legend.
    assert height < 0.3 * width


def test_a_label_beside_a_long_text_is_not_broken_within_a_word(
    tmp_path, playwright, browser_program
):
    page = Page("Report")
    page.table("", ["", ""], [["measured, medians", 40 * "of everything " + 500 * "a"]])
    page.write(tmp_path / "report.html")
    browser = playwright.chromium.launch(executable_path=browser_program, args=["--no-sandbox"])
    shown = browser.new_page(viewport={"width": 700, "height": 500})
    shown.goto((tmp_path / "report.html").as_uri())
    lines = shown.evaluate("""() => {
      const cell = document.querySelector("tbody td").firstChild, range = new Range();
      range.setStart(cell, 0);
      range.setEnd(cell, "measured,".length);
      return range.getClientRects().length;
    }""")
    browser.close()
    assert lines == 1
