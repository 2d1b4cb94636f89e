"""NAOqi, the system of a NAO: its protocol, a robot that speaks it, and how to drive one."""
