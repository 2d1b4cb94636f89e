"""What ``nep`` and ``nep COMMAND --help`` teach: a sentence, examples that work, what comes next.

A test runs every example, and another one compares docs/command_line.md with all this.
"""

from __future__ import annotations

from dataclasses import dataclass

FIRST_STEPS = """\
First steps
  nep doctor                                  is this computer ready?
  nep master                                  in a terminal of its own: the name server
  nep launch sensory virtual_watch            in another one: a watch that moves by itself
  nep topics                                  in a third one: what is there now
  nep echo /imu --count 1                     and what it says

nep COMMAND --help tells more, with examples."""

EXIT_CODES = "Exit code: 0 it is done, 1 it could not be done (the sentence says why), 2 wrong use."


@dataclass(frozen=True)
class Lesson:
    """The help of a command: what it does, examples with what each is for, what to do next."""

    text: str
    examples: tuple[tuple[str, str], ...]
    next: str

    @property
    def epilog(self) -> str:
        """What stands below the options."""
        shown = "\n".join(f"  {line}\n      {why}" for line, why in self.examples)
        return f"Examples\n{shown}\n\nNext: {self.next}"


LESSONS = {
    "master": Lesson(
        "Run the NEP Master: it knows which node publishes and hears what, and where. Messages "
        "never go\nthrough it; when it ends the nodes go on, and it finds them again.",
        (("nep master", "serve at NEP_MASTER, else at port 7100 of this computer"),),
        "start a node in another terminal, such as: nep launch sensory virtual_watch",
    ),
    "broker": Lesson(
        "Run the central service of a broker network, through which all messages go. The usual\n"
        "network (p2p) needs a master instead.",
        (("nep broker", "serve at NEP_BROKER, else at ports 7110 to 7112 of this computer"),),
        "let nodes use it: NEP_NETWORK=broker before the command that starts them.",
    ),
    "launch": Lesson(
        "Start a node by its type and name, show how it is doing, and keep it running until "
        "Ctrl-C.\nOne that crashes is started again, at most five times in a row.",
        (
            ("nep launch sensory virtual_watch", "start the watch that moves by itself"),
            ("nep launch sensory virtual_watch --name left", "under another name"),
            ("nep launch sensory virtual_watch rate_hz=100", "with a setting of its manifest"),
        ),
        "see what it publishes: nep topics",
    ),
    "kill": Lesson(
        "Ask a node to stop through the master, and wait until it is gone. With --force the "
        "process of\na node that does not stop is ended; only on this computer, and only when "
        "the process still is\nthat node. Other nodes of the same process end with it, and a "
        "launcher that watches over it\nstarts it again.",
        (
            ("nep kill virtual_watch", "ask, and wait 3 s at most"),
            ("nep kill virtual_watch --force", "end it when it does not stop"),
        ),
        "look whether it is gone: nep nodes",
    ),
    "topics": Lesson(
        "List the topics: the struct of their messages where NEP knows it, who publishes, who "
        "hears.",
        (
            ("nep topics", "all topics"),
            ("nep topics --rates", "listen for a second, and tell how often messages come"),
            ("nep topics --json", "for another program"),
        ),
        "read one of them: nep echo TOPIC",
    ),
    "nodes": Lesson(
        "List the nodes: how each is doing, its type, its process and computer, for how many "
        "seconds it\nhas run, and how long ago it last told its state. A program that is no node "
        "has no state.",
        (("nep nodes", "all nodes"), ("nep nodes --json", "for another program")),
        "see how they are connected: nep graph",
    ),
    "graph": Lesson(
        "Show who is connected with whom. /node_state, which every node publishes, is left out "
        "unless\n--all is given.",
        (
            ("nep graph", "as text"),
            ("nep graph --rates", "with messages a second"),
            ("nep graph --dot", "for Graphviz: nep graph --dot | dot -Tsvg > graph.svg"),
        ),
        "look closer at a topic: nep hz TOPIC",
    ),
    "doctor": Lesson(
        "Check this computer: versions, ports, firewall, clock, permissions, NEP_ variables, "
        "nodes'\nmanifests, room on the disk. Each line is ok, or says what to look at and what "
        "to do.",
        (
            ("nep doctor", "check everything"),
            ("nep doctor --json", "for another program"),
            ("nep doctor --robot 127.0.0.1", "also whether a NAO answers at an address"),
        ),
        "do the steps that it lists, then run it again.",
    ),
    "echo": Lesson(
        "Print each message of a topic on a line: JSON and MessagePack as JSON, text as it is, "
        "bytes as\ntheir first numbers. Lost messages are told on the error output.",
        (
            ("nep echo /human_behavior --count 1", "the next message"),
            ("nep echo /imu --field acc.0 --count 10", "one part of each of ten messages"),
            ("nep echo /node_state --times --pretty --count 1", "with its sender, on many lines"),
        ),
        "how often do they come: nep hz TOPIC; keep them: nep record FILE TOPIC",
    ),
    "hz": Lesson(
        "Tell once a second how many messages of a topic come (of the last 10 s): rate in Hz, "
        "shortest\nand longest gap and jitter (their standard deviation) in ms, bytes a second, "
        "lost messages.",
        (
            ("nep hz /imu", "until Ctrl-C"),
            ("nep hz /imu --seconds 1 --json", "for one second, for another program"),
        ),
        "see the messages: nep echo TOPIC",
    ),
    "send": Lesson(
        "Send a message. On topics that NEP knows it is checked first, and the key that is wrong "
        "is\nnamed. What is no JSON needs --text.",
        (
            ('nep send /human_behavior \'{"human_state": "happy"}\'', "one message"),
            ("nep send /chat --text 'Good morning' --wait 0", "a text, waiting for nobody"),
            ("nep send /speed '{\"m_s\": 0.5}' --rate 20 --count 5", "five, 20 in a second"),
            ("nep send /speed -", "each line of the standard input is a message"),
        ),
        "see who hears the topic: nep topics",
    ),
    "record": Lesson(
        "Record topics into an MCAP file, all of them when none is named, also those that appear "
        "later.\nFoxglove and PlotJuggler open the file. At most the last second is lost when the "
        "power fails.\nNamed topics are heard from their first message on; a new one that is "
        "found by itself may lose\nits first ones.",
        (
            ("nep record walk.mcap", "everything, until Ctrl-C"),
            ("nep record watch.mcap /imu --seconds 1", "one topic, for one second"),
            ("nep record walk.mcap --without /robot_state --force", "replace an older file"),
        ),
        "play it: nep play FILE",
    ),
    "play": Lesson(
        "Play a recording: the same bytes go out on the same topics, at the same times. What "
        "nodes told\nabout themselves (/node_state) is not played, because they do not run; "
        "--node-states plays it.\nCommands are: /action_request moves robots again.",
        (
            ("nep play walk.mcap", "all of it"),
            ("nep play walk.mcap --info", "only tell what is in it"),
            ("nep play walk.mcap --topics /imu --speed 2", "one topic, twice as fast"),
            ("nep play walk.mcap --from 0.1 --to 0.3 --prefix /old", "a part, as /old/imu ..."),
        ),
        "watch it: nep echo TOPIC, or nep hz TOPIC",
    ),
}
