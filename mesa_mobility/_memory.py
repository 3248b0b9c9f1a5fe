"""A limit to the memory of a process that reads what may be damaged."""

import os


def limit_memory(most: int) -> None:
    """Let this process have so many bytes, where the system can."""
    if os.name == "posix":
        import resource

        resource.setrlimit(resource.RLIMIT_DATA, (most, most))
