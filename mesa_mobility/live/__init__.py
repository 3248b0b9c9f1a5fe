"""A running model that other programs watch and command: frames and commands over a WebSocket.

Only the server needs the extra ``live``.
"""
