"""The scripts in examples/ run, and show what they say they show."""

import importlib.util
import re
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "examples"


def run(name: str, capsys: pytest.CaptureFixture[str]) -> str:
    spec = importlib.util.spec_from_file_location(f"example_{name}", FOLDER / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.main()
    return capsys.readouterr().out


def numbers(pattern: str, text: str) -> list[float]:
    return [float(found) for found in re.findall(pattern, text)]


def test_every_example_is_tested() -> None:
    tested = {name[len("test_") :] for name in globals() if name.startswith("test_")}

    assert {file.stem for file in FOLDER.glob("*.py")} <= tested


def test_first_crowd(capsys: pytest.CaptureFixture[str]) -> None:
    [seconds] = numbers(r"40 people are out after (\S+) s", run("first_crowd", capsys))

    # Forty people at 2.2 persons/s, and 5 m of way.
    assert 10.0 < seconds < 40.0


def test_own_cost_term(capsys: pytest.CaptureFixture[str]) -> None:
    lines = run("own_cost_term", capsys).splitlines()

    assert len(lines) == 2
    east, west = zip(*(numbers(r"y = (\S+) m", line) for line in lines), strict=True)
    # Left of the way east is the greater y.
    assert east[1] > east[0] + 0.1
    assert west[1] < west[0] - 0.1


def test_own_speed_rule(capsys: pytest.CaptureFixture[str]) -> None:
    clear, some, thick = numbers(r"after (\S+) s", run("own_speed_rule", capsys))

    assert clear < some < thick


def test_sources_over_time(capsys: pytest.CaptureFixture[str]) -> None:
    text = run("sources_over_time", capsys)
    [trickle] = numbers(r"(\d+) people trickled", text)

    # 20 are expected of a Poisson process of 0.5/s in 40 s: 20 +- 4.5, three deviations.
    assert 6 <= trickle <= 34
    assert "30 came by train" in text


def test_speeds_by_age(capsys: pytest.CaptureFixture[str]) -> None:
    students, older = numbers(r"like (\S+) m/s", run("speeds_by_age", capsys))

    assert students == pytest.approx(1.55, abs=0.05)
    # Weidmann's curve falls from 1.1 m/s at 65 years to 0.7 at 80.
    assert 0.6 < older < 1.15


def test_exits_chosen(capsys: pytest.CaptureFixture[str]) -> None:
    nearest, quickest, familiar = run("exits_chosen", capsys).splitlines()

    assert "54 by the near exit, 0 by the far one" in nearest
    assert numbers(r"(\d+) by the far", quickest)[0] > 0
    assert numbers(r"(\d+) by the far", familiar)[0] > 27
    assert numbers(r"after (\S+) s", quickest) < numbers(r"after (\S+) s", nearest)


def test_places_to_visit(capsys: pytest.CaptureFixture[str]) -> None:
    lines = run("places_to_visit", capsys).splitlines()

    # 20 to 40 s at the shelves, 10 s at the till, and 10 to 25 m of way.
    assert len(lines) == 4
    for seconds in numbers(r"after (\S+) s", "\n".join(lines)):
        assert 38.0 < seconds < 130.0


def test_routes_chosen(capsys: pytest.CaptureFixture[str]) -> None:
    shortest, quickest = run("routes_chosen", capsys).splitlines()

    assert "40 by the lower corridor, 0 by the upper one" in shortest
    # The upper way is some 3.3 m, 2.5 s, longer, and 2.5 people a second pass 1.2 m: the shares
    # differ by about 6 of 40.
    assert numbers(r"(\d+) by the upper", quickest)[0] == pytest.approx(17, abs=5)
    assert numbers(r"after (\S+) s", quickest) < numbers(r"after (\S+) s", shortest)


def test_smoke_avoided(capsys: pytest.CaptureFixture[str]) -> None:
    unaware, aware = run("smoke_avoided", capsys).splitlines()

    # The way in which the smoke is, is the shorter one.
    assert numbers(r"(\d+) of 40 walked through", unaware)[0] > 20
    assert numbers(r"(\d+) of 40 walked through", aware) == [0]


def test_walking_abreast(capsys: pytest.CaptureFixture[str]) -> None:
    text = run("walking_abreast", capsys)

    # Moussaid et al. (2010): 1.26 - 0.04 N m/s, and about 0.75 m apart.
    assert numbers(r": (\S+) m/s", text) == pytest.approx([1.22, 1.18, 1.14], abs=0.04)
    assert numbers(r"(\S+) m apart", text) == pytest.approx([0.75, 0.75], abs=0.1)


def test_guided_tour(capsys: pytest.CaptureFixture[str]) -> None:
    alone, guided = run("guided_tour", capsys).splitlines()

    # The door by which they came is the nearer one.
    assert numbers(r"(\d+) by the far", alone) == [1]
    assert numbers(r"(\d+) by the far", guided) == [11]


def test_queue_at_counters(capsys: pytest.CaptureFixture[str]) -> None:
    text = run("queue_at_counters", capsys)

    assert numbers(r"line: (\d+) people", text) == [4]
    # Four times 3 to 5 s and some 2 s between two of them, 7 m to the first and 10 m from the last.
    [seconds] = numbers(r"after (\S+) s", text)
    assert 25.0 < seconds < 50.0


def test_shop_window(capsys: pytest.CaptureFixture[str]) -> None:
    shares = numbers(r"(\d+) of 24 stop", run("shop_window", capsys))

    # 0 and 100 %, and 12 +- 7.3, three deviations, for a half.
    assert shares[0] == 0
    assert 4 < shares[1] < 20
    assert shares[2] == 24


def test_giving_way(capsys: pytest.CaptureFixture[str]) -> None:
    niche, none = run("giving_way", capsys).splitlines()

    # They pass at the niche; without it some go back beyond the corridor, which ends at 32 m.
    assert numbers(r"x = (\S+) m", niche)[0] < 27.0
    assert numbers(r"x = (\S+) m", none)[0] > 32.0


@pytest.mark.thorough
def test_batch_of_runs(capsys: pytest.CaptureFixture[str]) -> None:
    narrow, middle, wide = numbers(r": (\S+) s, sd", run("experiments/batch_of_runs", capsys))

    assert narrow > middle > wide


def test_analysis_with_pedpy(capsys: pytest.CaptureFixture[str]) -> None:
    text = run("analysis_with_pedpy", capsys)
    [flow] = numbers(r"flow (\S+) persons/s", text)

    # Published bottleneck experiments of 1 m: 2.233 b - 0.155 +- 0.7 persons/s.
    assert 1.378 < flow < 2.778


@pytest.mark.thorough
def test_live_client(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("websockets")
    first, moved, error = run("live_client", capsys).splitlines()

    assert first == "Doorway: 60 people"
    x, y, later_x, later_y = numbers(r"(\d+\.\d)", moved)
    # 1.2 m/s for 3 s less the first steps, up the hall, however late the commands come.
    assert (x, y) == (12.0, 1.0)
    assert abs(later_x - 12.0) < 1.0
    assert 2.6 < later_y - y < 3.9
    assert error == "there is no gate or exit 'no such door'; there are 'first door', 'second door'"
