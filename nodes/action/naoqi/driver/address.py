"""Where a NAOqi robot is found: the host and port that a person wrote."""

from __future__ import annotations

from nep_core.errors import ParameterError

NAOQI_PORT = 9559
TLS_PORT = 9503

Address = tuple[str, int]


def read_address(text: str) -> Address:
    """Return host and port of text such as ``192.168.1.10``, ``nao.local`` or ``host:9559``.

    Raises ParameterError.
    """
    host, colon, port = text.strip().rpartition(":")
    if not colon:
        host, port = text.strip(), str(NAOQI_PORT)
    # int() would also take "1_0" and signs; str.isdigit() alone would take "²".
    is_number = port.isascii() and port.isdigit()
    if not host or any(c.isspace() or c in ":/" for c in host) or not is_number:
        raise _not_an_address(text)
    if not 0 < int(port) < 65536:
        raise _not_an_address(text)
    return host, int(port)


def plain_address(address: Address) -> str:
    """Return an address as a person writes it: the usual port is left out."""
    host, port = address
    return host if port == NAOQI_PORT else f"{host}:{port}"


def _not_an_address(text: str) -> ParameterError:
    return ParameterError(
        f'"{text}" is not the address of a robot.',
        checklist=(
            "Press NAO's chest button once: it says its address, such as 192.168.1.10.",
            "Write it in the robot's address.",
            "Or set the robot's driver to virtual: then it needs no address.",
        ),
    )
