"""A master in a process of its own: ``ENDPOINT``; it ends when its standard input does."""

from __future__ import annotations

import sys

from nep_core.networks.master import Master

if __name__ == "__main__":
    master = Master(sys.argv[1])
    print(master.endpoint, flush=True)
    sys.stdin.read()
    master.close()
