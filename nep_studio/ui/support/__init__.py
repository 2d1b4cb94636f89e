"""Help for those who need it: a report to send, and what to do when a start failed."""
