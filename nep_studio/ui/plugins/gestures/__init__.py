"""The panel in which gestures are recorded, learned and tried."""
