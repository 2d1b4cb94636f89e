"""Bluetooth devices that measure motion, each described by a file."""
