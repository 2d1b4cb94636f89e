"""The palette: all blocks of a page by category, to be searched, dragged out and inserted."""
