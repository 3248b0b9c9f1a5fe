"""What is typed or slid stays, whatever a slow server says meanwhile."""

import signal
from contextlib import contextmanager

import pytest

from tests.dashboard.selectors import SHOWN


@contextmanager
def standing_still(tab):
    """The server does nothing meanwhile, as on a machine that is busy with something else."""
    tab.server.process.send_signal(signal.SIGSTOP)
    try:
        yield
    finally:
        tab.server.process.send_signal(signal.SIGCONT)


def slide(tab, label, keys):
    slider = tab.page.get_by_role("slider", name=f"{label}, slider")
    slider.focus()
    for key in keys:
        slider.press(key)


@pytest.mark.thorough
def test_a_late_answer_to_a_slider_leaves_the_number_that_is_typed(tab):
    field = tab.page.get_by_label("pedestrians", exact=True)
    with standing_still(tab):
        slide(tab, "pedestrians", ["ArrowRight"] * 5)
        field.focus()
        field.press("Control+a")
        field.press("3")
    tab.wait(f"() => {SHOWN}.inside === 65")
    tab.page.wait_for_timeout(500)  # for everything that the server has said of it
    field.press("4")
    field.press("Enter")
    tab.wait(f"() => {SHOWN}.inside === 34")
    assert field.input_value() == "34"
    # A text that is only marked is not exchanged either: what is typed next replaces it.
    with standing_still(tab):
        slide(tab, "pedestrians", ["ArrowRight"])
        field.focus()
        field.press("Control+a")
    tab.wait(f"() => {SHOWN}.inside === 35")
    tab.page.wait_for_timeout(500)
    field.press("2")
    field.press("1")
    field.press("Enter")
    tab.wait(f"() => {SHOWN}.inside === 21")
    assert field.input_value() == "21"


@pytest.mark.thorough
def test_fields_show_what_the_server_says_once_they_are_left(tab):
    field = tab.page.get_by_label("pedestrians", exact=True)
    slide(tab, "pedestrians", ["ArrowRight", "ArrowRight"])
    field.focus()
    tab.wait(f"() => {SHOWN}.inside === 62")
    field.blur()
    tab.expect(field).to_have_value("62")
    tab.expect(tab.page.get_by_role("slider", name="pedestrians, slider")).to_have_value("62")
