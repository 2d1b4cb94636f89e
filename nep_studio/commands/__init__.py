"""The jobs of ``nep-studio`` that need no window."""
