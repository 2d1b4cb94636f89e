"""Show mode: one project, very large, for museums and theatres."""
