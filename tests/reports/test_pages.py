"""Report pages: numbers, contents, links, and the PDF of them."""

import re
import shutil

import pytest
from matplotlib.figure import Figure

from mesa_mobility.errors import ResultsError
from mesa_mobility.reports import pdf
from mesa_mobility.reports.html import Link, Page, picture
from mesa_mobility.reports.words import with_value, words_of

PICTURE = picture(Figure(figsize=(1, 1)))


@pytest.fixture
def page():
    page = Page("A <report>", "Written today.")
    page.section("Summary", "summary")
    page.table(
        "main figures", ["figure", "value (s)"], [["time", 3.5], [Link("more", "more"), None]]
    )
    page.section("Results", "results")
    page.subsection("More of them", "more")
    page.picture("people & doors", PICTURE)
    page.table("Others", ["name", "verdict"], [["a", "pass"], ["b", "FAIL"]], "A note.")
    page.signatures()
    return page


def test_sections_tables_and_pictures_are_numbered_and_listed(page, tmp_path):
    page.write(tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "<h1>A &lt;report&gt;</h1>" in text
    assert re.findall(r"<h2 id=\"([^\"]+)\">(\d+)", text) == [
        ("summary", "1"),
        ("results", "2"),
        ("signatures", "3"),
    ]
    assert '<h3 id="more">2.1 More of them</h3>' in text
    assert re.findall(r"<b>(Table|Figure) (\d+)", text) == [
        ("Table", "1"),
        ("Figure", "1"),
        ("Table", "2"),
    ]
    contents = text.split("</nav>")[0]
    assert re.findall(r'href="#([^"]+)"', contents) == ["summary", "results", "more", "signatures"]
    # Each link leads somewhere, and nothing else is needed to show the page.
    places = set(re.findall(r'id="([^"]+)"', text))
    assert set(re.findall(r'href="#([^"]+)"', text)) <= places
    assert not re.search(r"(?:src|href)=\"(?!data:|#)", text)
    assert 'alt="People &amp; doors"' in text
    for who in ("Prepared by", "Checked by", "Approved by"):
        assert f"<td>{who}</td>" in text


def test_numbers_are_set_to_the_right_and_verdicts_are_marked(page, tmp_path):
    page.write(tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert '<td>time</td><td class="number">3.5</td>' in text
    assert '<td><a href="#more">more</a></td><td class="number">-</td>' in text
    assert '<td>a</td><td><span class="pass">pass</span></td>' in text
    assert '<td>b</td><td><span class="fail">FAIL</span></td>' in text


def test_units_and_words_of_commands_stay_in_one_piece(tmp_path):
    page = Page("Report")
    page.section("Flows", "flows")
    page.table("", ["specific flow (persons/(m s))", "plain"], [["a" * 64, "b"]])
    page.table("", ["", ""], [["a", "b"]])
    page.command(["run", "my room", "--set", "people=3"])
    page.write(tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert '<th>specific flow <span class="unit">(persons/(m s))</span></th><th>plain</th>' in text
    assert f'<span class="long">{"a" * 64}</span>' in text
    # A table without names of columns has no row for them.
    assert text.count("<thead>") == 1
    words = ["run", "&#x27;my room&#x27;", "--set", "people=3"]
    assert " ".join(f"<span>{each}</span>" for each in words) in text


@pytest.mark.parametrize(
    ("label", "said"),
    [
        ("door width (m)", "door width 0.8 m"),
        ("flow (persons/(m s))", "flow 0.8 persons/(m s)"),
        ("people", "people 0.8"),
    ],
)
def test_a_label_with_its_value(label, said):
    assert with_value(label, "0.8") == said


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("egress_s", "time until everybody is out (s)"),
        ("door.first door.flow_per_s", "door “first door”: mean flow (persons/s)"),
        ("room.hall.last_s", "room “hall”: time when the last person has left (s)"),
        ("level.1.t95_s", "level 1: time until 95 % of the people are out (s)"),
        ("stairs.b.north.t50_s", "stairs “b.north”: time until 50 % of the people are out (s)"),
        ("walked_m", "walked (m)"),
        ("top_speed_mps", "top speed (m/s)"),
        ("rate_per_s", "rate (1/s)"),
        ("headway.time", "headway.time"),
        ("yield", "yield"),
    ],
)
def test_figures_are_named_in_words_with_their_units(name, words):
    assert words_of(name) == words


def test_names_that_somebody_gives_count_first():
    assert words_of("egress_s", {"egress_s": "time (min)"}) == "time (min)"


def test_a_page_is_printed_on_a4(page, tmp_path, browser_program, monkeypatch):
    monkeypatch.setenv(pdf.BROWSER, browser_program)
    page.write(tmp_path / "page.html")
    pdf.write_pdf(tmp_path / "page.html", tmp_path / "page.pdf")
    content = (tmp_path / "page.pdf").read_bytes()
    assert content.startswith(b"%PDF-")
    sizes = {
        tuple(float(each) for each in box.split())
        for box in re.findall(rb"/MediaBox\s*\[([^\]]+)\]", content)
    }
    # 210 mm by 297 mm in points.
    for size in sizes:
        assert size == pytest.approx((0, 0, 595.28, 841.89), abs=1)
    assert [each.name for each in tmp_path.iterdir() if each.name.startswith(".")] == []
    # Its headings are bookmarks.
    assert b"/Outlines" in content


def test_what_lacks_for_a_pdf_is_said_in_one_line(page, tmp_path, monkeypatch):
    page.write(tmp_path / "page.html")
    monkeypatch.setenv(pdf.BROWSER, "no-such-browser")
    with pytest.raises(ResultsError, match=r"no browser.*'no-such-browser', expected Chromium"):
        pdf.write_pdf(tmp_path / "page.html", tmp_path / "page.pdf")
    monkeypatch.delenv(pdf.BROWSER)
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(ResultsError, match="none installed"):
        pdf.browser_program()


def test_a_browser_that_fails_leaves_no_file(page, tmp_path, monkeypatch):
    page.write(tmp_path / "page.html")
    monkeypatch.setenv(pdf.BROWSER, "false")
    with pytest.raises(ResultsError, match=r"has not printed .*page\.html, status 1"):
        pdf.write_pdf(tmp_path / "page.html", tmp_path / "page.pdf")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["page.html"]
