"""Neither the page nor its server asks another host for anything."""

import pytest

from tests.dashboard.selectors import CANVAS, SHOWN

# Says each connection that the process opens, and each name that it looks up.
WATCHED = """
import ipaddress, sys

def here(host):
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host in (None, "localhost")

def watch(event, arguments):
    if event in ("socket.connect", "socket.sendto"):
        place = arguments[1]
        if isinstance(place, tuple) and not here(place[0]):
            print("leaves this machine:", place, file=sys.stderr, flush=True)
    elif event in ("socket.getaddrinfo", "socket.gethostbyname"):
        if not here(arguments[0]):
            print("looks up:", arguments[0], file=sys.stderr, flush=True)

sys.addaudithook(watch)
sys.argv[0] = "mesa-mobility"
from mesa_mobility._console_script import main
main()
"""


@pytest.mark.thorough
def test_no_connection_leaves_this_machine_while_all_of_the_page_is_used(start_dashboard, open_tab):
    watched = start_dashboard("doorway", python=("-c", WATCHED))
    tab = open_tab(watched.address)
    tab.button("three dimensions").click()
    tab.page.locator(".mm-bodies canvas").first.wait_for()
    tab.button("plan").click()
    tab.wait(f"() => {CANVAS}?.shown?.().drawn > 0")
    tab.step(2)
    tab.click_person(3)
    tab.page.get_by_role("tab", name="Mobility map").click()
    tab.page.locator(".mm-map").wait_for()
    tab.page.get_by_role("tab", name="Saved run").click()
    tab.page.wait_for_timeout(1000)
    tab.page.get_by_role("tab", name="Simulation").click()
    tab.choose("model", "straight_walk")
    tab.wait(f"() => {SHOWN}.inside === 50")
    tab.page.reload()
    tab.wait(f"() => {SHOWN.replace(').', ')?.')}?.inside === 50")
    library = "/_solara/cdn/@widgetti/vue3-something"
    answered = tab.page.expect_response(f"**{library}")
    noted = tab.page.expect_console_message(lambda message: "404" in message.text)
    with answered, noted:
        assert tab.page.evaluate(f"async () => (await fetch('{library}')).status") == 404
    # The browser notes the answer twice; nothing else has happened.
    assert len(tab.trouble) == 2
    assert all("404" in line for line in tab.trouble)
    tab.trouble.clear()
    assert [line for line in watched.lines if "open http://127.0.0.1" not in line] == []
