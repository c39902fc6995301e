"""Robots behind one interface: simulated, Nav2, ROS 1."""
