"""Small widgets and layouts that several rooms use, and that know nothing of this program."""
