"""Who may talk to a server on this machine: names, origins and tokens."""

from __future__ import annotations

import ipaddress
import secrets
import socket
from urllib.parse import urlsplit

from mesa_mobility.errors import MobilityError

ANY_ADDRESS = ("0.0.0.0", "::")
"""Addresses that stand for all addresses of this machine."""


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


def new_token() -> str:
    """A token that cannot be guessed."""
    return secrets.token_urlsafe(24)


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
