"""NAOqi, the system that runs on a NAO: its protocol, a robot that speaks it, and how to drive one."""
