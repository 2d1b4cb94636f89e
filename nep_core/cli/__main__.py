"""``python -m nep_core.cli``: the command ``nep`` where no script of that name is installed."""

import sys

from nep_core.cli import main

sys.exit(main())
