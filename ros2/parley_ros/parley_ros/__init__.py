"""Parley's nodes as executables of ROS; what they do is in the package `parley`."""
