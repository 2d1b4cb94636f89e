"""What the help says, read from files: texts, how-to pages, examples, and an index of them.

Enters what finds and reads ``resources/help`` in a language, with English where that lacks. No
widget and no HTML of the window: how a page is shown is in ``ui/plugins/help``, and the web site
is made of the same texts by ``tools/website``.
"""
