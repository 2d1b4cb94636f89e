"""The address of a phone that a person typed or copied."""

from __future__ import annotations

import re

from nep_core.errors import ParameterError

_ADDRESS = re.compile(r"(?:[a-z]+://)?([a-z0-9.-]+|\[[0-9a-f:.%]+\])(?::(\d{1,5}))?(?:/.*)?", re.I)


def phone_address(text: str, port: int, app: str) -> tuple[str, int]:
    """Host and port of "192.168.1.20", "192.168.1.20:8080" or "http://192.168.1.20:8080/".

    ``port`` is taken where the text has none. Raises ParameterError for anything else.
    """
    found = _ADDRESS.fullmatch(text.strip())
    if found is None or (found[2] and not 1 <= int(found[2]) <= 65_535):
        raise ParameterError(
            f"“{text}” is not the address of a phone."
            if text.strip()
            else f"The address that {app} shows on the phone is missing.",
            checklist=(
                f"Switch on the remote access or the server in {app}: it shows the address.",
                "Write it into “address”, such as 192.168.1.20:8080.",
                "Is the phone in the same wireless network as this computer?",
            ),
        )
    return found[1], int(found[2] or port)
