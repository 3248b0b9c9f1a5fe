import re

import pytest


@pytest.fixture(scope="module")
def run_dir(tmp_path_factory):
    from mesa_mobility import Exit, FloorPlan, PedestrianModel
    from mesa_mobility.results import Trajectories, write_run

    plan = FloorPlan(
        "POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))", exits=[Exit("door", (6, 1.0), (6, 3.0))]
    )
    model = PedestrianModel(plan, record="decisions", rng=5)
    model.add_pedestrians([(1.0, 1.0), (4.5, 2.0)])
    model.run(max_seconds=1)
    folder = tmp_path_factory.mktemp("run")
    write_run(folder, summary=model.summary(), trajectories=Trajectories.of(model), plan=plan)
    return folder


@pytest.mark.thorough
def test_a_run_becomes_figures_films_and_stills(command, run_dir, tmp_path):
    outcome = command("animate", run_dir, "-o", tmp_path / "crowd.glb")
    assert (outcome.status, outcome.out) == (0, "")
    assert "2 people written" in outcome.err
    assert (tmp_path / "crowd.glb").read_bytes()[:4] == b"glTF"
    outcome = command("export", run_dir, "-o", tmp_path / "bvh", "--format", "bvh", "--people", "1")
    assert outcome.status == 0
    assert [each.name for each in (tmp_path / "bvh").iterdir()] == ["person_1.bvh"]
    outcome = command("export", run_dir, "-o", tmp_path / "crowd.html")
    assert outcome.status == 0
    # One file: nothing is asked for from elsewhere.
    page = (tmp_path / "crowd.html").read_text()
    size = len(page.encode()) / 1e6
    assert f"2 people written to {tmp_path / 'crowd.html'}, {size:.1f} MB" in " ".join(
        outcome.err.split()
    )
    assert not re.findall(r"<(?:script|link|img)[^>]+(?:src|href)=", page)
    for name in ("crowd.gif", "crowd.png"):
        outcome = command("render", run_dir, "-o", tmp_path / name)
        assert (outcome.status, (tmp_path / name).is_file()) == (0, True), outcome.err


def test_a_run_becomes_tables(command, run_dir, tmp_path):
    from mesa_mobility.results import read_parquet

    for name in ("all.parquet", "all.sqlite", "all.txt"):
        outcome = command("export", run_dir, "-o", tmp_path / name)
        assert (outcome.status, (tmp_path / name).is_file()) == (0, True), outcome.err
    arguments = ("--people", "1", "--from", 0.5, "--to", 0.8)
    assert command("export", run_dir, "-o", tmp_path / "part.parquet", *arguments).status == 0
    part = read_parquet(tmp_path / "part.parquet")
    assert part.frame.tolist() == list(range(15, 25))
    assert part.person.tolist() == [1] * 10
    assert part.remaining.tolist() == [1]
    whole = read_parquet(run_dir / "trajectories.parquet")
    assert len(read_parquet(tmp_path / "all.parquet")) == len(whole)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("animate", "{run}", "-o", "x.glb", "--people", "9"), "person 9"),
        (("animate", "{run}", "-o", "x.glb", "--people", "a"), "--people: 'a'"),
        (("animate", "{run}", "-o", "x.glb", "--from", "5"), "within the run's"),
        (("animate", "nowhere", "-o", "x.glb"), "no summary.json"),
        (("animate", "{run}", "-o", "x.glb", "--poses", "absent.npz"), "no such file"),
        (("animate", "{run}", "-o", "x.glb", "--format", "usd"), "ends with .usd"),
        (("render", "{run}", "-o", "x.avi"), "x.avi: expected a name that ends in .bvh, .mp4"),
        (("export", "{run}", "-o", "x.glb", "--format", "gbl"), "unknown output format 'gbl', did"),
        (("export", "{run}", "-o", "x.glb", "--speed", "2"), "format glb: unknown option 'speed'"),
        (("export", "{run}", "-o", "x.gif", "--set", "speed=x"), "speed: got 'x', expected a num"),
        (("export", "{run}", "-o", "x.png", "--at", "a"), "at: got 'a', expected numbers"),
    ],
)
def test_bad_input_gives_one_line(command, run_dir, tmp_path, monkeypatch, arguments, said):
    monkeypatch.chdir(tmp_path)
    outcome = command(*(each.format(run=run_dir) for each in arguments))
    assert outcome.status == 2
    assert said in outcome.err
    assert outcome.err.count("\n") == 1
    assert not (tmp_path / "x.glb").exists()
