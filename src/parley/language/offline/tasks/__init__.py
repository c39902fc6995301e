"""From an order to steps, by what the robot's own catalogue offers."""
