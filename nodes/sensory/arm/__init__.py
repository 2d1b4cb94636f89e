"""A kinematic human arm that wears a watch: gestures and everyday movement without hardware."""
