"""The block canvas: a layout in plain Python, painted by our own painter, edited by gestures.

``layout`` says where everything is, ``painting`` how it looks, ``editing`` what mouse, fingers and
keys do, ``fields`` how a value is changed. Enters what is about the blocks of one page. It changes
no program by itself: it asks an operation of ``blocks``, and shows what was changed. It knows no
panel, no window and no run. docs/canvas.md tells how it works.
"""
