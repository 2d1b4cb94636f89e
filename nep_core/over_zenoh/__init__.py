"""A network over zenoh: the same publishers and subscribers, across several sites."""
