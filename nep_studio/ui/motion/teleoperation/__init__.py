"""Driving a robot by hand: with keys, a gamepad or a watch, as long as somebody holds on."""
