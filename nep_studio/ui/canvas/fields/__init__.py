"""The editors of fields: one real widget, put over the field that is edited."""
