"""Who may talk to a server on this machine: names, origins and tokens."""

from __future__ import annotations

import ipaddress
import os
import re
import secrets
import socket
from collections.abc import Iterable
from urllib.parse import parse_qsl, urlsplit

from mesa_mobility.errors import MobilityError

ANY_ADDRESS = ("0.0.0.0", "::")
"""Addresses that stand for all addresses of this machine."""

TOKEN = "token"
"""Where an address has the token."""

TOKEN_VARIABLE = "MESA_MOBILITY_TOKEN"

HEAD_SECONDS = 10.0
"""Time that a client has to send its request."""


class Names:
    """The names by which a server may be called.

    Other sites' names can be made to point at this machine, so a request by any other name is not
    meant for it.

    Args:
        host: address that the server listens on.
    """

    def __init__(self, host: str) -> None:
        self._names = names_of(host)
        self._any_address = not is_loopback(host)

    def are(self, host: str) -> bool:
        """Whether a request's ``Host``, with or without a port, is this server."""
        name = _name(host)
        # A name pointed at this machine would be in the Host, so a bare address is safe.
        return name in self._names or (self._any_address and _is_address(name))


def is_own_origin(origin: str, host: str) -> bool:
    """Whether a request's ``Origin`` is a page of the server that its ``Host`` names."""
    return origin.lower() in {f"http://{host}".lower(), f"https://{host}".lower()}


def is_loopback(host: str) -> bool:
    """Whether only this machine reaches a server that listens on ``host``."""
    try:
        return ipaddress.ip_address(host.partition("%")[0]).is_loopback
    except ValueError:
        return host.lower() == "localhost"


def names_of(host: str) -> frozenset[str]:
    """Names by which a server that listens on ``host`` may be called, in small letters."""
    names = {"localhost", "127.0.0.1", "::1", host.lower()}
    if not is_loopback(host):
        own = socket.gethostname().lower()
        names |= {own, f"{own}.local", socket.getfqdn().lower()}
    return frozenset(names - {"", *ANY_ADDRESS})


def address_of(host: str, port: int) -> str:
    """``name:port`` by which others reach a server that listens on ``host``."""
    # A server on all addresses is reached by the machine's name, not by that address.
    named = socket.gethostname() if host in ANY_ADDRESS else host
    return f"[{named}]:{port}" if ":" in named else f"{named}:{port}"


def own_token() -> str:
    """The token of a server: that of the environment, or a new one that cannot be guessed.

    It is no option of the command, since other users of a machine see those.

    Raises:
        MobilityError: one in the environment that is too short, or does not fit in an address.
    """
    given = os.environ.get(TOKEN_VARIABLE)
    if given is None:
        return secrets.token_urlsafe(24)
    if not re.fullmatch(r"[A-Za-z0-9._~-]{16,200}", given):
        raise MobilityError(
            f"{TOKEN_VARIABLE}: got {len(given)} characters, expected 16 to 200 letters, digits, "
            "'-', '_', '.' or '~'"
        )
    return given


def token_in(query: str, authorizations: Iterable[str]) -> str:
    """The token that a request gives in its address or as ``Authorization: Bearer``, or ""."""
    given = dict(parse_qsl(query)).get(TOKEN, "")
    for header in authorizations:
        given = given or header.removeprefix("Bearer ")
    return given


def same_token(given: str, expected: str) -> bool:
    """Whether two tokens are equal, in a time that does not tell how much of them is."""
    return secrets.compare_digest(given.encode(), expected.encode())


def listen(host: str, port: int) -> socket.socket:
    """A socket bound to an address; port 0 stands for any free one.

    Raises:
        MobilityError: the address cannot be listened on.
    """
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM
        )[0]
        listening = socket.socket(family, kind, protocol)
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind(address)
    except (OSError, UnicodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else None
        raise MobilityError(
            f"{host}:{port} cannot be listened on: {reason or error}; "
            "--host and --port choose another address"
        ) from error
    return listening


def _name(host: str) -> str:
    """The name in a ``Host``, without its port."""
    try:
        return (urlsplit(f"//{host}").hostname or "").rstrip(".")
    except ValueError:
        return ""


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
