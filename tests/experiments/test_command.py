"""`mesa-mobility experiment`, and the commands for a cluster as the how-to prints them."""

import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from mesa_mobility.experiments import open_store
from tests.commands.conftest import command

# Many processes, which take minutes and count on a machine that is not loaded.
pytestmark = pytest.mark.slow

__all__ = ["command"]

ROOT = Path(__file__).parents[2]
FILE = """
model = "tests.fixtures.experiments.models:Quick"
seed = 5
replications = 10
[fixed]
end = "slow"
[grid]
x = [0.0, 1.5, 3.0]
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "quick.toml"
    path.write_text(FILE)
    return path


def test_run_status_report(command, file, tmp_path):
    dry = command("experiment", "run", file, "--dry-run")
    assert (dry.status, dry.err) == (0, "")
    assert re.search(r"Runs to do +30\b", dry.out)
    assert not (tmp_path / "quick").exists()
    done = command("experiment", "run", file, "--workers", 2)
    assert done.status == 0, done.err
    assert re.search(r"Done +30\b", done.out)
    told = command("experiment", "status", tmp_path / "quick", "--json")
    counts = json.loads(told.out)
    assert (counts["asked"], counts["done"], counts["missing"]) == (30, 30, 0)
    page = command("experiment", "report", tmp_path / "quick")
    assert page.status == 0
    assert (tmp_path / "quick" / "report.html").stat().st_size > 10_000
    again = command("experiment", "run", file, "--dry-run")
    assert re.search(r"Runs to do +0\b", again.out)


def test_runs_that_fail_give_status_1(command, file):
    file.write_text(FILE.replace("slow", "raise"))
    done = command("experiment", "run", file, "--workers", 1)
    assert done.status == 1
    assert re.search(r"Failed +30\b", done.out)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run", "no.toml"], "no.toml: no such file, expected an experiment in TOML"),
        (["status", "nowhere"], "nowhere: has no experiment.json, expected the store"),
        (["report", "nowhere"], "nowhere: has no experiment.json, expected the store"),
        (["status", "nothing://x"], "nothing://x: "),
    ],
)
def test_bad_input_is_one_line(command, arguments, message):
    outcome = command("experiment", *arguments)
    assert outcome.status == 2
    assert outcome.err.startswith(f"error: {message}")
    assert len(outcome.err.splitlines()) == 1


def test_ctrl_c_keeps_what_has_ended(file, tmp_path):
    # Half of the runs do not end, however slow the machine is.
    file.write_text(
        FILE.replace('end = "slow"', f'mark = "{tmp_path / "mark"}"') + 'end = ["well", "wait"]\n'
    )
    started = subprocess.Popen(
        [sys.executable, "-m", "mesa_mobility", "experiment", "run", str(file), "--workers", "1"],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stderr=subprocess.PIPE,
        text=True,
    )
    store = tmp_path / "quick"
    wait_for(lambda: list(store.glob("runs/*.parquet")))
    started.send_signal(signal.SIGINT)
    _, error = started.communicate(timeout=60)
    assert started.returncode == 130
    assert error.splitlines()[-1].startswith("interrupted: what has ended is kept")
    assert 0 < open_store(store).status()["done"] <= 30


def wait_for(condition, seconds=60.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


@pytest.fixture
def scheduler(tmp_path):
    """A scheduler and two workers, started with the commands of the how-to."""
    pytest.importorskip("distributed", reason="needs the extra cluster")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    page = (ROOT / "docs" / "how-to" / "experiments.md").read_text(encoding="utf-8")
    printed = re.findall(r"^\$? ?(dask (?:scheduler|worker) .*)$", page, re.M)
    assert [line.split()[1] for line in printed[:2]] == ["scheduler", "worker"]
    scripts = Path(sys.executable).parent
    environment = os.environ | {"PYTHONPATH": str(ROOT), "PATH": f"{scripts}:{os.environ['PATH']}"}
    if not shutil.which("dask", path=environment["PATH"]):
        pytest.skip("no command dask beside the interpreter")
    processes = []
    for line in printed[:2]:
        words = line.replace("8786", str(port)).replace("head", "127.0.0.1").split()
        extra = ["--host", "127.0.0.1", "--no-dashboard"] if words[1] == "scheduler" else []
        processes.append(
            subprocess.Popen(
                words + extra,
                env=environment,
                cwd=tmp_path,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
        )
    yield f"tcp://127.0.0.1:{port}", processes
    for process in processes:
        process.terminate()
        process.wait()


def on_scheduler(file, address):
    return subprocess.Popen(
        [
            sys.executable,
            "-m",
            "mesa_mobility",
            "experiment",
            "run",
            str(file),
            "--scheduler",
            address,
        ],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def test_the_how_to_s_commands_for_several_machines_work(file, scheduler, tmp_path):
    address, _ = scheduler
    out, error = (done := on_scheduler(file, address)).communicate(timeout=120)
    assert done.returncode == 0, error
    assert re.search(r"Done +30\b", out)
    workers = open_store(tmp_path / "quick").frame().worker.nunique()
    assert workers == 2


@pytest.mark.slow
def test_a_scheduler_that_is_killed(file, scheduler, tmp_path):
    file.write_text(FILE.replace("replications = 10", "replications = 100"))
    address, processes = scheduler
    driver = on_scheduler(file, address)
    store = tmp_path / "quick"
    wait_for(lambda: list(store.glob("runs/*.parquet")))
    processes[0].kill()
    _, error = driver.communicate(timeout=180)
    assert driver.returncode == 2
    assert len(error.splitlines()) == 1 or "out of reach" in error
    had = open_store(store).frame().set_index("run").began
    assert 0 < len(had) < 300
    again = subprocess.run(
        [sys.executable, "-m", "mesa_mobility", "experiment", "run", str(file), "--workers", "2"],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=180,
    )
    assert again.returncode == 0, again.stderr
    frame = open_store(store).frame()
    assert len(frame) == frame.run.nunique() == 300
    assert (frame.set_index("run").began[had.index] == had).all()


@pytest.mark.slow
def test_two_workers_on_an_empty_cache(tmp_path):
    """One compiles, the other waits; the cache is whole, and the next process compiles nothing."""
    file = tmp_path / "doorway.toml"
    file.write_text(
        'model = "doorway"\nreplications = 4\nmax_seconds = 5\n[fixed]\npedestrians = 3\n'
    )
    cache = tmp_path / "cache"
    environment = os.environ | {"NUMBA_CACHE_DIR": str(cache)}
    arguments = [sys.executable, "-m", "mesa_mobility", "experiment", "run", str(file)]
    done = subprocess.run(
        [*arguments, "--workers", "2"], env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert open_store(tmp_path / "doorway").status()["done"] == 4
    assert len({*open_store(tmp_path / "doorway").frame().worker}) == 2
    decisions = list(cache.glob("*/*/decision.decide-*.nbc"))
    assert len(decisions) == 1
    kept = {path: path.stat().st_mtime_ns for path in cache.rglob("*.nbc")}
    again = subprocess.run(
        [*arguments, "--workers", "1", "--store", str(tmp_path / "again")],
        env=environment,
        capture_output=True,
        text=True,
    )
    assert again.returncode == 0, again.stderr
    assert {path: path.stat().st_mtime_ns for path in cache.rglob("*.nbc")} == kept
    assert "damaged" not in done.stderr + again.stderr
