"""Writes docs/command_line.md from the commands' help: ``python -m tools.command_line_page``."""

from __future__ import annotations

import os
from pathlib import Path

from nep_core.cli import COMMANDS, overview, parser_of

COLUMNS = "80"
"""How wide the help is on the page."""
PAGE = Path(__file__).resolve().parents[1] / "docs" / "command_line.md"

START = """\
# The command line `nep`

For robot developers: look into a running network, take part in it, record and play what is sent.
This page is what `nep` and `nep COMMAND --help` say; `python -m tools.command_line_page` writes it.

```
{overview}
```

All commands find the master by `--master`, else by the variable `NEP_MASTER`, else at port 7100
of this computer. What a person reads goes to the output, remarks and errors to the error output.
Ctrl-C ends every command quietly, with exit code 0. A reader that has seen enough (`| head -1`)
does too.
"""

END = """\
## What is in a recording

An MCAP file with a channel for each topic, node and encoding. JSON messages lie in it as they
were sent, with a JSON schema where NEP knows the topic's struct; a text is `{"text": ...}`;
MessagePack and bytes are kept as they are, without a schema. The log time is when a message
arrived, the publish time when its sender sent it, by the sender's clock. Chunks are closed twice
a second: of a recording that ended by a power cut everything but the last chunk can be read.

From Python:

```python
from nep_core.recordings.file import read_recording

for message in read_recording("walk.mcap"):
    print(message.topic, message.arrived_ns, message.node, message.encoding, message.payload)
```

`Recorder` and `Player` in `nep_core.recordings.recorder` do what the two commands do.
"""


def page() -> str:
    """The whole page."""
    os.environ["COLUMNS"] = COLUMNS
    parts = [START.replace("{overview}", overview())]
    for name in COMMANDS:
        parts.append(f"## nep {name}\n\n```\n{parser_of(name).format_help()}```\n")
    return "\n".join([*parts, END])


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
