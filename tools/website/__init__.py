"""The documentation as a web site: plain files that need no server, no script and no network."""
