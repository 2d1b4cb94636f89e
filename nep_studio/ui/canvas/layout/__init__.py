"""Where everything on a page is: blocks, their parts, stacks; plain Python, nothing painted."""
