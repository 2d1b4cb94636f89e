"""The node panel: a card for each node, its log, and what is told when one comes to grief."""
