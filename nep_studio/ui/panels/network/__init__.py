"""The network view: nodes and topics as a live graph, and the messages of each topic."""
