"""Blockly in headless Chromium, measured with the program that our canvas is measured with."""
