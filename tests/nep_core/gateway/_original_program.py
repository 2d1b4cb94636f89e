"""A program that uses the original's package as its users do; the test says which topics.

It publishes again and again, prints what it hears, and ends when its input ends.
"""

from __future__ import annotations

import base64
import json
import os
import sys
import threading
import time

import nep

JPEG = b"\xff\xd8 a picture"


def tell(**news: object) -> None:
    sys.stdout.write("\n@" + json.dumps(news) + "\n")
    sys.stdout.flush()


def plain(message: object) -> object:
    return {"bytes": message.decode("latin-1")} if isinstance(message, bytes) else message


def publish(publisher: nep.publisher, kind: str, message: object) -> None:
    if kind == "images":  # as its publish() does, but without OpenCV
        publisher.sock.send(base64.b64encode(JPEG))
    elif kind == "bytes":
        publisher.publish(str(message).encode())
    else:
        publisher.publish(message)


def take_part(node: nep.node, part: dict[str, object]) -> None:
    topic, kind, mode = str(part["topic"]), str(part["kind"]), str(part["mode"])
    configuration = node.hybrid("127.0.0.1", mode)
    if "says" in part:
        publisher = node.new_pub(topic, kind, configuration)
        while True:
            publish(publisher, kind, part["says"])
            time.sleep(0.03)
    subscriber = node.new_sub(topic, kind, configuration)
    last = None
    while True:
        is_there, message = subscriber.read() if kind == "images" else subscriber.listen()
        if is_there and message != last:
            tell(topic=topic, heard=plain(message))
            last = message
        time.sleep(0.005)


def serve(node: nep.node, name: str) -> None:
    server = node.new_server(name)
    while True:
        server.send_info({"sum": sum(server.listen_info()["add"])})


def ask(node: nep.node, name: str) -> None:
    client = node.new_client(name)
    client.send_info({"add": [1, 2, 3]})
    tell(topic=name, heard=client.listen_info())


def main() -> None:
    name, parts = sys.argv[1], json.loads(sys.argv[2])
    node = nep.node(name)
    for part in parts:
        work = {"server": serve, "client": ask}.get(part["kind"], take_part)
        told = part if work is take_part else part["topic"]
        threading.Thread(target=work, args=(node, told), daemon=True).start()
    sys.stdin.read()
    os._exit(0)  # theirs would sleep before it ends


main()
