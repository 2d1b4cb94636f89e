"""What runs on the hosts of the tests: a node that publishes, and one that sees all."""

import json
import sys

from nep_core.cli import main
from nep_core.processes.node import Node
from nep_core.wire.messages import NODE_STATE, NodeState


def watch() -> None:
    with Node("watch", "sensory") as node:
        node.stop_on_signals()
        publisher = node.publisher("/steps")
        node.ready()
        count = 0
        while not node.wait(0.05):
            count += 1
            publisher.send({"count": count})


def witness() -> None:
    """Prints the first message of /steps, and every warning."""
    with Node("witness", "cognitive") as node:
        states = node.subscriber(NODE_STATE, NodeState)
        steps = node.subscriber("/steps")
        print("ready", flush=True)
        print(json.dumps(steps.receive(20.0)), flush=True)
        for state in states:
            if state.event == "warning":
                print(f"{state.node}: {state.description}", flush=True)


if __name__ == "__main__":
    programs = {"watch": watch, "witness": witness}
    if sys.argv[1] in programs:
        programs[sys.argv[1]]()
    else:
        sys.exit(main(sys.argv[1:]))
