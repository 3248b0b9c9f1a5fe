"""Who gets an answer from the dashboard's server, asked over HTTP and WebSockets as they are."""

import asyncio
import base64
import contextlib
import http.client
import os
import re
import socket
import time
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")

from mesa_mobility.dashboard.serving.guard import Guard
from mesa_mobility.live.access import is_loopback

TOKEN = "the-token_of.these~tests"
CDN = "/_solara/cdn/"
KNOWN = {"Authorization": f"Bearer {TOKEN}"}


def ask(port, path="/", *, method="GET", known=True, **headers):
    """Status, headers and text of an answer; with the token if the client is known."""
    headers |= KNOWN if known else {}
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, headers={"Host": f"localhost:{port}", **named})
    answer = connection.getresponse()
    text = answer.read().decode("utf-8", "replace")
    connection.close()
    return answer.status, dict((n.lower(), v) for n, v in answer.getheaders()), text


def open_socket(port, *, known=True, **headers):
    """The status line of the answer to a WebSocket's handshake."""
    key = base64.b64encode(os.urandom(16)).decode()
    lines = [
        "GET /jupyter/api/kernels/k-1/channels?session_id=s-1 HTTP/1.1",
        "Connection: Upgrade",
        "Upgrade: websocket",
        "Sec-WebSocket-Version: 13",
        f"Sec-WebSocket-Key: {key}",
    ]
    given = {"Host": f"localhost:{port}", **(KNOWN if known else {}), **headers}
    lines += [f"{name}: {value}" for name, value in given.items()]
    with socket.create_connection(("127.0.0.1", port), timeout=60) as connection:
        connection.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        return connection.recv(4096).decode("latin-1").partition("\r\n")[0]


def port_of(server):
    return urlsplit(server.address).port


@pytest.fixture(scope="module")
def local(start_dashboard):
    """The port of a dashboard that this machine alone reaches, with the token of these tests."""
    given = {**os.environ, "MESA_MOBILITY_TOKEN": TOKEN}
    return port_of(start_dashboard("doorway", env=given))


@pytest.fixture(scope="module")
def network(start_dashboard):
    """A dashboard on all addresses of the machine, with a token of its own."""
    return start_dashboard("doorway", "--host", "0.0.0.0")


@pytest.fixture(scope="module", params=["127.0.0.1", "0.0.0.0"])
def anywhere(request, network, start_dashboard):
    """A dashboard with a token of its own, wherever it listens."""
    return network if request.param == "0.0.0.0" else start_dashboard("doorway")


@pytest.mark.parametrize("host", ["localhost:{0}", "127.0.0.1:{0}", "[::1]:{0}", "localhost:9999"])
def test_this_machine_gets_the_page_by_its_own_names(local, host):
    assert ask(local, Host=host.format(local))[0] == 200


@pytest.mark.parametrize(
    "host",
    ["evil.example", "evil.example:{0}", "192.168.1.5:{0}", "localhost.evil.example:{0}", "", "["],
)
@pytest.mark.parametrize("path", ["/", "/readyz", "/resourcez", "/static/main-vuetify.js"])
def test_another_name_gets_nothing(local, host, path):
    status, _, text = ask(local, path, Host=host.format(local))
    assert status == 403
    assert text == "this server is not known by that name\n"


@pytest.mark.parametrize(
    "origin",
    [
        "http://evil.example",
        "https://evil.example:{0}",
        "null",
        "http://localhost:1",
        "file://",
        "http://localhost.evil.example:{0}",
        "http://[",
        "http://127.0.0.1:{0}",
    ],
)
def test_a_page_of_another_site_gets_neither_page_nor_socket(local, origin):
    origin = origin.format(local)
    assert ask(local, Origin=origin)[0] == 403
    assert " 403 " in open_socket(local, Origin=origin) + " "


def test_a_socket_tells_where_it_comes_from(local):
    assert " 403 " in open_socket(local) + " "
    assert " 101 " in open_socket(local, Origin=f"http://localhost:{local}") + " "


def test_only_its_own_page_changes_something(local):
    path = "/_solara/api/close/k-2?session_id=s-2"
    assert ask(local, path, method="POST")[0] == 403
    assert ask(local, path, method="POST", Origin="http://evil.example")[0] == 403
    assert ask(local, path, method="POST", Origin=f"http://localhost:{local}")[0] == 200


@pytest.mark.parametrize("path", ["/", "/readyz", "/static/main-vuetify.js", "/nowhere/at/all"])
def test_no_page_may_frame_it_and_it_asks_no_other_host(local, path):
    _, headers, _ = ask(local, path)
    assert headers["x-frame-options"] == "DENY"
    policy = headers["content-security-policy"]
    assert "frame-ancestors 'none'" in policy
    assert "default-src 'self'" in policy
    assert "http" not in policy


@pytest.mark.thorough
def test_on_a_network_it_warns_and_tells_a_token(network):
    said = "".join(network.lines)
    assert "warning: 0.0.0.0 is reached from the network" in said
    (token,) = parse_qs(urlsplit(network.address).query)["token"]
    assert len(token) >= 32


NO_TOKEN = (
    "open the whole address that `mesa-mobility dashboard` has printed where it was started: "
    "it ends with the token\n"
)


@pytest.mark.parametrize(
    "path",
    [
        "/",
        "/readyz",
        "/?token=",
        "/?token=x",
        "/static/main-vuetify.js",
        "/nowhere",
        f"{CDN}requirejs@2.3.6/require.js",
    ],
)
def test_nothing_is_answered_without_the_token(anywhere, path):
    port = port_of(anywhere)
    for told in ({}, {"Cookie": f"mesa-mobility-{port}=x"}, {"Authorization": f"Bearer {TOKEN}"}):
        status, headers, text = ask(port, path, known=False, **told)
        assert (status, text) == (403, NO_TOKEN)
        assert "set-cookie" not in headers


def test_no_socket_is_opened_without_the_token(anywhere):
    port = port_of(anywhere)
    here = f"http://localhost:{port}"
    assert " 403 " in open_socket(port, known=False, Origin=here) + " "
    wrong = {"Origin": here, "Cookie": f"mesa-mobility-{port}=x"}
    assert " 403 " in open_socket(port, known=False, **wrong) + " "


def test_the_token_is_exchanged_for_a_cookie_and_leaves_the_address(network):
    port, query = port_of(network), urlsplit(network.address).query
    status, headers, _ = ask(port, f"/?set.rng=7&{query}", known=False)
    assert status == 303
    assert headers["location"] == "/?set.rng=7"
    cookie = headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=Strict" in cookie
    kept = cookie.partition(";")[0]
    assert ask(port, "/?set.rng=7", known=False, Cookie=kept)[0] == 200
    here = f"http://localhost:{port}"
    assert " 101 " in open_socket(port, known=False, Origin=here, Cookie=kept) + " "
    evil = "http://evil.example"
    assert " 403 " in open_socket(port, known=False, Origin=evil, Cookie=kept) + " "
    assert ask(port, known=False, Cookie=kept, Host="evil.example")[0] == 403
    assert ask(port, known=False, Cookie=kept, Host=f"10.1.2.3:{port}")[0] == 200
    # Somebody who opens the printed address again does not keep the token in view.
    assert ask(port, f"/?{query}", known=False, Cookie=kept)[0] == 303


@pytest.mark.parametrize("path", ["//evil.example/", "/\\evil.example/", "/%0d%0aX-Y:%20z/"])
def test_the_way_without_the_token_stays_on_this_server(network, path):
    _, headers, _ = ask(port_of(network), f"{path}?{urlsplit(network.address).query}", known=False)
    assert re.match(r"/[^/\\]", headers.get("location", "/x"))
    assert "x-y" not in headers


@pytest.mark.parametrize(
    "path",
    [
        "/readyz",
        "/resourcez",
        "/nowhere",
        "/nowhere/at/all",
        "/jupyter/api/kernels/k-1",
        "/static",
        "/_solara/api/evict/k-1",
        f"{CDN}@widgetti/vue3-something",
        f"{CDN}requirejs@2.3.6",
        f"{CDN}@widgetti/solara-vuetify-app@10.1.1/dist",
        f"{CDN}../cdn/requirejs@2.3.6/require.js",
        f"{CDN}requirejs@2.3.6/%2e%2e/%2e%2e/%2e%2e/%2e%2e/pyvenv.cfg",
        f"{CDN}",
        f"{CDN}/etc/passwd",
        f"{CDN}requirejs@2.3.6/%00",
        f"{CDN}requirejs@2.3.6/{'x' * 5000}",
    ],
)
@pytest.mark.parametrize("method", ["GET", "HEAD", "POST", "PUT"])
def test_what_the_page_does_not_need_is_not_found(local, path, method):
    status, headers, text = ask(local, path, method=method, Origin=f"http://localhost:{local}")
    assert status == 404
    assert headers["x-frame-options"] == "DENY"
    assert text in ("there is no such page\n", "")


def test_libraries_that_are_on_this_machine_are_found(local):
    status, _, text = ask(local, f"{CDN}requirejs@2.3.6/require.js")
    assert status == 200
    assert "requirejs" in text
    # The folder that was asked for above is still there.
    assert ask(local, f"{CDN}@widgetti/solara-vuetify-app@10.1.1/dist/fonts.css")[0] == 200


def test_the_framework_is_not_asked_for_libraries_that_are_not_here(tmp_path):
    """It would fetch them, and it deletes folders."""
    asked = []

    async def app(scope, receive, send):
        asked.append(scope["path"])

    async def send(message):
        answers.append(message.get("status"))

    (tmp_path / "lib@1.0.0").mkdir()
    (tmp_path / "lib@1.0.0" / "main.js").touch()
    (tmp_path / "secret").touch()
    guard = Guard(app, "127.0.0.1", 8765, TOKEN, tmp_path / "lib@1.0.0")
    headers = [(b"host", b"localhost"), (b"authorization", f"Bearer {TOKEN}".encode())]
    for path in ("main.js", "lib/main.js", "../secret", "x/../../secret", "..\\secret", "", "."):
        answers = []
        scope = {
            "type": "http",
            "method": "GET",
            "path": CDN + path,
            "query_string": b"",
            "headers": headers,
        }
        asyncio.run(guard(scope, None, send))
        assert answers[:1] == [404]
    guard = Guard(app, "127.0.0.1", 8765, TOKEN, tmp_path)
    asyncio.run(guard({**scope, "path": f"{CDN}lib@1.0.0/main.js"}, None, send))
    assert asked == [f"{CDN}lib@1.0.0/main.js"]


def held_back(port, sent):
    """A connection that has sent something, and no whole request since."""
    connection = socket.create_connection(("127.0.0.1", port), timeout=60)
    connection.sendall(sent)
    return connection


WHOLE = b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"
"""Refused, since the token is missing; the connection stays open for the next one."""


@pytest.mark.thorough
def test_250_connections_that_hold_back_their_request_are_closed_and_the_page_is_served(local):
    began = time.monotonic()
    sent = (b"", b"G", b"GET / HTTP/1.1\r\nHost: localhost\r\nX: ", WHOLE + b"GET /")
    held = [held_back(local, sent[k % len(sent)]) for k in range(250)]
    while time.monotonic() < began + 8.0:
        assert ask(local)[0] == 200
        for connection in held:
            with contextlib.suppress(OSError):
                connection.send(b"x", socket.MSG_DONTWAIT)
        time.sleep(0.5)
    for connection in held:
        connection.settimeout(max(began + 15.0 - time.monotonic(), 0.01))
        with contextlib.suppress(ConnectionError):
            while connection.recv(4096):
                pass
        connection.close()
    assert time.monotonic() < began + 15.0


@pytest.mark.parametrize(
    ("host", "expected"),
    [
        ("127.0.0.1", True),
        ("127.0.0.9", True),
        ("::1", True),
        ("localhost", True),
        ("0.0.0.0", False),
        ("::", False),
        ("192.168.1.5", False),
        ("myhost", False),
    ],
)
def test_which_addresses_only_this_machine_reaches(host, expected):
    assert is_loopback(host) is expected


@pytest.mark.thorough
@given(st.text(max_size=40), st.text(max_size=40))
def test_whatever_host_and_origin_are_only_this_machine_is_answered(host, origin):
    """No text leads to an error, and none but the machine's own names is let through."""
    guard = Guard(None, "127.0.0.1", 8765, TOKEN, Path())
    headers = {"host": host, "origin": origin}
    refused = guard._refusal({"type": "websocket"}, headers)
    own = re.fullmatch(r"(.*@)?(localhost|127\.0\.0\.1|\[::1\])\.?(:\d*)?", host.lower())
    assert refused or own
