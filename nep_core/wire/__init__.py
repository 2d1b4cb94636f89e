"""The wire: messages, frames, and the two ends of a topic; no name server, no node.

Enters what turns messages into frames and back, and the sockets of one publisher or subscriber.
Who finds whom is the business of ``networks``.
"""
