"""Making a motion: poses on a timeline, which a robot then plays; and driving a robot by hand."""
