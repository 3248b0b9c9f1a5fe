"""Sessions played at random, as a person would; what a click shows is checked apart from the page.

    MESA_MOBILITY_MONKEY=5x500 pytest -m slow tests/dashboard/test_monkey.py

plays 5 sessions of 500 actions on each model.
"""

import os
import random
import re

import pytest

from tests.dashboard.selectors import CANVAS, SHOWN

SEEDS, ACTIONS = map(int, os.environ.get("MESA_MOBILITY_MONKEY", "1x60").split("x"))
MODELS = ("doorway", "auditorium", "open_space", "straight_walk")
TAKEN_AWAY = "console: Syncing error: no comm channel defined"
"""What the page's widget library says of text typed into a field that the server has just closed,
before it is gone from the page. Nothing is lost: the model it belonged to has been left."""
DECISION = "document.querySelector('.mm-decision')"
TYPED = (
    "-1",
    "0",
    "",
    "nan",
    "-inf",
    "1e308",
    "many",
    "none",
    "3.5",
    "7",
    "2",
    "0.5",
    "None",
    "<b>",
)
PARAMETERS = (
    "seed",
    "pedestrians",
    "size",
    "door width",
    "frames per step",
    "pre movement",
    "mobility map",
)
# More than is made without a question, more than a room holds, and more than is accepted.
HUGE = ("20000", "300000", "1000000", "1000001", "3000000000")
KEYS = (
    "Space",
    "+",
    "-",
    "0",
    "Escape",
    "ArrowLeft",
    "ArrowUp",
    "Tab",
    "PageDown",
    "Home",
    "Enter",
    "w",
    "d",
)

# Keeps what was published when a click came, before the page takes notice of it.
RECORD = """() => {
    window.clicked = [];
    window.addEventListener("pointerup", (event) => {
        const canvas = event.target;
        if (canvas.className !== "mm-crowd-canvas") return;
        const { left, top, width, height } = canvas.getBoundingClientRect();
        const { people, view, plates, run } = canvas.shown();
        window.clicked.push({ x: event.clientX - left, y: event.clientY - top, width, height,
            people, view, plates, run });
    }, { capture: true });
}"""

# The middle of one of the things on the page that can be seen and used.
SOMETHING = """([selector, share]) => {
    const all = [...document.querySelectorAll(selector)]
        .filter((e) => e.offsetParent && !e.disabled);
    if (!all.length) return null;
    const one = all[Math.floor(share * all.length)];
    one.scrollIntoView({ block: "center" });
    const box = one.getBoundingClientRect();
    return [box.left + box.width / 2, box.top + box.height / 2];
}"""


def playwright_timeout():
    from playwright.sync_api import TimeoutError

    return TimeoutError


def hit(click):
    """Rows of the people that a click may have meant: the nearest within reach, and its like."""
    scale = click["view"]["scale"]
    x = click["view"]["x"] + (click["x"] - click["width"] / 2) / scale
    y = click["view"]["y"] - (click["y"] - click["height"] / 2) / scale
    for plate in click["plates"]:
        if abs(click["x"] - plate["x"]) < plate["wide"] / 2 and (
            abs(click["y"] - plate["y"]) < plate["high"] / 2
        ):
            return set()
    flat = click["people"]
    away = {
        int(flat[k]): ((flat[k + 1] - x) ** 2 + (flat[k + 2] - y) ** 2) ** 0.5
        for k in range(0, len(flat), 6)
    }
    least = min(away.values(), default=float("inf"))
    if least >= max(0.25, 8 / scale):
        return set()
    return {row for row, distance in away.items() if distance < least + 0.02}


class Monkey:
    """One person's hands on a tab."""

    def __init__(self, tab, rng):
        self.tab, self.page, self.rng = tab, tab.page, rng
        self.checked = self.cancelled = 0
        self.page.evaluate(RECORD)

    def act(self):
        kinds = {
            self.click_person: 6,
            self.click_floor: 3,
            self.drag: 3,
            self.wheel: 3,
            self.key: 4,
            self.press_button: 5,
            self.type: 2,
            self.switch: 1,
            self.turn: 1,
            self.change_model: 1,
            self.type_a_huge_crowd: 1,
        }
        self.rng.choices(list(kinds), list(kinds.values()))[0]()

    def on_canvas(self):
        self.page.evaluate(SOMETHING, [".mm-crowd-canvas", 0.0])
        box = self.page.evaluate(
            f"""() => {{
                const {{ left, top, width, height }} = {CANVAS}.getBoundingClientRect();
                return [left, top, width, height];
            }}"""
        )
        left, top, width, height = box
        return left + width * self.rng.uniform(0.02, 0.98), top + height * self.rng.uniform(
            0.02, 0.98
        )

    def click_person(self):
        where = self.page.evaluate(
            f"""(share) => {{
                const canvas = {CANVAS};
                if (!canvas.offsetParent) return null;
                canvas.scrollIntoView({{ block: "center" }});
                const {{ people }} = canvas.shown(), n = people.length / 6;
                if (!n) return null;
                const k = 6 * Math.floor(share * n);
                return canvas.onPage(people[k + 1], people[k + 2]);
            }}""",
            self.rng.random(),
        )
        if where:
            self.click(where)

    def click_floor(self):
        if self.page.evaluate(f"() => Boolean({CANVAS}.offsetParent)"):
            self.click(self.on_canvas())

    def click(self, where):
        self.page.mouse.click(*where)
        clicks = self.page.evaluate("() => window.clicked.splice(0)")
        if not clicks:
            return  # something lies over the canvas there
        rows = hit(clicks[-1])
        if not rows:
            return
        # The view shows the clicked person's decision, or that the person has left, or another run.
        try:
            # Steps under way end first: with a million people on two pages, they take a minute.
            self.page.wait_for_function(
                f"""([rows, run]) => {{
                    const shown = {DECISION}.__vue__.decision, now = {SHOWN};
                    return rows.includes(shown.pedestrian) && rows.includes(now.selected)
                        || rows.includes(shown.left) || now.run !== run;
                }}""",
                arg=[sorted(rows), clicks[-1]["run"]],
                timeout=60_000 + 0.05 * len(clicks[-1]["people"]),
            )
        except playwright_timeout():
            state = self.page.evaluate(
                f"""() => {{
                    const {{ pedestrian, left }} = {DECISION}.__vue__.decision;
                    const {{ selected, run, moving, elapsed }} = {SHOWN};
                    return {{ pedestrian, left, selected, run, moving, elapsed }};
                }}"""
            )
            text = self.page.evaluate("() => document.body.innerText")
            pytest.fail(f"clicked {sorted(rows)} of run {clicks[-1]['run']}: {state}\n{text}")
        self.checked += 1

    def drag(self):
        x, y = self.on_canvas()
        self.page.mouse.move(x, y)
        self.page.mouse.down()
        self.page.mouse.move(x + self.rng.uniform(-300, 300), y + self.rng.uniform(-300, 300))
        self.page.mouse.up()
        self.page.evaluate("() => window.clicked.splice(0)")

    def wheel(self):
        self.page.mouse.move(*self.on_canvas())
        with_ctrl = self.rng.random() < 0.7
        if with_ctrl:
            self.page.keyboard.down("Control")
        self.page.mouse.wheel(0, self.rng.choice((-300, -60, 60, 300, 100000)))
        if with_ctrl:
            self.page.keyboard.up("Control")

    def key(self):
        self.page.keyboard.press(self.rng.choice(KEYS))

    def press_button(self):
        where = self.page.evaluate(
            SOMETHING,
            [
                ".mm-time button, .mm-crowd button, .mm-right button, .mm-map button",
                self.rng.random(),
            ],
        )
        if where:
            self.page.mouse.click(*where)

    def type(self):
        label = self.rng.choice((*PARAMETERS, "weight of headway", "weight of preferred velocity"))
        self.fill(label, self.rng.choice(TYPED))

    def fill(self, label, text):
        """Type into a field, if it is there, and does not go meanwhile with its model."""
        field = self.page.get_by_label(label, exact=True)
        if field.count() != 1:
            return
        try:
            field.fill(text, timeout=30_000)
            field.press("Enter", timeout=30_000)
        except playwright_timeout():
            assert field.count() == 0 or not field.is_enabled()

    def change_model(self):
        """Whatever is asked or being made."""
        self.tab.choose("model", self.rng.choice(MODELS))

    def type_a_huge_crowd(self):
        """With room for it, where the model has a size; then leave it, or make it and cancel."""
        if self.page.get_by_label("pedestrians", exact=True).count() != 1:
            return
        self.fill("size", self.rng.choice(("50", "2000")))
        self.fill("pedestrians", self.rng.choice(HUGE))
        # Asked, or refused at once; what is typed next withdraws the question.
        if self.is_there("Make it", 3.0) and self.rng.random() < 0.8:
            if self.rng.random() < 0.2:
                self.press("Leave it")
                return
            self.press("Make it")
            # Made, or refused for lack of room, before anybody could cancel.
            if self.is_there("Cancel", 3.0) and self.press("Cancel"):
                self.cancelled += 1

    def is_there(self, name, seconds):
        try:
            self.tab.button(name).wait_for(timeout=1000 * seconds)
        except playwright_timeout():
            return False
        return True

    def press(self, name):
        """Whether there was time to press it: it goes when a model is made."""
        try:
            self.tab.button(name).click(timeout=3000)
        except playwright_timeout():
            return False
        return True

    def switch(self):
        where = self.page.evaluate(SOMETHING, [".mm-switch input", self.rng.random()])
        if where:
            self.page.mouse.click(*where)

    def turn(self):
        name = self.rng.choice(("Simulation", "Simulation", "Mobility map"))
        self.page.get_by_role("tab", name=name).click()

    def look(self):
        """Nothing on the page may be the trace of an error of ours."""
        text = self.page.evaluate("() => document.body.innerText")
        assert not re.search(r"Traceback|\b[A-Z]\w*(Error|Exception):", text), text
        assert self.page.evaluate(f"() => Boolean({CANVAS}?.shown?.())")


@pytest.mark.slow
@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("seed", range(SEEDS))
def test_nothing_breaks_whatever_is_done_in_two_tabs(open_tab, model, seed):
    rng = random.Random(f"{model} {seed}")
    monkeys = []
    for _ in range(2):
        tab = open_tab()
        if model != "doorway":
            run = tab.shown()["run"]
            tab.choose("model", model)
            tab.wait(f"(run) => {SHOWN}.run > run", run)
        monkeys.append(Monkey(tab, rng))
    for number in range(ACTIONS):
        monkey = rng.choice(monkeys)
        monkey.act()
        if number % 20 == 19:
            monkey.look()
    for monkey in monkeys:
        monkey.look()
        trouble = monkey.tab.trouble
        trouble[:] = [line for line in trouble if line != TAKEN_AWAY]
    assert sum(monkey.checked for monkey in monkeys) > ACTIONS // 50
