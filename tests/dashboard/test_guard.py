"""Who gets an answer from the dashboard's server, asked over HTTP and WebSockets as they are."""

import base64
import http.client
import os
import re
import socket
from urllib.parse import parse_qs, urlsplit

import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")

from mesa_mobility.dashboard.guard import Guard
from mesa_mobility.live.access import is_loopback


def ask(port, path="/", *, method="GET", **headers):
    """Status, headers and text of an answer."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, headers={"Host": f"localhost:{port}", **named})
    answer = connection.getresponse()
    text = answer.read().decode("utf-8", "replace")
    connection.close()
    return answer.status, dict((n.lower(), v) for n, v in answer.getheaders()), text


def open_socket(port, **headers):
    """The status line of the answer to a WebSocket's handshake."""
    key = base64.b64encode(os.urandom(16)).decode()
    lines = [
        "GET /jupyter/api/kernels/k-1/channels?session_id=s-1 HTTP/1.1",
        "Connection: Upgrade",
        "Upgrade: websocket",
        "Sec-WebSocket-Version: 13",
        f"Sec-WebSocket-Key: {key}",
    ]
    given = {"Host": f"localhost:{port}", **headers}
    lines += [f"{name}: {value}" for name, value in given.items()]
    with socket.create_connection(("127.0.0.1", port), timeout=60) as connection:
        connection.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        return connection.recv(4096).decode("latin-1").partition("\r\n")[0]


def port_of(server):
    return urlsplit(server.address).port


@pytest.fixture(scope="module")
def local(start_dashboard):
    """A dashboard that this machine alone reaches."""
    return port_of(start_dashboard("doorway"))


@pytest.fixture(scope="module")
def network(start_dashboard):
    """A dashboard on all addresses of the machine."""
    return start_dashboard("doorway", "--host", "0.0.0.0")


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
    ["http://evil.example", "https://evil.example:{0}", "null", "http://localhost:1", "file://",
     "http://localhost.evil.example:{0}", "http://[", "http://127.0.0.1:{0}"],
)  # fmt: skip
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


def test_on_a_network_nothing_is_answered_without_the_token(network):
    port = port_of(network)
    for path in ("/", "/readyz", "/?token=", "/?token=x", "/static/main-vuetify.js"):
        status, headers, text = ask(port, path)
        assert (status, text) == (403, "open the address that the command has printed\n")
        assert "set-cookie" not in headers
    assert ask(port, Cookie=f"mesa-mobility-{port}=x")[0] == 403
    assert " 403 " in open_socket(port, Origin=f"http://localhost:{port}") + " "


def test_the_token_is_exchanged_for_a_cookie_and_leaves_the_address(network):
    port, query = port_of(network), urlsplit(network.address).query
    status, headers, _ = ask(port, f"/?set.rng=7&{query}")
    assert status == 303
    assert headers["location"] == "/?set.rng=7"
    cookie = headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=Lax" in cookie
    kept = cookie.partition(";")[0]
    assert ask(port, "/?set.rng=7", Cookie=kept)[0] == 200
    here = f"http://localhost:{port}"
    assert " 101 " in open_socket(port, Origin=here, Cookie=kept) + " "
    assert " 403 " in open_socket(port, Origin="http://evil.example", Cookie=kept) + " "
    assert ask(port, Cookie=kept, Host="evil.example")[0] == 403
    assert ask(port, Cookie=kept, Host=f"10.1.2.3:{port}")[0] == 200


@pytest.mark.parametrize("path", ["//evil.example/", "/\\evil.example/", "/%0d%0aX-Y:%20z/"])
def test_the_way_without_the_token_stays_on_this_server(network, path):
    _, headers, _ = ask(port_of(network), f"{path}?{urlsplit(network.address).query}")
    assert re.match(r"/[^/\\]", headers.get("location", "/x"))
    assert "x-y" not in headers


@pytest.mark.parametrize(
    ("host", "expected"),
    [("127.0.0.1", True), ("127.0.0.9", True), ("::1", True), ("localhost", True),
     ("0.0.0.0", False), ("::", False), ("192.168.1.5", False), ("myhost", False)],
)  # fmt: skip
def test_which_addresses_only_this_machine_reaches(host, expected):
    assert is_loopback(host) is expected


@pytest.mark.thorough
@given(st.text(max_size=40), st.text(max_size=40))
def test_whatever_host_and_origin_are_only_this_machine_is_answered(host, origin):
    """No text leads to an error, and none but the machine's own names is let through."""
    guard = Guard(None, "127.0.0.1", 8765)
    headers = {"host": host, "origin": origin}
    refused = guard._refusal({"type": "websocket"}, headers)
    own = re.fullmatch(r"(.*@)?(localhost|127\.0\.0\.1|\[::1\])\.?(:\d*)?", host.lower())
    assert refused or own
